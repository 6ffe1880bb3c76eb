// SPDX-License-Identifier: Apache-2.0
#include "core/command/vocabulary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/command/words.hpp"

namespace adit::command {
namespace {

// The usage names longer lists of choices without spelling them out.
constexpr std::size_t kShortChoices = 24;
constexpr std::size_t kHelpColumn = 30, kArgumentColumn = 18;

bool typed(const CommandInfo& row) { return row.runs != Runs::nobody; }

std::string usage(const Argument& argument) {
  std::string text(argument.name);
  if (argument.type == Type::choice && argument.choices.size() <= kShortChoices) text = argument.choices;
  if (!argument.unlimited.empty()) text += "|" + std::string(argument.unlimited);
  if (argument.group > 1) {
    const auto point = [&](int index) {
      std::string out;
      for (const char c : argument.name) out += c == ' ' ? std::to_string(index) + " " : std::string(1, c);
      return out + std::to_string(index);
    };
    text.clear();
    for (int i = 0; i < argument.min_count; ++i) text += (i > 0 ? " " : "") + point(i);
    if (argument.max_count > argument.min_count) text += " [" + point(argument.min_count) + " ...]";
    return text;
  }
  if (argument.max_count > 1) text += "...";
  if (argument.all != AllRobots::refused) text += "|all";
  return argument.min_count == 0 ? "[" + text + "]" : text;
}

std::string usage(const Option& option) {
  std::string text(option.name);
  for (const Argument& value : option.values)
    if (value) text += " " + usage(value);
  return text;
}

std::string short_number(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.10g", number);
  return buffer;
}

std::string_view meaning(AllRobots all) {
  switch (all) {
    case AllRobots::heard:
      return "every robot that is heard";
    case AllRobots::unheld:
      return "every robot that is heard and has no holder";
    case AllRobots::held:
      return "every robot that you hold";
    case AllRobots::refused:
      break;
  }
  return {};
}

/// Describes the values of an argument: "m, -10000 to 10000", "a component: agent, command".
std::string values_of(const Argument& argument) {
  std::string text(argument.type == Type::choice ? "" : argument.what);
  if (!argument.unit.empty()) text += (text.empty() ? "" : ", ") + std::string(argument.unit);
  if (std::isfinite(argument.minimum))
    text += (text.empty() ? "" : ", ") + std::string(argument.above ? "above " : "") +
            short_number(argument.minimum) + " to " + short_number(argument.maximum);
  if (!argument.choices.empty()) text += (text.empty() ? "" : ": ") + joined(choices(argument), "");
  if (!argument.unlimited.empty()) text += " or " + std::string(argument.unlimited);
  if (argument.type == Type::robots && argument.max_count > 1) text += ", or several";
  if (argument.all != AllRobots::refused) text += "; all: " + std::string(meaning(argument.all));
  if (!argument.all_only.empty()) text += ", with " + std::string(argument.all_only) + " only";
  return text;
}

std::string values_of(const Option& option) {
  std::string text(option.summary);
  if (option.values[0].type != Type::number) return text;
  text += " (" + values_of(option.values[0]);
  if (std::isfinite(option.preset)) text += "; default " + short_number(option.preset);
  return text + ")";
}

/// Returns the keyword of a row, or null when it has none.
const Argument* keyword_of(const CommandInfo& row) {
  const auto found = std::find_if(row.arguments.begin(), row.arguments.end(),
                                  [](const Argument& a) { return a.type == Type::keyword; });
  return found == row.arguments.end() ? nullptr : &*found;
}

void propose(const Argument& argument, const std::vector<std::string>& robots, Table rows,
             std::vector<std::string>& out) {
  const std::vector<std::string> listed = argument.type == Type::robots    ? robots
                                          : argument.type == Type::command ? command_names(rows)
                                                                           : choices(argument);
  out.insert(out.end(), listed.begin(), listed.end());
  if (argument.type == Type::keyword) out.emplace_back(argument.name);
  if (argument.all != AllRobots::refused) out.emplace_back("all");
  if (!argument.unlimited.empty()) out.emplace_back(argument.unlimited);
}

/// Adds the proposals of arguments [begin, end) of a row for the word at position `at`; returns true when all
/// required words before it are present.
bool propose(const CommandInfo& row, std::size_t begin, std::size_t end, std::size_t at,
             const std::vector<std::string>& robots, Table rows, std::vector<std::string>& out) {
  std::size_t first = 0, last = 0;  // Positions at which the next argument may begin.
  for (std::size_t i = begin; i < end; ++i) {
    const Argument& argument = row.arguments[i];
    const std::size_t max_words = std::size_t{argument.max_count} * argument.group;
    if (argument && at >= first && at < last + max_words) propose(argument, robots, rows, out);
    first += argument ? std::size_t{argument.min_count} * argument.group : 0;
    last += argument ? max_words : 0;
  }
  return at >= first;
}

std::vector<std::string> complete(const CommandInfo& row, const std::vector<std::string>& words,
                                  const std::vector<std::string>& robots, Table rows) {
  std::vector<std::string> out, given;
  std::vector<const Option*> left;
  for (const Option& option : row.options)
    if (option) left.push_back(&option);
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    const auto option =
        std::find_if(left.begin(), left.end(), [&](const Option* o) { return o->name == words[i]; });
    if (option == left.end()) {
      given.push_back(words[i]);
      continue;
    }
    const std::size_t missing = words.size() - 2 - i;  // Number of words typed after the option.
    if (missing < (*option)->count()) {
      propose((*option)->values[missing], robots, rows, out);
      return out;
    }
    i += (*option)->count();
    left.erase(option);
  }
  // With `all`, some commands take one word only.
  const std::string_view only = row.arguments[0].all_only;
  if (!only.empty() && std::find(given.begin(), given.end(), "all") != given.end())
    return given.back() == "all" ? std::vector{std::string(only)} : std::vector<std::string>{};
  std::size_t begin = 0, end = row.arguments.size(), at = given.size();
  if (const Argument* keyword = keyword_of(row)) {
    const auto place = static_cast<std::size_t>(keyword - row.arguments.data());
    const auto seen = std::find(given.begin(), given.end(), keyword->name);
    if (seen == given.end())
      end = place + 1;
    else
      begin = place + 1, at = static_cast<std::size_t>(given.end() - seen) - 1;
  }
  const bool is_reached = propose(row, begin, end, at, robots, rows, out);
  if (is_reached && end == row.arguments.size())
    for (const Option* option : left) out.emplace_back(option->name);
  return out;
}

}  // namespace

std::vector<const CommandInfo*> find_commands(std::string_view first_word, Table rows) {
  std::vector<const CommandInfo*> found;
  for (const CommandInfo& row : rows)
    if (typed(row) && row.first_word() == first_word) found.push_back(&row);
  return found;
}

const CommandInfo* find_number(int number, Table rows) {
  for (const CommandInfo& row : rows)
    if (row.number >= 0 && row.number == number) return &row;
  return nullptr;
}

std::vector<std::string> command_names(Table rows) {
  std::vector<std::string> names;
  for (const CommandInfo& row : rows)
    if (typed(row) && std::find(names.begin(), names.end(), row.first_word()) == names.end())
      names.emplace_back(row.first_word());
  return names;
}

std::vector<std::string> choices(const Argument& argument) {
  std::vector<std::string> out;
  for (std::string_view rest = argument.choices; !rest.empty();) {
    const std::size_t end = std::min(rest.find('|'), rest.size());
    out.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

bool is_component(std::string_view part) {
  const std::vector<std::string> parts = choices(info(verb("restart")).arguments[1]);
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

std::string usage(const CommandInfo& command) {
  std::string text(command.first_word());
  for (const Argument& argument : command.arguments)
    if (argument) text += " " + usage(argument);
  for (const Option& option : command.options)
    if (option) text += " [" + usage(option) + "]";
  return text;
}

std::string help(const CommandInfo& command) {
  std::string rows;
  const auto add = [&](std::string left, const std::string& text) {
    left.resize(std::max(left.size() + 2, kArgumentColumn), ' ');
    rows += "  " + left + text + "\n";
  };
  for (const Argument& argument : command.arguments)
    if (argument && argument.type != Type::keyword) add(std::string(argument.name), values_of(argument));
  for (const Option& option : command.options)
    if (option) add(usage(option), values_of(option));
  return "usage: basestation " + usage(command) + "\n\n  " + std::string(command.summary) + "\n" +
         (rows.empty() ? "" : "\n" + rows) + "\nexample: basestation " + std::string(command.example) + "\n";
}

std::string help_all(Table rows) {
  std::string out;
  for (const CommandInfo& row : rows) {
    if (!typed(row)) continue;
    std::string left = usage(row);
    left.resize(std::max(left.size() + 2, kHelpColumn), ' ');
    out += "  " + left + std::string(row.summary) + "\n";
  }
  return out;
}

std::string help_markdown(Table rows) {
  std::string out = "| command | what it does | example |\n| --- | --- | --- |\n";
  for (const CommandInfo& row : rows) {
    if (!typed(row)) continue;
    std::string escaped;
    for (const char c : usage(row)) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    out += "| `" + escaped + "` | " + std::string(row.summary);
    if (!row.details.empty()) out += "; " + std::string(row.details);
    out += " | `basestation " + std::string(row.example) + "` |\n";
  }
  return out;
}

std::vector<std::string> complete(const std::vector<std::string>& words,
                                  const std::vector<std::string>& robots, Table rows) {
  if (words.size() <= 1) return command_names(rows);
  const auto found = find_commands(words.front(), rows);
  const auto said = [&](const CommandInfo* row) {
    const Argument* keyword = keyword_of(*row);
    return keyword != nullptr &&
           std::find(words.begin() + 1, words.end() - 1, keyword->name) != words.end() - 1;
  };
  const bool decided = std::any_of(found.begin(), found.end(), said);
  std::vector<std::string> out;
  for (const CommandInfo* row : found) {
    if (decided && !said(row)) continue;
    for (std::string& word : complete(*row, words, robots, rows))
      if (std::find(out.begin(), out.end(), word) == out.end()) out.push_back(std::move(word));
  }
  return out;
}

}  // namespace adit::command
