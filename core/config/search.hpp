// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::config {

/// Returns the folders in which configuration is searched, in this order: that of `beside` (a file) when
/// given, those of the environment variable ADIT_CONFIG (separated by ':'), `config/` of the source tree that
/// the program was built in, `share/adit/config/` of its installation, and the maps that `./run setup`
/// fetched.
std::vector<std::string> search_path(const std::string& beside = "");

/// Finds the first file `name` ("platforms/wheeled.yaml", "geb079.bt") on the search path; an absolute path
/// is used unchanged. Error cannot_read lists all places searched.
Result<std::string> find_file(const std::string& name, const std::string& beside = "");

/// Finds the file of a name in `folder` ("platforms", "links"): "wheeled" is platforms/wheeled.yaml, and a
/// name that ends in .yaml is a file. Error cannot_read lists the names that exist.
Result<std::string> find_named(const std::string& folder, const std::string& name,
                               const std::string& beside = "");

}  // namespace adit::config
