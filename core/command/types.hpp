// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/result/reason.hpp"

/// The types that describe one command; core/command/table.hpp uses them.
namespace adit::command {

/// Type of a command's argument.
enum class Type : std::uint8_t {
  none,
  robots,   ///< Robot names; they address the command and are not part of its payload.
  name,     ///< An operator, a component, a mode or an area: 1 to 32 of [A-Za-z0-9_-].
  file,     ///< A path.
  choice,   ///< One of `choices`.
  number,   ///< A finite number within the range.
  text,     ///< Any words.
  command,  ///< The name of a command.
  keyword,  ///< The word `name` itself; it distinguishes commands with the same first word.
};

/// The robots that the word `all`, typed in place of their names, means.
enum class AllRobots : std::uint8_t {
  refused,  ///< None: robots are named one by one, because the command moves them.
  heard,    ///< Every robot that is heard.
  unheld,   ///< Every robot that is heard and that no operator holds.
  held,     ///< Every robot that this operator holds.
};

/// One argument of a command, or a value of an option.
struct Argument {
  std::string_view name{};  ///< Name as in the usage: "X", "COMPONENT"; of a keyword the word itself.
  Type type{Type::none};
  std::string_view what{};  ///< Name in messages: "an operator"; empty: `name`.
  /// Choices, separated by |; for a name or a file only proposals for completion.
  std::string_view choices{};
  Reason refusal{Reason::bad_argument};  ///< Error for a word that is no valid choice or name.
  double minimum{-std::numeric_limits<double>::infinity()};  ///< Lower limit of a number, in `unit`.
  double maximum{std::numeric_limits<double>::infinity()};
  bool above{false};                        ///< The minimum itself is out of range.
  std::string_view unit{};                  ///< One of m, m/s, rad, rad/s, s.
  std::string_view unlimited{};             ///< A word that means an infinite number.
  std::uint8_t min_count{1}, max_count{1};  ///< Number of values; 0 and 1: optional.
  std::uint8_t group{1};                    ///< Numbers that belong together: 2 for points X Y.
  bool distinct{false};                     ///< For robots: a name typed twice is an error.
  AllRobots all{AllRobots::refused};        ///< For robots.
  std::string_view all_only{};  ///< Last word that `all` requires: with others the command moves robots.

  constexpr explicit operator bool() const { return type != Type::none; }
};

/// An option: --name and its values, if any.
struct Option {
  std::string_view name{};
  std::string_view summary{};  ///< Its effect; unit, range and preset are not repeated here.
  std::array<Argument, 2> values{};
  double preset{std::numeric_limits<double>::quiet_NaN()};  ///< Number used when the option is not given.
  bool local{false};        ///< Concerns only the station and is not sent to the robot.
  std::string_view done{};  ///< Replaces the command's `done` when the option is given.

  constexpr explicit operator bool() const { return !name.empty(); }
  constexpr std::size_t count() const { return (values[0] ? 1U : 0U) + (values[1] ? 1U : 0U); }
};

/// The party that executes a command.
enum class Runs : std::uint8_t {
  terminal,  ///< The program in a terminal, which reads keys or files.
  query,     ///< The station, from data it has received.
  station,   ///< The station, about itself.
  stick,     ///< The station, with a stream of joystick samples.
  robot,     ///< The robot.
  nobody,    ///< Reserves the number of a withdrawn command; it cannot be typed.
};

/// Harm that a command given by mistake can do; it sets how much confirmation a front end requires.
enum class Danger : std::uint8_t {
  none,  ///< Changes nothing, or makes the robot safer: sent at once.
  some,  ///< Moves a robot or changes its commander: one deliberate action.
  high,  ///< Takes something from other operators or restarts parts: press and hold, or confirm.
};

/// Preconditions of a command. A front end checks them in advance, but the robot decides.
struct Conditions {
  bool holder{false};       ///< The sender has authority over the robot, under the current epoch.
  std::string_view mode{};  ///< This mode can be entered now; "MODE": the requested one.
  std::string_view in{};    ///< The robot is in this mode.
};

/// Ordering class: a command must not be overtaken by an earlier one of its class. One class is for commands
/// that move the robot, one for those that change authority.
enum class Line : std::uint8_t { none, steering, authority };

/// One row of the vocabulary.
struct CommandInfo {
  std::string_view name{};  ///< First word; rows that share it differ by a keyword.
  std::array<Argument, 7> arguments{};
  std::array<Option, 4> options{};
  Runs runs{Runs::robot};
  std::int16_t number{-1};  ///< Number on the radio: radio::CommandKind. Never reused; negative: never sent.
  Danger danger{Danger::none};
  Conditions conditions{};
  Line line{Line::none};
  std::string_view summary{};  ///< One line.
  std::string_view details{};  ///< Further text for the operators' page.
  std::string_view example{};
  std::string_view done{};   ///< Text of an accepted command; see done_text().
  std::string_view label{};  ///< Label of a button, where `name` is not suitable.

  constexpr std::string_view first_word() const { return name.substr(0, name.find(' ')); }
};

}  // namespace adit::command
