// SPDX-License-Identifier: Apache-2.0
#include "tests/folders/folders.hpp"

namespace adit {

const std::string& source_folder() {
  static const std::string folder{ADIT_SOURCE_DIR};
  return folder;
}

const std::string& program_folder() {
  static const std::string folder{ADIT_BIN_DIR};
  return folder;
}

}  // namespace adit
