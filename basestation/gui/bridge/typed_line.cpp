// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/typed_line.hpp"

#include <algorithm>

#include "basestation/gui/bridge/action_bar.hpp"
#include "core/command/parse.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"

namespace adit::gui {
namespace {

/// Where the last word of a line begins: after its last blank.
std::size_t last_word(const std::string& line) {
  const std::size_t blank = line.find_last_of(' ');
  return blank == std::string::npos ? 0 : blank + 1;
}

/// Whether a command is one of the program in a terminal only.
bool for_terminals(const std::string& name) {
  const auto rows = command::find_commands(name);
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const command::CommandInfo* row) {
    return row->runs == command::Runs::terminal;
  });
}

}  // namespace

std::vector<std::string> proposals(const std::string& line, const std::vector<std::string>& robots) {
  const std::size_t at = last_word(line);
  const std::string begun = line.substr(at);
  auto words = command::split_words(line.substr(0, at));
  if (!words) return {};
  words->push_back(begun);
  const bool first = words->size() == 1;
  std::vector<std::string> out;
  for (std::string& word : command::complete(*words, robots))
    if (word.starts_with(begun) && !(first && for_terminals(word)) && out.size() < kMaxProposals)
      out.push_back(std::move(word));
  return out;
}

std::string with_word(const std::string& line, const std::string& word) {
  return line.substr(0, last_word(line)) + word + " ";
}

std::string completed(const std::string& line, const std::vector<std::string>& robots) {
  const std::vector<std::string> words = proposals(line, robots);
  if (words.empty()) return line;
  if (words.size() == 1) return with_word(line, words.front());
  std::string common = words.front();
  for (const std::string& word : words)
    common.resize(static_cast<std::size_t>(
        std::mismatch(common.begin(), common.end(), word.begin(), word.end()).first - common.begin()));
  return line.substr(0, last_word(line)) + common;
}

TypedLine read_line(const std::string& line) {
  using Kind = TypedLine::Kind;
  const auto words = command::split_words(line);
  if (!words) return {Kind::wrong, words.error().text};
  if (words->empty()) return {};
  if (words->front() == "help") {
    std::string text;
    if (words->size() > 1)
      for (const command::CommandInfo* row : command::find_commands((*words)[1])) text += command::help(*row);
    return {Kind::help, text.empty() ? command::help_all() : text};
  }
  const auto request = command::parse(*words);
  if (!request) return {Kind::wrong, request.error().text};
  if (request->info->runs == command::Runs::terminal)
    return {Kind::wrong, std::string(request->info->name) + ": only in a terminal: basestation " + line};
  TypedLine typed{.kind = request->verb == command::verb("stop") ? Kind::stop : Kind::order,
                  .robots = request->robots,
                  .all = request->all};
  if (request->info->runs == command::Runs::query) return typed;
  typed.action = request->info->name;
  if (const std::string mode = request->word("MODE"); !mode.empty()) typed.action += "_" + mode;
  return typed;
}

bool TypedLine::is_held(std::size_t heard) const {
  return !action.empty() && needs_hold(action, all ? heard : robots.size());
}

}  // namespace adit::gui
