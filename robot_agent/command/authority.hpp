// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/contract/authority.hpp"
#include "core/time/time.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

using contract::Party;

/// The authority over the robot: holder, lock and its lease, and epoch (rules 1 and 2). CommandInterface
/// decides which station may change it.
class Authority {
 public:
  /// `start`: random id of this start. `lease`: a lock ends after its holder was silent for this long; 0:
  /// never.
  Authority(std::uint64_t start, Duration lease) : epoch_{start, 0}, lease_(lease) {}

  const std::optional<Party>& holder() const { return holder_; }
  bool held_by(const std::string& name, const Id& id) const {
    return holder_ && holder_->name == name && holder_->id == id;
  }
  std::string holder_name() const { return holder_ ? holder_->name : std::string{}; }
  bool locked() const { return locked_; }
  const Epoch& epoch() const { return epoch_; }

  /// Changes the holder: unlocked, under the next epoch.
  void give(Party party, Time now) {
    holder_ = std::move(party);
    change(now);
  }
  void clear(Time now) {
    holder_.reset();
    change(now);
  }
  void lock() { locked_ = holder_.has_value(); }
  void unlock() { locked_ = false; }

  /// Restores holder and lock after a restart, under the next epoch of this start; the lease starts again.
  void restore(std::optional<Party> holder, bool locked, std::uint32_t counter, Time now) {
    holder_ = std::move(holder);
    locked_ = locked && holder_;
    heard_ = now;
    epoch_.counter = counter + 1;
  }

  /// Records a heartbeat of the holder.
  void hear(Time now) { heard_ = now; }
  /// Time of the holder's last heartbeat.
  Time heard() const { return heard_; }
  /// Time until the lock expires, s; negative if no lease runs.
  double lease_left(Time now) const {
    return locked_ && lease_ > Duration{0} ? std::max(0.0, seconds(heard_ + lease_ - now)) : -1.0;
  }
  /// Ends the lock if its lease expired; returns whether it did.
  bool lapse(Time now) {
    if (!locked_ || lease_ <= Duration{0} || now - heard_ < lease_) return false;
    locked_ = false;
    return true;
  }

 private:
  void change(Time now) {
    locked_ = false;
    heard_ = now;
    ++epoch_.counter;
  }

  std::optional<Party> holder_{};
  bool locked_{};
  Epoch epoch_;
  Duration lease_;
  Time heard_{};
};

}  // namespace adit::agent
