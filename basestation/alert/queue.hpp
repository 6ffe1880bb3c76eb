// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "basestation/alert/condition.hpp"
#include "basestation/model/world.hpp"

namespace adit::station {

/// Something that the operator should look at.
struct Alert {
  std::uint64_t id{};
  Priority priority{};
  std::string code{};
  Ends ends{Ends::seen};
  bool from_state{};                  ///< The state of the robot shows it; no notification of it was heard.
  std::optional<Reason> confirmed{};  ///< The state's reason when it showed the condition; empty: not yet.
  std::vector<std::string> robots{};  ///< Empty: it concerns the station.
  std::string text{};                 ///< Of the newest notification, or of the state.
  Reason reason{Reason::none};
  int count{1};            ///< Notifications in it.
  double first{}, last{};  ///< Times of the first and the newest one, s.
  bool seen{false};        ///< The operator has seen it.
  double hidden_until{};   ///< The operator wants it again after that time, s.
};

/// What needs the operator: notifications of priority `act` and `soon`, and conditions that the state of the
/// operator's robots shows for 0.5 s although no notification of them was heard. Each stays until its cause
/// is gone.
///
/// One alert per robot and code, with a count. A code that says the same as a more urgent one within 5 s is
/// none of its own. A code of three or more robots within 5 s is one alert for all of them. A condition is
/// none of its own while the robot has an alert of that kind or of a more dangerous one. Notifications that
/// concern another operator are none. The caller passes the time, in s of any steady clock; nothing is stored
/// that grows with time.
class AlertQueue {
 public:
  static constexpr double kTogether = 5.0;  ///< s
  static constexpr double kSettles = 0.5;   ///< A condition that ends within this time is no alert, s.
  /// Time for the state that a notification is about: a message of it that was lost is repeated within, s.
  static constexpr double kEvidence = 2.0;
  static constexpr std::size_t kManyRobots = 3;
  static constexpr double kLater = 300.0;         ///< How long `later` hides an alert, s.
  static constexpr std::size_t kMaxAlerts = 256;  ///< Further ones replace the oldest of the lowest priority.

  /// Adds a notification; returns its priority. `world`: the robots' state at that time.
  Priority add(const Notice& notice, const World& world, double now);
  /// Closes the alerts whose cause is gone, and adds those that only the robots' state shows.
  void update(const World& world, double now);
  /// The operator has seen it: it stays while its cause does.
  void see(std::uint64_t id);
  /// Hides it for kLater; a new notification shows it again.
  void later(std::uint64_t id, double now);

  /// The alerts to show: by priority, then by what the robot risks (the order of alert_table()), the oldest
  /// first.
  std::vector<Alert> shown(double now) const;
  std::size_t size() const { return alerts_.size(); }

 private:
  /// A condition of a robot, and since when its state shows it.
  struct Settling {
    Condition condition{};
    double since{};       ///< s
    double code_since{};  ///< Since when it has its present code, s.
  };

  Alert* find(const std::string& robot, const std::string& code);
  /// The alert that the robot's state alone made for that condition; null: there is none.
  Alert* find_from_state(const std::string& robot, Ends ends);
  /// Whether the robot has an alert of that condition or of a more dangerous one.
  bool covers(const std::string& robot, const Condition& condition) const;
  /// Whether the cause of an alert of that robot is gone.
  bool is_over(const Alert& alert, const Robot& robot, double now) const;
  /// Takes the present conditions of a robot, and confirms and renews the alerts that are about them.
  void take_conditions(const Robot& robot, const std::string& station, double now);
  void add_condition(const Robot& robot, const Settling& settling);
  /// Makes an alert that is there that of a new notification, and shows it again.
  static void renew(Alert& alert, const Notice& notice, Priority priority, double at);
  void insert(Alert alert);
  void close(const std::string& robot, const std::string& closing, double now);
  void gather(const Alert& newest);
  /// Drops the alerts of that robot that say less of what the newest one says.
  void absorb(const Alert& newest);
  void make_room();

  std::vector<Alert> alerts_{};
  std::map<std::pair<std::string, Ends>, Settling> conditions_{};  ///< By robot and kind.
  std::uint64_t next_{1};
};

}  // namespace adit::station
