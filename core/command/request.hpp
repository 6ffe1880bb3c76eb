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

/// What was given for one argument or option.
struct ArgumentValue {
  std::string_view name{};  ///< the argument's or the option's, as in the table
  std::vector<std::string> words{};
  std::vector<double> numbers{};  ///< in the argument's unit; infinite where a limit is lifted
};

/// One command with its arguments, checked against its row: what a line says, and what travels to a robot.
struct Request {
  const CommandInfo* info{&command::info(command::verb("list"))};
  Verb verb{command::verb("list")};     ///< meaningful for rows of the standard table
  std::vector<std::string> robots{};    ///< in the order typed, each once
  bool all{false};                      ///< every robot that is heard
  std::vector<ArgumentValue> values{};  ///< arguments in the table's order, then options

  explicit Request(Verb of = command::verb("list"), std::vector<std::string> to = {})
      : info(&command::info(of)), verb(of), robots(std::move(to)) {}

  /// Null when it was not given.
  const ArgumentValue* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// The word given; empty when there is none.
  std::string word(std::string_view name) const;
  /// The number given, else the option's preset, else NaN.
  double number(std::string_view name) const;
  std::vector<double> numbers(std::string_view name) const;
};

/// A request as it travels to one robot, without the robots that it addresses.
struct Payload {
  std::int32_t number{-1};           ///< of the command, as in the table
  std::vector<std::string> words{};  ///< of arguments and options, in the table's order
  std::vector<double> numbers{};     ///< the same for numbers
  std::uint16_t options{};           ///< bit i: option i of the row was given
};

inline constexpr std::size_t kMaxWords = 20, kMaxNumbers = 40;  ///< of one payload, as the contract has it

Payload pack(const Request& request);
/// Checks what came from the radio against the table, as the parser checks a line. Errors: unknown_command,
/// bad_argument, out_of_range, mode_unknown.
Result<Request> unpack(const Payload& payload, Table rows = table());

/// What an accepted request reads like: its row's `done`, where {NAME} is replaced by the word given and
/// {X.2} by the number given, with two decimals.
std::string done_text(const Request& request);

/// One value against its argument: the errors of the parser, for text that was typed or received.
Result<void> check_word(const CommandInfo& command, const Argument& argument, const std::string& word);
Result<void> check_number(const CommandInfo& command, const Argument& argument, double number);
/// A refusal that names the command and its usage.
Error wrong(const CommandInfo& command, const std::string& what);

}  // namespace adit::command
