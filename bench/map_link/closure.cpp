// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "adit/bulk.h"
#include "basestation/map/map_receiver.hpp"
#include "bench/map_link/air.hpp"
#include "bench/map_link/rows.hpp"
#include "core/time/random.hpp"
#include "core/transfer/receiver.hpp"
#include "core/transfer/sender.hpp"
#include "core/wire/link_file.hpp"
#include "core/wire/typed.hpp"
#include "robot_agent/perception/pose_source.hpp"

namespace adit::bench {
namespace {

constexpr std::uint32_t kSubmaps = 100;
constexpr double kSubmapDistance = 12.0;  ///< Between two submaps, m.
constexpr double kWantedBytes = 3000.0;
constexpr Duration kClosureLimit = 120s;
constexpr transfer::PeerId kListener{1, 2, 3};

/// A robot with the poses of its submaps, and a station.
class Closure {
 public:
  Closure(const wire::LinkProfile& link, std::uint64_t seed) : air_(link, seed, 1), random_(seed) {
    sender_.add(poses_);
    // A path that turns a little at each submap.
    Pose2 at{};
    for (std::uint32_t i = 0; i < kSubmaps; ++i) {
      truth_.push_back(Pose3::level(at, 0.1 * random_.uniform(-1, 1)));
      at = at * Pose2{kSubmapDistance, 0, random_.uniform(-0.5, 0.5)};
      poses_.update(i, truth_.back());
    }
  }

  /// Moves each submap by its own part of a correction that grows along the path.
  void close() {
    for (std::uint32_t i = 0; i < kSubmaps; ++i) {
      const double part = static_cast<double>(i + 1) / kSubmaps;
      const Pose2 correction{1.5 * part + 0.01 * random_.uniform(-1, 1), -0.8 * part, 0.03 * part};
      poses_.update(i, Pose3::level(correction, 0.2 * part) * truth_[i]);
    }
  }

  /// Runs until the station has all poses as the robot has them; nothing: it took too long.
  std::optional<Duration> run() {
    const Time begin = air_.now();
    for (; air_.now() - begin < kClosureLimit; air_.run(50ms)) {
      if (is_equal()) return air_.now() - begin;
      for (const transfer::Piece& piece : sender_.due(air_.now(), air_.sender(Air::robot(0)))) send(piece);
      if (++ticks_ % 2 == 0) acknowledge();
    }
    return std::nullopt;
  }
  Air& air() { return air_; }

 private:
  void send(const transfer::Piece& piece) {
    radio::BulkPiece message;
    message.robot(kRobot);
    message.data(piece.data);
    wire::encode(message, buffer_);
    air_.send(Air::robot(0), Air::kStation, buffer_.size(), [this, piece] {
      if (station_.take(kRobot, static_cast<std::uint8_t>(piece.kind), piece.waiting, piece.data, air_.now()))
        receiver_.take(kRobot, sender_.session(), piece.id, air_.now());
    });
  }

  void acknowledge() {
    const auto receipts = receiver_.due(air_.now(), air_.link().bandwidth);
    if (!receipts) return;
    radio::BulkAck message;
    message.station("base");
    transfer::Ack ack{kListener, 1, {}};
    for (const auto& [robot, receipt] : *receipts) {
      ack.receipt = receipt;
      message.receipts().emplace_back().robot(robot);
    }
    wire::encode(message, buffer_);
    air_.send(Air::kStation, Air::robot(0), buffer_.size(),
              [this, ack] { sender_.acknowledged(ack, air_.now()); });
  }

  bool is_equal() const {
    for (const auto& [submap, pose] : poses_.poses()) {
      const auto* there = station_.chunks().find(pose.key);
      if (there == nullptr || there->pose_revision != pose.revision) return false;
    }
    return true;
  }

  static constexpr const char* kRobot = "wheeled_1";
  Air air_;
  Random random_;
  agent::PoseSource poses_{kRobot, 0x0123456789abcdefU};
  transfer::Sender sender_{{}};
  station::MapReceiver station_{};
  transfer::Receiver receiver_{};
  std::vector<Pose3> truth_{};
  std::vector<std::uint8_t> buffer_{};
  std::uint64_t ticks_{};
};

}  // namespace

Result<void> print_closure(const std::string& link, std::uint64_t seed) {
  const auto profile = wire::load_link(link);
  if (!profile) return profile.error();
  Closure closure(*profile, seed);
  if (!closure.run()) return {Reason::no_answer, "the station has not all poses in time"};
  closure.air().run(20s);
  const Air::Count before = closure.air().sent_by_robots();
  const std::uint64_t acks = closure.air().sent(Air::kStation).bytes;
  closure.close();
  const auto took = closure.run();
  if (!took) return {Reason::no_answer, "the station has not all new poses in time"};
  const Air::Count after = closure.air().sent_by_robots();
  const auto bytes = static_cast<double>(after.bytes - before.bytes);
  fmt::print("| {} | {:.0f} | {} | {} | {:.1f} | {} ({:.0f}) |\n", link, bytes,
             after.datagrams - before.datagrams, closure.air().sent(Air::kStation).bytes - acks,
             seconds(*took), bytes <= kWantedBytes ? "holds" : "missed", kWantedBytes);
  return {};
}

}  // namespace adit::bench
