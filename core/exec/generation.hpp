// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>

namespace adit {

/// Token that shows whether an instance of a component is still valid. Its supervisor revokes it for good
/// when the instance fails, hangs or is replaced; whatever the instance passes on afterwards has no effect.
/// Safe to use from any thread.
class Generation {
 public:
  bool valid() const { return valid_.load(std::memory_order_acquire); }
  void revoke() { valid_.store(false, std::memory_order_release); }

 private:
  std::atomic<bool> valid_{true};
};

}  // namespace adit
