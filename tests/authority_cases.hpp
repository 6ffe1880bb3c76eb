// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/result/reason.hpp"

/// Authority as a table (rules 1 to 4): who asks, in what state, the answer, and the notifications.
/// One table, three mounts: the command interface alone, a rehearsal, processes over Fast DDS.
namespace adit::authority_cases {

/// A command line given by an operator to the robot R, or an event:
///   by "op1"           a line as operators type it: take, release, lock, unlock, grant OP, stop, reset
///   [--override],
///                      mode M, goto X Y
///   by "impostor:op1"  the same from a foreign participant with op1's name and another station id
///   by "forger:op1"    the same from a foreign participant with op1's name and station id
///   by ""              "wait S": so many seconds pass, every station that is up is heard;
///                      "kill OP": the station falls silent; "start OP": it is back with the same id and
///                      a new participant
struct Line {
  std::string by{};
  std::string line{};
};

struct Told {
  std::string operator_name{};  ///< Empty: all operators.
  std::string code{};
  auto operator<=>(const Told&) const = default;
};

struct Case {
  std::string name{};
  std::vector<Line> given{};
  Line asked{};
  Reason reason{Reason::none};
  std::string holder{};
  bool locked{};
  std::vector<std::string> stops{};
  std::vector<Told> told{};  ///< Notifications caused by the asked line, in any order.
};

/// The lock lease that the cases assume, s.
inline constexpr int kLease = 20;

inline std::vector<Case> all() {
  const Line take1{"op1", "take"}, take2{"op2", "take"}, lock1{"op1", "lock"};
  const Line stop1{"op1", "stop"}, stop2{"op2", "stop"};
  using R = Reason;
  return {
      // take
      {"take_free", {}, take1, R::none, "op1", false, {}, {}},
      {"take_own", {take1}, take1, R::none, "op1", false, {}, {}},
      {"take_own_keeps_lock", {take1, lock1}, take1, R::none, "op1", true, {}, {}},
      {"take_unlocked", {take1}, take2, R::none, "op2", false, {}, {{"op1", "taken"}}},
      {"take_locked", {take1, lock1}, take2, R::locked, "op1", true, {}, {{"op1", "asked"}}},
      {"take_after_unlock",
       {take1, lock1, {"op1", "unlock"}},
       take2,
       R::none,
       "op2",
       false,
       {},
       {{"op1", "taken"}}},
      {"take_after_release", {take1, lock1, {"op1", "release"}}, take2, R::none, "op2", false, {}, {}},
      {"take_back", {take1, take2}, take1, R::none, "op1", false, {}, {{"op2", "taken"}}},
      {"take_while_stopped", {take1, stop1}, take2, R::none, "op2", false, {"op1"}, {{"op1", "taken"}}},
      // lock and unlock
      {"lock_own", {take1}, lock1, R::none, "op1", true, {}, {}},
      {"lock_twice", {take1, lock1}, lock1, R::none, "op1", true, {}, {}},
      {"lock_free", {}, lock1, R::nobody_holds, "", false, {}, {}},
      {"lock_of_another", {take1}, {"op2", "lock"}, R::not_holder, "op1", false, {}, {}},
      {"unlock_of_another", {take1, lock1}, {"op2", "unlock"}, R::not_holder, "op1", true, {}, {}},
      {"unlock_free", {}, {"op1", "unlock"}, R::nobody_holds, "", false, {}, {}},
      {"unlock_unlocked", {take1}, {"op1", "unlock"}, R::none, "op1", false, {}, {}},
      {"taken_is_unlocked",
       {take1, lock1, {"op1", "unlock"}, take2},
       take1,
       R::none,
       "op1",
       false,
       {},
       {{"op2", "taken"}}},
      // release
      {"release_own", {take1}, {"op1", "release"}, R::none, "", false, {}, {{"", "released"}}},
      {"release_ends_lock", {take1, lock1}, {"op1", "release"}, R::none, "", false, {}, {{"", "released"}}},
      {"release_free", {}, {"op1", "release"}, R::nobody_holds, "", false, {}, {}},
      {"release_of_another", {take1}, {"op2", "release"}, R::not_holder, "op1", false, {}, {}},
      {"release_twice", {take1, {"op1", "release"}}, {"op1", "release"}, R::nobody_holds, "", false, {}, {}},
      // grant
      {"grant_unlocks",
       {take1, lock1},
       {"op1", "grant op2"},
       R::none,
       "op2",
       false,
       {},
       {{"op1", "granted"}, {"op2", "granted"}}},
      {"grant_unheard", {take1}, {"op1", "grant op9"}, R::unknown_operator, "op1", false, {}, {}},
      {"grant_silent",
       {take1, {"", "kill op2"}, {"", "wait 4"}},
       {"op1", "grant op2"},
       R::unknown_operator,
       "op1",
       false,
       {},
       {}},
      {"grant_by_another", {take1}, {"op2", "grant op2"}, R::not_holder, "op1", false, {}, {}},
      {"grant_free", {}, {"op1", "grant op2"}, R::nobody_holds, "", false, {}, {}},
      {"grant_self", {take1}, {"op1", "grant op1"}, R::bad_argument, "op1", false, {}, {}},
      {"granted_then_former",
       {take1, {"op1", "grant op2"}},
       {"op1", "lock"},
       R::not_holder,
       "op2",
       false,
       {},
       {}},
      // modes and goals need the holder
      {"mode_by_holder", {take1}, {"op1", "mode hold"}, R::none, "op1", false, {}, {}},
      {"mode_by_another", {take1}, {"op2", "mode hold"}, R::not_holder, "op1", false, {}, {}},
      {"mode_free", {}, {"op1", "mode hold"}, R::nobody_holds, "", false, {}, {}},
      {"goto_by_another", {take1}, {"op2", "goto 1 0"}, R::not_holder, "op1", false, {}, {}},
      {"goto_free", {}, {"op1", "goto 1 0"}, R::nobody_holds, "", false, {}, {}},
      {"mode_after_loss", {take1, take2}, {"op1", "mode hold"}, R::not_holder, "op2", false, {}, {}},
      // stop and reset
      {"stop_by_holder", {take1}, stop1, R::none, "op1", false, {"op1"}, {}},
      {"stop_by_another", {take1}, stop2, R::none, "op1", false, {"op2"}, {{"op1", "stopped"}}},
      {"stop_locked", {take1, lock1}, stop2, R::none, "op1", true, {"op2"}, {{"op1", "stopped"}}},
      {"stop_free", {}, stop2, R::none, "", false, {"op2"}, {}},
      {"stop_twice", {take1, stop2}, stop2, R::none, "op1", false, {"op2"}, {}},
      {"stop_both", {take1, stop1}, stop2, R::none, "op1", false, {"op1", "op2"}, {{"op1", "stopped"}}},
      {"reset_own", {take1, stop1}, {"op1", "reset"}, R::none, "op1", false, {}, {}},
      {"reset_nothing", {take1}, {"op1", "reset"}, R::none, "op1", false, {}, {}},
      {"reset_of_another", {take1, stop2}, {"op1", "reset"}, R::stop_of_another, "op1", false, {"op2"}, {}},
      {"reset_override",
       {take1, stop2},
       {"op1", "reset --override"},
       R::none,
       "op1",
       false,
       {},
       {{"op1", "reset"}, {"op2", "reset"}}},
      {"reset_own_leaves_other", {take1, stop1, stop2}, {"op1", "reset"}, R::none, "op1", false, {"op2"}, {}},
      {"reset_override_both",
       {take1, stop1, stop2},
       {"op1", "reset --override"},
       R::none,
       "op1",
       false,
       {},
       {{"op1", "reset"}, {"op2", "reset"}}},
      {"reset_by_stopper_not_holder",
       {take1, stop2},
       {"op2", "reset"},
       R::not_holder,
       "op1",
       false,
       {"op2"},
       {}},
      {"reset_free", {stop2}, {"op2", "reset"}, R::nobody_holds, "", false, {"op2"}, {}},
      {"reset_by_new_holder",
       {take1, stop1, take2},
       {"op2", "reset"},
       R::stop_of_another,
       "op2",
       false,
       {"op1"},
       {}},
      {"reset_after_taking", {take1, stop2, take2}, {"op2", "reset"}, R::none, "op2", false, {}, {}},
      {"goto_stopped",
       {take1, stop1},
       {"op1", "goto 1 0"},
       R::stopped,
       "op1",
       false,
       {"op1"},
       {{"op1", "mode_refused"}}},
      // identity
      {"impostor_mode",
       {take1},
       {"impostor:op1", "mode hold"},
       R::identity_mismatch,
       "op1",
       false,
       {},
       {{"op1", "intruder"}}},
      {"impostor_take",
       {take1},
       {"impostor:op1", "take"},
       R::identity_mismatch,
       "op1",
       false,
       {},
       {{"op1", "intruder"}}},
      {"impostor_of_a_guest", {take1}, {"impostor:op2", "take"}, R::name_in_use, "op1", false, {}, {}},
      {"impostor_stop",
       {take1},
       {"impostor:op1", "stop"},
       R::none,
       "op1",
       false,
       {"op1"},
       {{"op1", "intruder"}, {"op1", "stopped"}}},
      {"forger_mode",
       {take1},
       {"forger:op1", "mode hold"},
       R::identity_mismatch,
       "op1",
       false,
       {},
       {{"op1", "intruder"}}},
      // A stop needs no authority; a forger is reported, and its stop counts all the same.
      {"forger_stop", {take1}, {"forger:op1", "stop"}, R::none, "op1", false, {"op1"}, {{"op1", "intruder"}}},
      {"forger_release",
       {take1, lock1},
       {"forger:op1", "release"},
       R::identity_mismatch,
       "op1",
       true,
       {},
       {{"op1", "intruder"}}},
      {"silent_name_is_free",
       {take1, {"", "kill op1"}, {"", "wait 4"}},
       {"impostor:op1", "take"},
       R::none,
       "op1",
       false,
       {},
       {{"op1", "taken"}}},
      {"silent_name_inherits_nothing",
       {take1, {"", "kill op1"}, {"", "wait 4"}},
       {"impostor:op1", "mode hold"},
       R::not_holder,
       "op1",
       false,
       {},
       {}},
      // the operator come back
      {"restart_keeps_holding",
       {take1, lock1, {"", "kill op1"}, {"", "start op1"}},
       {"op1", "mode hold"},
       R::none,
       "op1",
       true,
       {},
       {}},
      {"restart_keeps_lock",
       {take1, lock1, {"", "kill op1"}, {"", "start op1"}},
       take2,
       R::locked,
       "op1",
       true,
       {},
       {{"op1", "asked"}}},
      {"restart_resets_own_stop",
       {take1, stop1, {"", "kill op1"}, {"", "start op1"}},
       {"op1", "reset"},
       R::none,
       "op1",
       false,
       {},
       {}},
      {"long_silence_keeps_holding",
       {take1, {"", "kill op1"}, {"", "wait 10"}, {"", "start op1"}},
       {"op1", "mode hold"},
       R::none,
       "op1",
       false,
       {},
       {}},
      // lease
      {"lease_runs",
       {take1, lock1, {"", "kill op1"}, {"", "wait 10"}},
       take2,
       R::locked,
       "op1",
       true,
       {},
       {{"op1", "asked"}}},
      {"lease_lapses",
       {take1, lock1, {"", "kill op1"}, {"", "wait 25"}},
       take2,
       R::none,
       "op2",
       false,
       {},
       {{"op1", "taken"}}},
      {"lease_renewed_by_presence",
       {take1, lock1, {"", "wait 25"}},
       take2,
       R::locked,
       "op1",
       true,
       {},
       {{"op1", "asked"}}},
  };
}

}  // namespace adit::authority_cases
