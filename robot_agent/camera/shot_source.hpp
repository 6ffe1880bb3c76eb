// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <vector>

#include "core/transfer/blocks.hpp"
#include "core/transfer/source.hpp"
#include "robot_agent/camera/camera_calls.hpp"

namespace adit::agent {

/// Single pictures on their way to the stations that asked for them, in blocks. Stored in memory only: a
/// station that still wants one after a restart of this robot asks again. Runs on the command strand.
class ShotSource final : public transfer::Source {
 public:
  static constexpr std::size_t kMost = 8;     ///< Pictures; then the oldest one of the same station goes.
  static constexpr Duration kPatience{300s};  ///< A picture that is not at its station by then is dropped.

  /// Adds a picture.
  void add(TakenShot shot, Time now);
  /// A station wants that picture of the camera, and no other one; 0: none.
  void wanted(const transfer::PeerId& station, const std::string& camera, std::uint32_t number);
  /// Drops what took too long.
  void tick(Time now);
  std::size_t size() const { return shots_.size(); }

  transfer::Kind kind() const override { return transfer::Kind::shots; }
  void join(const transfer::PeerId& peer) override;
  void leave(const transfer::PeerId& peer) override;
  std::size_t missing(const transfer::PeerId& peer) const override;
  std::optional<Content> next(std::span<const transfer::PeerId> peers, std::size_t max_bytes,
                              Time now) override;
  void acknowledged(const transfer::PeerId& peer, std::uint64_t token) override;
  void lost(const transfer::PeerId& peer, std::uint64_t token) override;
  void settled(std::uint64_t token) override { flights_.erase(token); }

 private:
  struct Shot {
    TakenShot taken{};
    std::uint64_t id{};  ///< Within this source.
    std::uint32_t crc{};
    Time added{};
    transfer::Blocks blocks{};
  };
  struct Flight {
    std::uint64_t shot{};
    std::size_t first{}, count{};
  };
  Shot* find(std::uint64_t id);

  std::deque<Shot> shots_{};
  std::map<std::uint64_t, Flight> flights_{};  ///< By token.
  std::uint64_t ids_{}, tokens_{};
};

}  // namespace adit::agent
