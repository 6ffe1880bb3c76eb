#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/command/table.hpp"

namespace adit::command {

/// A command by its place in the table.
enum class Verb : std::uint8_t {};

/// The verb of that name; a name that the table does not have fails to compile.
consteval Verb verb(std::string_view name) {
  for (std::size_t i = 0; i < kTable.size(); ++i)
    if (kTable[i].name == name) return static_cast<Verb>(i);
  throw "the command table has no row of that name";
}

/// The verb of a row of the standard table.
constexpr Verb verb_of(const CommandInfo& row) { return static_cast<Verb>(&row - kTable.data()); }

constexpr const CommandInfo& info(Verb verb) { return kTable[static_cast<std::size_t>(verb)]; }

using Table = std::span<const CommandInfo>;

/// Every command, in the order of the help. Functions that take a table use this one unless a test has its
/// own.
inline constexpr Table table() { return kTable; }

/// Rows with this first word that can be typed; several when a keyword tells them apart.
std::vector<const CommandInfo*> find_commands(std::string_view first_word, Table rows = table());
/// The row with this number on the radio; null when this version knows none.
const CommandInfo* find_number(int number, Table rows = table());
/// First words, each once, in the order of the help.
std::vector<std::string> command_names(Table rows = table());

/// The choices of an argument, one by one.
std::vector<std::string> choices(const Argument& argument);

/// How a command is typed: "goto R X Y [Z] [--wait]".
std::string usage(const CommandInfo& command);
/// The help of one command: usage, what it does, an example.
std::string help(const CommandInfo& command);
/// One line for each command.
std::string help_all(Table rows = table());
/// The table of docs/operators.md, in Markdown.
std::string help_markdown(Table rows = table());

/// What may follow the typed words, of which the last is being typed: commands, the robots given, choices,
/// options.
std::vector<std::string> complete(const std::vector<std::string>& words,
                                  const std::vector<std::string>& robots, Table rows = table());

}  // namespace adit::command
