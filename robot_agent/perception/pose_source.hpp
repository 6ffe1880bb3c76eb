// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/transfer/source.hpp"
#include "perception/stream/piece.hpp"

namespace adit::agent {

/// The poses of a robot's submaps in the map, and which stations have them. The newest submaps go first.
class PoseSource final : public transfer::Source {
 public:
  PoseSource(std::string robot, std::uint64_t start) : robot_(std::move(robot)), start_(start) {}

  /// Names a submap that is not {start, submap}, and the revision of its pose that stations may have.
  void open(std::uint32_t submap, std::uint64_t start, std::uint32_t index, std::uint32_t revision);
  /// Sets the pose of a submap, from now on wanted by every station.
  void update(std::uint32_t submap, const Pose3& T_map_submap);
  /// Forgets a submap.
  void drop(std::uint32_t submap);
  /// Poses of all submaps by number; the key, and the revision that stations know.
  std::vector<std::pair<std::uint32_t, perception::SubmapPose>> poses() const;
  /// Rises with each change of poses().
  std::uint64_t changes() const { return changes_; }
  /// The pose of one submap; nothing: unknown.
  std::optional<perception::SubmapPose> pose(std::uint32_t submap) const;

  transfer::Kind kind() const override { return transfer::Kind::map_poses; }
  bool for_carriers() const override { return true; }
  void join(const transfer::PeerId& peer) override;
  void leave(const transfer::PeerId& peer) override { peers_.erase(peer); }
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId&, std::uint64_t) override {}
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  struct PlacedSubmap {
    Pose3 T_map_submap{};
    std::uint32_t revision{};
  };
  struct Name {
    std::uint64_t start{};
    std::uint32_t index{};
    std::uint32_t revision{};
  };
  perception::SubmapPose content(std::uint32_t submap, const PlacedSubmap& entry) const;

  struct Part {
    std::uint32_t submap{};
    std::uint32_t revision{};
  };
  std::string robot_;
  std::uint64_t start_;
  std::map<std::uint32_t, PlacedSubmap> poses_{};
  std::map<std::uint32_t, Name> names_{};
  std::map<transfer::PeerId, std::set<std::uint32_t>> peers_{};  ///< Submaps whose pose each lacks.
  std::map<std::uint64_t, std::vector<Part>> flights_{};
  std::uint64_t tokens_{};
  std::uint64_t changes_{};
};

}  // namespace adit::agent
