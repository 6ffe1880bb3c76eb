// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "basestation/alert/table.hpp"
#include "basestation/model/world.hpp"

namespace adit::station {

/// Something that the operator should look at.
struct Alert {
  std::uint64_t id{};
  Priority priority{};
  std::string code{};
  std::vector<std::string> robots{};  ///< Empty: it concerns the station.
  std::string text{};                 ///< Of the newest notification.
  Reason reason{Reason::none};
  int count{1};            ///< Notifications in it.
  double first{}, last{};  ///< Times of the first and the newest one, s.
  bool seen{false};        ///< The operator has seen it.
  double hidden_until{};   ///< The operator wants it again after that time, s.
};

/// The notifications that need the operator: the alerts of priority `act` and `soon`, until their cause is
/// gone.
///
/// One alert per robot and code, with a count. A code that says the same as a more urgent one within 5 s is
/// none of its own. A code of three or more robots within 5 s is one alert for all
/// of them. Notifications that concern another operator are none. The caller passes the time, in s of any
/// steady clock; nothing is stored that grows with time.
class AlertQueue {
 public:
  static constexpr double kTogether = 5.0;  ///< s
  static constexpr std::size_t kManyRobots = 3;
  static constexpr double kLater = 300.0;         ///< How long `later` hides an alert, s.
  static constexpr std::size_t kMaxAlerts = 256;  ///< Further ones replace the oldest of the lowest priority.

  /// Adds a notification; returns its priority. `world`: the robots' state at that time.
  Priority add(const Notice& notice, const World& world, double now);
  /// Closes the alerts whose cause is gone.
  void update(const World& world, double now);
  /// The operator has seen it: it stays while its cause does.
  void see(std::uint64_t id);
  /// Hides it for kLater; a new notification shows it again.
  void later(std::uint64_t id, double now);

  /// The alerts to show, the most urgent and then the oldest first.
  std::vector<Alert> shown(double now) const;
  /// Whether an alert names that robot, also one that is hidden.
  bool concerns(const std::string& robot) const;
  std::size_t size() const { return alerts_.size(); }

 private:
  Alert* find(const std::string& robot, const std::string& code);
  void close(const std::string& robot, const std::string& closing);
  void gather(const Alert& newest);
  /// Drops the alerts of that robot that say less of what the newest one says.
  void absorb(const Alert& newest);
  void make_room();

  std::vector<Alert> alerts_{};
  std::uint64_t next_{1};
};

}  // namespace adit::station
