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
  std::size_t max_findings{4096};  ///< findings of all robots, [1, 65536]
};

/// What robots found, on this station's disk. A robot is told that we have a finding once it is on disk here:
/// what does not fit, or cannot be written, stays with the robot.
class FindingDesk {
 public:
  static constexpr std::size_t kIds = 64;  ///< of one acknowledgement
  struct Outputs {
    std::function<void(const std::string& robot, const std::vector<std::uint64_t>& ids)> acknowledge{};
    std::function<void(const findings::Finding&)> found{};  ///< a new one
    /// `code`: findings_full or store_failing, store_works.
    std::function<void(const std::string& code, const std::string& text)> trouble{};
  };
  /// What a robot says of its own set.
  struct Robot {
    std::uint32_t kept{}, overflowed{};
  };

  FindingDesk(DeskParams params, std::shared_ptr<store::Disk> disk, Executor& home, Outputs outputs);

  /// Reads what is on disk.
  findings::LoadReport load() { return finding_store_.load(); }
  void hear(findings::Finding finding, const Robot& robot);
  /// Ten times a second: answers what was heard since, in as few messages as they fit in.
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
