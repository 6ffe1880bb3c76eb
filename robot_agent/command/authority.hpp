#pragma once
#include <optional>

#include "core/time/time.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// A station that holds or stops a robot: name and id, whatever its participant.
struct Party {
  std::string name{};
  Id id{};
  bool operator==(const Party&) const = default;
};

/// Who holds the robot: (holder, locked, epoch) and the lease of the lock (rules 1 and 2). Decides nothing
/// about who may ask; CommandInterface does.
class Authority {
 public:
  /// `start`: random id of this start. `lease`: a lock ends when its holder is silent for so long; 0: never.
  Authority(std::uint64_t start, Duration lease) : epoch_{start, 0}, lease_(lease) {}

  const std::optional<Party>& holder() const { return holder_; }
  bool held_by(const std::string& name, const Id& id) const {
    return holder_ && holder_->name == name && holder_->id == id;
  }
  std::string holder_name() const { return holder_ ? holder_->name : std::string{}; }
  bool locked() const { return locked_; }
  const Epoch& epoch() const { return epoch_; }

  /// A change of holder: unlocked, under the next epoch.
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

  /// After a restart: as it was, under the next epoch of this start; the lease starts anew.
  void restore(std::optional<Party> holder, bool locked, std::uint32_t counter, Time now) {
    holder_ = std::move(holder);
    locked_ = locked && holder_;
    heard_ = now;
    epoch_.counter = counter + 1;
  }

  /// The holder gave a sign of life.
  void hear(Time now) { heard_ = now; }
  /// The holder's last sign of life.
  Time heard() const { return heard_; }
  /// Seconds until the lock lapses; negative when no lease runs.
  double lease_left(Time now) const {
    return locked_ && lease_ > Duration{0} ? std::max(0.0, seconds(heard_ + lease_ - now)) : -1.0;
  }
  /// Ends the lock when its lease ran out; true when it did.
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
