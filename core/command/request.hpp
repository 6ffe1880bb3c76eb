// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/command/vocabulary.hpp"
#include "core/result/result.hpp"

namespace adit::command {

/// The values given for one argument or option.
struct ArgumentValue {
  std::string_view name{};  ///< Name of the argument or option, as in the table.
  std::vector<std::string> words{};
  std::vector<double> numbers{};  ///< In the argument's unit; infinite where a limit is lifted.
};

/// One command with its arguments, checked against its row: the content of a typed line or of a radio
/// message.
struct Request {
  const CommandInfo* info{&command::info(command::verb("list"))};
  Verb verb{command::verb("list")};     ///< Meaningful for rows of the standard table.
  std::vector<std::string> robots{};    ///< In the order typed, each once.
  bool all{false};                      ///< Addresses every robot that is heard.
  std::vector<ArgumentValue> values{};  ///< Arguments in the table's order, then options.

  Request() : Request(command::verb("list")) {}
  explicit Request(Verb of, std::vector<std::string> to = {})
      : info(&command::info(of)), verb(of), robots(std::move(to)) {}

  /// Returns null when the argument or option was not given.
  const ArgumentValue* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// Returns the word given, or an empty one.
  std::string word(std::string_view name) const;
  /// Returns the number given, else the option's default, else NaN.
  double number(std::string_view name) const;
  std::vector<double> numbers(std::string_view name) const;
};

/// A request as sent to one robot, without the list of robots.
struct Payload {
  std::int32_t number{-1};           ///< Number of the command, as in the table.
  std::vector<std::string> words{};  ///< Words of arguments and options, in the table's order.
  std::vector<double> numbers{};     ///< Numbers of arguments and options, in the table's order.
  std::uint16_t options{};           ///< Bit i: option i of the row was given.
};

/// Bounds of one payload in the radio contract.
inline constexpr std::size_t kMaxWords = 20, kMaxNumbers = 40;

Payload pack(const Request& request);
/// Checks a payload from the radio against the table, as the parser checks a line. Errors: unknown_command,
/// bad_argument, out_of_range, mode_unknown.
Result<Request> unpack(const Payload& payload, Table rows = table());

/// Describes an accepted request: the `done` text of its row, where {NAME} is replaced by the word given and
/// {X.2} by the number given, with two decimals.
std::string done_text(const Request& request);

/// Checks one value, typed or received, against its argument. Errors are those of the parser.
Result<void> check_word(const CommandInfo& command, const Argument& argument, const std::string& word);
Result<void> check_number(const CommandInfo& command, const Argument& argument, double number);
/// Returns an error that names the command and its usage.
Error wrong(const CommandInfo& command, const std::string& what);

}  // namespace adit::command
