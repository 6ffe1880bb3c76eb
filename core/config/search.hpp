#pragma once
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::config {

/// Folders in which configuration is looked for, in this order: that of `beside` (a file) when given, those
/// of the environment variable ADIT_CONFIG (separated by ':'), `config/` of the source tree the program was
/// built in, `share/adit/config/` of where it was installed, and the maps that `./run setup` fetched.
std::vector<std::string> search_path(const std::string& beside = "");

/// The first file `name` ("platforms/wheeled.yaml", "geb079.bt") on the search path; an absolute name is
/// taken as it is. Error cannot_read names all places where it was looked for.
Result<std::string> find_file(const std::string& name, const std::string& beside = "");

/// The file that `name` stands for in `folder` ("platforms", "links"): "wheeled" is platforms/wheeled.yaml, a
/// name that ends in .yaml a file. Error cannot_read names those that there are.
Result<std::string> find_named(const std::string& folder, const std::string& name,
                               const std::string& beside = "");

}  // namespace adit::config
