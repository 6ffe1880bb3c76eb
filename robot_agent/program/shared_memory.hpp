#pragma once
#include <sys/types.h>

#include <set>
#include <string>

namespace adit::agent {

/// What a process of ours keeps in /dev/shm for Fast DDS, so that it can be taken away when that process died
/// without doing so. Only names seen open in that process, and only when nobody holds their locks any more.
class SharedMemory {
 public:
  /// `folder`: of the names, as /dev/shm.
  explicit SharedMemory(std::string folder = "/dev/shm") : folder_(std::move(folder)) {}
  /// Looks at what the process has open, once in a while.
  void watch(pid_t process);
  /// After its death.
  void clean();

 private:
  std::string folder_;
  std::set<std::string> locks_{};  ///< names of lock files; bounded
};

}  // namespace adit::agent
