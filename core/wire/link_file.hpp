// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/config/node.hpp"
#include "core/result/result.hpp"
#include "core/wire/link.hpp"

namespace adit::wire {

/// Reads the keys of a link profile except its name from a node of any file; keys that are absent leave
/// `link` unchanged.
void read_link_keys(const config::Node& node, LinkProfile& link);
/// Reads a link profile's file, with every key of docs/configuration.md.
Result<LinkProfile> load_link_file(const std::string& path);
/// Loads the profile of that name (config/links/NAME.yaml on the search path), or the file when `name` ends
/// in .yaml. `beside`: the file that refers to it.
Result<LinkProfile> load_link(const std::string& name, const std::string& beside = "");

}  // namespace adit::wire
