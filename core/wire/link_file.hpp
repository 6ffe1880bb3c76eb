#pragma once
#include <string>

#include "core/config/node.hpp"
#include "core/result/result.hpp"
#include "core/wire/link.hpp"

namespace adit::wire {

/// The keys of a link profile but its name, from a node of any file; what is not given stays as it is in
/// `link`.
void read_link_keys(const config::Node& node, LinkProfile& link);
/// Reads a link profile's file; every key of docs/configuration.md.
Result<LinkProfile> load_link_file(const std::string& path);
/// The profile of that name (config/links/NAME.yaml on the search path), or the file when `name` ends in
/// .yaml. `beside`: the file that named it.
Result<LinkProfile> load_link(const std::string& name, const std::string& beside = "");

}  // namespace adit::wire
