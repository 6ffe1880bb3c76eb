// Defects of a robot's parent process, which sends zero when the agent is dead.
#include <string_view>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "sim/defects/decorations.hpp"

namespace adit::sim {
namespace {

namespace topics = wire::topics;

/// Takes a TwistStamped and writes a Twist.
class PlainWriter final : public wire::RawWriter {
 public:
  explicit PlainWriter(wire::Writer<geometry_msgs::msg::Twist> inner) : inner_(std::move(inner)) {}
  Result<void> write(std::span<const std::uint8_t> cdr) override {
    geometry_msgs::msg::TwistStamped stamped;
    if (!wire::decode(cdr, stamped)) return {};
    return inner_.write(stamped.twist());
  }
  std::size_t matched() const override { return inner_.matched(); }

 private:
  wire::Writer<geometry_msgs::msg::Twist> inner_;
};

/// A wire that writes every velocity as a Twist.
class PlainVelocities final : public wire::Wire {
 public:
  explicit PlainVelocities(std::unique_ptr<wire::Wire> inner) : inner_(std::move(inner)) {}

  wire::ParticipantId id() const override { return inner_->id(); }
  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override {
    if (topic.type != std::string_view(topics::cmd_vel_stamped.type))
      return inner_->make_writer(topic, partition);
    auto plain = wire::Writer<geometry_msgs::msg::Twist>::make(*inner_, topics::cmd_vel, partition);
    if (!plain) return plain.error();
    return std::unique_ptr<wire::RawWriter>(std::make_unique<PlainWriter>(std::move(*plain)));
  }
  Result<std::unique_ptr<wire::RawReader>> make_reader(const wire::TopicInfo& topic,
                                                       const std::string& partition, Executor& strand,
                                                       wire::RawHandler handler) override {
    return inner_->make_reader(topic, partition, strand, std::move(handler));
  }
  void on_participant(Executor& strand, std::function<void(const wire::ParticipantEvent&)> handler) override {
    inner_->on_participant(strand, std::move(handler));
  }
  wire::WireCounters counters() const override { return inner_->counters(); }
  wire::SenderState sender() const override { return inner_->sender(); }
  std::vector<wire::PeerState> peers() const override { return inner_->peers(); }
  void set_place(const wire::ParticipantId& who, const wire::Position& at) override {
    inner_->set_place(who, at);
  }

 private:
  std::unique_ptr<wire::Wire> inner_;
};

}  // namespace

namespace decorations {

Decoration none(const Subject&) { return {}; }

std::unique_ptr<wire::Wire> zero_of_other_type(std::unique_ptr<wire::Wire> parents) {
  return std::make_unique<PlainVelocities>(std::move(parents));
}

}  // namespace decorations
}  // namespace adit::sim
