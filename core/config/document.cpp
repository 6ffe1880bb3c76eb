// SPDX-License-Identifier: Apache-2.0
#include "core/config/document.hpp"

#include <algorithm>
#include <numeric>

namespace adit::config {
namespace {

/// Edit distance (Levenshtein 1966), computed with rows of the length of the shorter word.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest(const std::string& text, const std::vector<std::string>& words) {
  if (text.size() > 64) return {};
  std::string best;
  std::size_t nearest = std::max<std::size_t>(1, text.size() / 3) + 1;
  for (const std::string& word : words) {
    const std::size_t d = distance(text, word);
    if (d < nearest) {
      nearest = d;
      best = word;
    }
  }
  return best;
}

void Document::fail(int line, Reason reason, const std::string& text) {
  constexpr std::size_t kMaxProblems = 100;
  if (problems_.size() < kMaxProblems) problems_.push_back({line, reason, text});
}

void Document::find_unknown(const Value& value) {
  if (value.checked) return;
  value.checked = true;
  for (const auto& item : value.items) find_unknown(*item);
  // No reader accessed this mapping: its own key is unknown, or its type is wrong.
  if (value.asked.empty()) return;
  for (const auto& entry : value.entries) {
    if (std::find(value.asked.begin(), value.asked.end(), entry.key) != value.asked.end()) {
      find_unknown(*entry.value);
      continue;
    }
    std::string text = "unknown key '" + entry.key.substr(0, 64) + "'";
    const std::string meant = nearest(entry.key, value.asked);
    if (!meant.empty()) {
      text += ", did you mean '" + meant + "'?";
    } else {
      std::vector<std::string> known = value.asked;
      std::sort(known.begin(), known.end());
      text += "; expected one of ";
      for (std::size_t i = 0; i < known.size(); ++i) text += (i ? ", " : "") + known[i];
    }
    fail(entry.line, Reason::unknown_key, text);
  }
}

Result<void> Document::finish() {
  find_unknown(*root_);
  if (problems_.empty()) return {};
  // When a required key is missing because it is misspelt, the report is about the misspelling.
  const auto rank = [](const Problem& p) {
    return std::pair(p.reason == Reason::missing_key ? 1 : 0, p.line);
  };
  const auto first = std::min_element(problems_.begin(), problems_.end(),
                                      [&](const Problem& a, const Problem& b) { return rank(a) < rank(b); });
  return Error{first->reason, file_ + ":" + std::to_string(first->line) + ": " + first->text};
}

}  // namespace adit::config
