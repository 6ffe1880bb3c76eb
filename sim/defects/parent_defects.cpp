// SPDX-License-Identifier: Apache-2.0
// Defects of a robot's parent process, which sends zero when the agent is dead.
#include <string_view>

#include "core/wire/forwarding_participant.hpp"
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
class PlainVelocities final : public wire::ForwardingParticipant {
 public:
  explicit PlainVelocities(std::unique_ptr<wire::Participant> inner)
      : ForwardingParticipant(*inner), owned_(std::move(inner)) {}

  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override {
    if (topic.type != std::string_view(topics::kCmdVelStamped.type))
      return inner_.make_writer(topic, partition);
    auto plain = wire::Writer<geometry_msgs::msg::Twist>::make(inner_, topics::kCmdVel, partition);
    if (!plain) return plain.error();
    return std::unique_ptr<wire::RawWriter>(std::make_unique<PlainWriter>(std::move(*plain)));
  }

 private:
  std::unique_ptr<wire::Participant> owned_;
};

}  // namespace

namespace decorations {

Decoration none(const Subject&) { return {}; }

std::unique_ptr<wire::Participant> zero_of_other_type(std::unique_ptr<wire::Participant> parents) {
  return std::make_unique<PlainVelocities>(std::move(parents));
}

}  // namespace decorations
}  // namespace adit::sim
