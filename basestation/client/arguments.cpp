// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/arguments.hpp"

#include "core/command/words.hpp"
#include "core/config/usage.hpp"

namespace adit::station::client {

StationArguments::StationArguments(CLI::App& app, StationOptions& options) : options_(options) {
  app.add_option("--name", options.name, "Operator name; one station runs per name");
  app.add_option("--link", options.link, "Link profile (config/links), for a station that is started");
  domain_ = app.add_option("--domain", options.domain, "Radio domain")->check(config::between(0, 232));
  // These options take one value each, otherwise they would consume a command.
  app.add_option("--interface", options.interfaces,
                 "Address of a network interface to use, may be repeated; loopback when none is named")
      ->allow_extra_args(false);
  app.add_option("--peer", options.peers, "ADDRESS[:PORT] of an agent, for networks without multicast")
      ->allow_extra_args(false);
}

Result<void> StationArguments::finish() {
  options_.domain_given = domain_->count() > 0;
  if (command::valid_name(options_.name)) return {};
  return {Reason::bad_argument,
          "--name is 1 to 32 of A-Z a-z 0-9 _ -, not '" + command::clean(options_.name, 40) + "'"};
}

}  // namespace adit::station::client
