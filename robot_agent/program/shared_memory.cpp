#include "robot_agent/program/shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

namespace adit::agent {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMost = 256;

// A segment NAME has the lock NAME_el; a port has NAME_el or NAME_sl, and the semaphore sem.NAME_mutex.
bool is_lock(const std::string& name) {
  return name.starts_with("fastrtps_") && (name.ends_with("_el") || name.ends_with("_sl"));
}

/// Nobody holds it: its owner is dead.
bool is_free(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool taken = ::flock(fd, LOCK_EX | LOCK_NB) == 0;
  ::close(fd);
  return taken;
}

}  // namespace

void SharedMemory::watch(pid_t process) {
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", gone)) {
    const fs::path target = fs::read_symlink(entry.path(), gone);
    if (target.parent_path() == folder_ && is_lock(target.filename()) && locks_.size() < kMost)
      locks_.insert(target.filename());
  }
}

void SharedMemory::clean() {
  std::erase_if(locks_, [this](const std::string& lock) {
    const std::string path = folder_ + "/" + lock;
    if (fs::exists(path) && !is_free(path)) return false;  // somebody else's port that it had open, too
    const std::string name = lock.substr(0, lock.size() - 3);
    std::error_code ignored;  // what is gone already needs no removal
    for (const std::string& file : {name, "sem." + name + "_mutex", lock})
      fs::remove(folder_ + "/" + file, ignored);
    return true;
  });
}

}  // namespace adit::agent
