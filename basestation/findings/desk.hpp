// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/findings/finding_store.hpp"

namespace adit::station {

struct DeskParams {
  std::size_t max_findings{4096};  ///< Maximum number of findings of all robots, [1, 65536].
};

/// Stores the findings of all robots on this station's disk. A finding is acknowledged to its robot once it
/// is on disk here: one that does not fit, or cannot be written, stays with the robot.
class FindingDesk {
 public:
  static constexpr std::size_t kIds = 64;  ///< Maximum number of ids in one acknowledgement.
  struct Outputs {
    std::function<void(const std::string& robot, const std::vector<std::uint64_t>& ids)> acknowledge{};
    std::function<void(const findings::Finding&)> found{};  ///< Called with a new finding.
    /// `code`: findings_full or store_failing, store_works.
    std::function<void(const std::string& code, const std::string& text)> trouble{};
  };
  /// A robot's report on its own findings.
  struct Robot {
    std::uint32_t kept{}, overflowed{};
  };

  FindingDesk(DeskParams params, std::shared_ptr<store::Disk> disk, Executor& home, Outputs outputs);

  /// Loads the findings from disk.
  findings::LoadReport load() { return finding_store_.load(); }
  void hear(findings::Finding finding, const Robot& robot);
  /// Acknowledges the findings received since the last call, in as few messages as possible. Call it at 10
  /// Hz.
  void tick();

  const std::map<findings::Key, findings::Finding>& all() const { return finding_store_.all(); }
  const std::map<std::string, Robot>& robots() const { return robots_; }

 private:
  Outputs outputs_;
  std::map<std::string, std::set<std::uint64_t>> answers_{};
  std::map<std::string, Robot> robots_{};
  bool told_full_{};
  findings::FindingStore finding_store_;
};

}  // namespace adit::station
