// SPDX-License-Identifier: Apache-2.0
#include "core/command/words.hpp"

#include <algorithm>

namespace adit::command {
namespace {

constexpr std::size_t kMaxLine = 4096;
constexpr std::size_t kMaxEdits = 2;

/// Optimal string alignment distance, for words up to the length of a command word.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

}  // namespace

Result<std::vector<std::string>> split_words(std::string_view line) {
  if (line.size() > kMaxLine) return {Reason::syntax, "the line is longer than 4096 bytes"};
  std::vector<std::string> words;
  std::string word;
  bool open = false;  // A word has begun; it may be empty: "".
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!blank && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f))
      return {Reason::syntax, "the line has a control character in it"};
    if (quote == 0 && blank) {
      if (open) words.push_back(std::move(word));
      word.clear();
      open = false;
    } else if (c == '\\' && quote != '\'') {
      if (++i == line.size()) return {Reason::syntax, "the line ends in a backslash"};
      word += line[i];
      open = true;
    } else if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
      open = true;
    } else if (quote != 0 && c == quote) {
      quote = 0;
    } else {
      word += c;
      open = true;
    }
  }
  if (quote != 0) return {Reason::syntax, std::string("a quote (") + quote + ") is not closed"};
  if (open) words.push_back(std::move(word));
  return words;
}

std::string nearest(std::string_view typed, const std::vector<std::string>& candidates) {
  if (typed.empty() || typed.size() > 32) return {};
  std::string best;
  // A third of a short word may be wrong: of "foo", two letters of three would lead to "goto".
  std::size_t best_distance = std::min(kMaxEdits, typed.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (typed.size() >= 2 && candidate.starts_with(typed)) return candidate;
    const std::size_t d = distance(typed, candidate);
    if (d >= best_distance) continue;
    best_distance = d;
    best = candidate;
  }
  return best;
}

bool valid_name(std::string_view name) {
  return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

bool valid_robot_name(std::string_view name) {
  return valid_name(name) && name != "all" && !name.starts_with('-');
}

std::string clean(std::string_view text, std::size_t limit) {
  std::string out(text.substr(0, limit));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  return out;
}

std::string joined(const std::vector<std::string>& words, std::string_view none) {
  if (words.empty()) return std::string(none);
  std::string out = words.front();
  for (std::size_t i = 1; i < words.size(); ++i) out += ", " + words[i];
  return out;
}

}  // namespace adit::command
