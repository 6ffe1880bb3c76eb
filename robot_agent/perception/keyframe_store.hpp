// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/store/disk.hpp"
#include "core/store/state_file.hpp"
#include "perception/place/keyframe.hpp"

namespace adit::agent {

/// The robot's last keyframes, in memory and on the disk, by which an agent that starts again recognises
/// where the robot is. One is stored for each metre of the way, at most kMax, each in a file of its own (12
/// kB), so that a write is short. A disk that fails costs nothing but this. Runs on the command strand; the
/// disk is written on another one.
class KeyframeStore {
 public:
  static constexpr std::size_t kMax = 64;
  static constexpr double kSpacing = 1.0;  ///< m

  /// `disk` null: nothing survives this process. `writer`: strand on which a slow disk is written.
  KeyframeStore(std::shared_ptr<store::Disk> disk, Executor& home, std::shared_ptr<Executor> writer);

  /// Reads the files, and counts those that cannot be used. No file is deleted (rule 9): damaged ones are set
  /// aside (core/store/preserve.hpp); those of a newer version, and those that the disk refuses to read now,
  /// stay, and their slots are not written by this process.
  void load();
  /// Files that could not be used.
  std::size_t lost() const { return damaged_ + newer_ + unreadable_; }
  /// The same in words, by what is wrong with them; empty: none.
  std::string text() const;
  /// Whether the robot moved by kSpacing since the last keyframe, so that one is to be made here.
  bool wants(const Eigen::Vector3d& position, std::uint32_t odom_epoch) const;
  /// Keeps a keyframe, unless it is empty.
  void add(perception::Keyframe keyframe);
  /// The keyframes of an odometry frame.
  std::vector<perception::Keyframe> of(std::uint32_t odom_epoch) const;

 private:
  /// The keyframe of a file; notes why there is none.
  std::optional<perception::Keyframe> read(std::size_t slot, const store::State& state);
  void write(std::size_t slot);
  /// Runs a task that accesses the disk.
  void run(Task task);

  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  std::vector<std::optional<perception::Keyframe>> slots_;
  std::size_t damaged_{}, newer_{}, unreadable_{};  ///< Files.
  std::set<std::size_t> left_alone_{};              ///< Slots that are not written.
  std::size_t next_{};                              ///< Slot of the next keyframe.
  std::optional<Eigen::Vector3d> last_{};
  std::uint32_t last_epoch_{};
  std::uint64_t generation_{};  ///< Of the last keyframe written.
};

}  // namespace adit::agent
