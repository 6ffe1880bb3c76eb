// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace adit::gui {

/// The words that can stand at the end of a command line in place of its last, incomplete one; at most
/// kMaxProposals. Empty while a quote is open.
inline constexpr std::size_t kMaxProposals = 24;
std::vector<std::string> proposals(const std::string& line, const std::vector<std::string>& robots);
/// The line with `word` in place of its last, incomplete one, and a blank after it.
std::string with_word(const std::string& line, const std::string& word);
/// The line as far as all proposals agree; with a blank after the word if there is only one.
std::string completed(const std::string& line, const std::vector<std::string>& robots);

/// A line that was typed, parsed.
struct TypedLine {
  enum class Kind : std::uint8_t { nothing, wrong, help, stop, order };
  Kind kind{Kind::nothing};
  std::string text{};                 ///< What is wrong, or the help.
  std::vector<std::string> robots{};  ///< That it names.
  bool all{};                         ///< It means all robots.
  std::string action{};               ///< As for needs_hold(); empty: it asks only.

  /// Whether it commands so many robots that it is confirmed. `heard`: how many "all" are.
  bool is_held(std::size_t heard) const;
};
TypedLine read_line(const std::string& line);

}  // namespace adit::gui
