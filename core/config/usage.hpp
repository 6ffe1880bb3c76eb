// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <iostream>

namespace adit::config {

/// Returns the exit status of main() for a command line that could not be parsed: 0 after --help or
/// --version, else 2, with one line on stderr that names the program and the error.
inline int end_usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::cerr << app.get_name() << ": " << error.what() << "; see --help\n";
  return 2;
}

}  // namespace adit::config
