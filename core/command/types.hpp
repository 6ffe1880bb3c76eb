#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/result/reason.hpp"

/// The types that describe one command: core/command/table.hpp is written with them.
namespace adit::command {

enum class Type : std::uint8_t {
  none,
  robots,   ///< robot names; they address the command and do not travel in it
  name,     ///< 1 to 32 of [A-Za-z0-9_-]: an operator, a component, a mode, an area
  file,     ///< a path
  choice,   ///< one of `choices`
  number,   ///< finite, within the range
  command,  ///< the name of a command
  keyword,  ///< `name` itself; tells commands with the same first word apart
};

/// One argument of a command, or a value of an option.
struct Argument {
  std::string_view name{};  ///< as in the usage: "X", "COMPONENT"; of a keyword the word itself
  Type type{Type::none};
  std::string_view what{};     ///< in messages: "an operator"; empty: the name
  std::string_view choices{};  ///< separated by |; of a name or a file only what completion proposes
  Reason refusal{Reason::bad_argument};                      ///< for a word that is no choice or no name
  double minimum{-std::numeric_limits<double>::infinity()};  ///< of a number, in `unit`
  double maximum{std::numeric_limits<double>::infinity()};
  bool above{false};                        ///< the minimum itself is out of range
  std::string_view unit{};                  ///< m, m/s, rad, rad/s, s
  std::string_view unlimited{};             ///< a word that stands for an infinite number
  std::uint8_t min_count{1}, max_count{1};  ///< how many are given; 0 and 1: optional
  std::uint8_t group{1};                    ///< numbers that belong together: 2 for points X Y
  bool all{false};                          ///< robots: the word `all` stands for every robot that is heard

  constexpr explicit operator bool() const { return type != Type::none; }
};

/// An option: --name and its values, if any.
struct Option {
  std::string_view name{};
  std::array<Argument, 2> values{};
  double preset{std::numeric_limits<double>::quiet_NaN()};  ///< its number when it is not given
  bool local{false};        ///< concerns the station alone and is not sent to the robot
  std::string_view done{};  ///< replaces the command's `done` when it is given

  constexpr explicit operator bool() const { return !name.empty(); }
  constexpr std::size_t count() const { return (values[0] ? 1U : 0U) + (values[1] ? 1U : 0U); }
};

/// Who carries a command out.
enum class Runs : std::uint8_t {
  terminal,  ///< the program in a terminal: it reads keys or files
  query,     ///< the station, from what it has heard
  station,   ///< the station, about itself
  stick,     ///< the station, with a stream of joystick samples
  robot,     ///< the robot
  nobody,    ///< it takes the place of a withdrawn command and is never typed
};

/// What can go wrong when a command is given by mistake: how much a front end asks for before it sends it.
enum class Danger : std::uint8_t {
  none,  ///< changes nothing, or makes the robot safer: at once
  some,  ///< moves a robot or changes who commands it: one deliberate action
  high,  ///< takes something from others or restarts parts: press and hold, or confirm
};

/// What must hold before the robot accepts a command. The robot has the last word.
struct Conditions {
  bool holder{false};       ///< the sender holds the robot, under the epoch in force
  std::string_view mode{};  ///< this mode could be entered now; "MODE": the one that is asked for
  std::string_view in{};    ///< the robot is in this mode
};

/// Commands that must not be overtaken by what was sent before them: what moves the robot among itself, and
/// what says who may.
enum class Line : std::uint8_t { none, steering, authority };

/// One row of the vocabulary.
struct CommandInfo {
  std::string_view name{};  ///< the first word, and a keyword where several rows share that
  std::array<Argument, 7> arguments{};
  std::array<Option, 4> options{};
  Runs runs{Runs::robot};
  std::int16_t number{-1};  ///< on the radio: radio::CommandKind. Never used again; negative: never sent
  Danger danger{Danger::none};
  Conditions conditions{};
  Line line{Line::none};
  std::string_view summary{};  ///< one line
  std::string_view details{};  ///< what the page for operators says beside it
  std::string_view example{};
  std::string_view done{};   ///< what an accepted command reads like; see done_text()
  std::string_view label{};  ///< of a button, where the name itself does not read well

  constexpr std::string_view first_word() const { return name.substr(0, name.find(' ')); }
};

}  // namespace adit::command
