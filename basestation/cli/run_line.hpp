// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/cli/options.hpp"
#include "basestation/client/connection.hpp"
#include "core/command/request.hpp"
#include "core/result/result.hpp"

namespace adit::station::cli {

/// Connects to this operator's station; starts it if none is running. Says on stderr what the operator should
/// know.
Result<client::LineSocket> connect(const Options& options);
/// The program's exit code if connect() failed.
int exit_without_station(const Error& error);
/// Runs a parsed command line, at the station or in this process; starts a station if the command needs one.
/// `shared`: a connection for commands without a terminal; null: one of its own. Returns the exit code.
int run_request(const Options& options, const command::Request& request, const std::string& line,
                client::Connection* shared);
/// Runs one line at the station and prints its outcome; SIGINT ends it. Returns the exit code.
int run_line(client::Connection& client, const Options& options, const std::string& line);
/// Prints an outcome: text on stdout, refusals on stderr, or with --json its object on stdout. Returns its
/// exit code.
int print_outcome(const Options& options, const CommandOutcome& outcome);
/// Prints "basestation: TEXT" on stderr, or with --json an object on stdout; returns `exit_code`.
int fail(const Options& options, int exit_code, const Error& error);
/// Describes an ended command of another front end, e.g. "watch: take r1: r1: taken"; empty for all other
/// events.
std::string command_of_another(const CommandEvent& event);

}  // namespace adit::station::cli
