// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/command/table.hpp"

namespace adit::command {

/// Index of a command in the table.
enum class Verb : std::uint8_t {};

/// Returns the verb of that name; a name that is not in the table fails to compile.
consteval Verb verb(std::string_view name) {
  for (std::size_t i = 0; i < kTable.size(); ++i)
    if (kTable[i].name == name) return static_cast<Verb>(i);
  throw "the command table has no row of that name";
}

/// Returns the verb of a row of the standard table.
constexpr Verb verb_of(const CommandInfo& row) { return static_cast<Verb>(&row - kTable.data()); }

constexpr const CommandInfo& info(Verb verb) { return kTable[static_cast<std::size_t>(verb)]; }

using Table = std::span<const CommandInfo>;

/// Every command, in the order of the help. Functions that take a table default to this one; tests pass their
/// own.
inline constexpr Table table() { return kTable; }

/// Returns the rows with this first word that can be typed; several when keywords distinguish them.
std::vector<const CommandInfo*> find_commands(std::string_view first_word, Table rows = table());
/// Returns the row with this number on the radio, or null when this version has none.
const CommandInfo* find_number(int number, Table rows = table());
/// Returns the first words, each once, in the order of the help.
std::vector<std::string> command_names(Table rows = table());

/// Splits the choices of an argument.
std::vector<std::string> choices(const Argument& argument);

/// Whether `restart` takes this part of a robot's health report: driver and store are no components.
bool is_component(std::string_view part);

/// Shows how a command is typed: "goto R X Y [Z] [--wait]".
std::string usage(const CommandInfo& command);
/// Help text of one command: usage, effect, each argument and option with unit, range and preset, an example.
std::string help(const CommandInfo& command);
/// Help text with one line for each command.
std::string help_all(Table rows = table());
/// The table of docs/operators.md, in Markdown.
std::string help_markdown(Table rows = table());

/// Proposes continuations of the typed words, of which the last is incomplete: commands, the given robots,
/// choices, options.
std::vector<std::string> complete(const std::vector<std::string>& words,
                                  const std::vector<std::string>& robots, Table rows = table());

}  // namespace adit::command
