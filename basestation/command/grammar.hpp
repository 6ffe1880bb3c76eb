#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "basestation/command/request.hpp"

namespace adit::station {

/// One command of the grammar: parser, help and completion all read this table.
struct CommandInfo {
  Verb verb;
  std::string_view name;
  std::string_view usage;    ///< arguments, as in the help
  std::string_view summary;  ///< one line
  std::string_view example;
  int robots_min;  ///< robot names wanted; -1: takes none
  int robots_max;  ///< 0: any number
};

/// Every command, in the order of the help.
std::span<const CommandInfo> commands();
const CommandInfo& info(Verb verb);
/// Null when there is no command of that name.
const CommandInfo* find_command(std::string_view name);
std::vector<std::string> command_names();

/// The modes that an operator may ask for.
const std::vector<std::string>& mode_names();

/// The help of one command: usage, what it does, an example.
std::string help(const CommandInfo& command);
/// One line per command.
std::string help_all();

}  // namespace adit::station
