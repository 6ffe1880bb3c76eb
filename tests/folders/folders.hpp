// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace adit {

/// The project's source tree, without a slash at its end. Functions, not macros on every command line: with
/// those no object file would be the same in two clones, and ccache would rebuild each test.
const std::string& source_folder();

/// Where this build's programs are, without a slash at its end.
const std::string& program_folder();

}  // namespace adit
