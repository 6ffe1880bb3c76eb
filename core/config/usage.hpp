// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <iomanip>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>

namespace adit::config {

/// Accepts a number in [minimum, maximum], a whole one if T is an integer type; never NaN.
template <class T>
CLI::Validator between(T minimum, T maximum = std::numeric_limits<T>::max()) {
  std::ostringstream range;
  range << std::setprecision(15) << minimum;
  if (maximum == std::numeric_limits<T>::max())
    range << " or more";
  else
    range << " to " << maximum;
  const auto check = [=, range = range.str()](std::string& text) -> std::string {
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.data() + text.size();
    T value{};
    const auto [read, error] = std::from_chars(begin, end, value);
    if (error == std::errc() && read == end && value >= minimum && value <= maximum) return {};
    return std::string("expected a ") + (std::is_integral_v<T> ? "whole " : "") + "number, " + range +
           ", not '" + text.substr(0, 40) + "'";
  };
  return {check, range.str()};
}

/// Returns the exit status of main() for a command line that could not be parsed: 0 after --help or
/// --version, else 2, with one line on stderr that names the program and the error.
inline int end_usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::string what = error.what(), commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands += (commands.empty() ? "" : ", ") + command->get_name();
  const bool lacks_command = app.get_require_subcommand_min() > 0 && app.get_subcommands().empty();
  // CLI11 complains about what is missing before it does about what it does not know.
  const std::vector<std::string> unknown = app.remaining(true);
  if (!unknown.empty())
    what = (unknown.front().starts_with('-') ? "no option " : "unexpected '") +
           unknown.front().substr(0, 40) + (unknown.front().starts_with('-') ? "" : "'");
  else if (lacks_command)
    what = "a command is missing";
  if (lacks_command) what += "; commands are " + commands;
  std::cerr << app.get_name() << ": " << what << "; see --help\n";
  return 2;
}

}  // namespace adit::config
