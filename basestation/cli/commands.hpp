// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/cli/options.hpp"
#include "basestation/client/connection.hpp"
#include "core/command/request.hpp"

/// Commands that the program carries out itself; each returns the exit code.
namespace adit::station::cli {

/// Runs `stop`: through the station if that accepts the command within 300 ms, otherwise with a participant
/// of this process that has the same name and identity.
int stop(const Options& options, const command::Request& request, const std::string& line);
/// Drives a robot by keyboard or game controller until Esc, Ctrl-C or a refusal.
int teleop(client::Connection& client, const Options& options, const std::string& robot);
/// Runs the live dashboard: redraws after each change and processes keys until q or Ctrl-C.
int watch(client::Connection& client, const Options& options);

}  // namespace adit::station::cli
