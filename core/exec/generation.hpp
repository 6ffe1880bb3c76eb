#pragma once
#include <atomic>

namespace adit {

/// Says whether one instance of a component still counts. Its supervisor revokes it for good when the
/// instance fails, hangs or is replaced; whatever the instance hands out afterwards has no effect. Any
/// thread.
class Generation {
 public:
  bool valid() const { return valid_.load(std::memory_order_acquire); }
  void revoke() { valid_.store(false, std::memory_order_release); }

 private:
  std::atomic<bool> valid_{true};
};

}  // namespace adit
