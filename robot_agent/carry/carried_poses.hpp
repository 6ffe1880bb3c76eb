// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/carry/carried_blocks.hpp"

namespace adit::agent {

/// The poses of other robots' submaps, for the stations that lack them: of each the newest revision that
/// came. A piece has poses of one robot.
class CarriedPoses final : public transfer::Source {
 public:
  CarriedPoses(CarryBounds bounds, WantsMap wants) : bounds_(bounds), wants_(std::move(wants)) {}

  /// Takes poses of one robot's submaps. Returns whether there was room for all of them.
  bool take(const std::string& robot, const perception::SubmapPoses& poses);
  /// Takes the digest of a robot's map that a station has.
  void compare(const transfer::PeerId& station, const transfer::ContentDigest& digest);

  transfer::Kind kind() const override { return transfer::Kind::carried_poses; }
  void join(const transfer::PeerId& peer) override;
  void leave(const transfer::PeerId& peer) override { slots_.leave(peer); }
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId&, std::uint64_t) override {}
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  struct CarriedPose {
    perception::SubmapPose pose{};
    std::uint16_t had_by{};  ///< As CarriedBlocks::Block.
  };
  struct Robot {
    std::map<perception::SubmapKey, CarriedPose> poses{};
    std::uint32_t sum{};
    std::size_t missing(std::size_t slot) const;
  };
  using Flight = std::vector<std::pair<perception::SubmapKey, std::uint32_t>>;  ///< With the revision.

  CarryBounds bounds_;
  WantsMap wants_;
  PeerSlots slots_{};
  std::map<std::string, Robot> robots_{};
  std::map<std::uint64_t, Flight> flights_{};
  std::uint64_t tokens_{};
};

}  // namespace adit::agent
