// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

namespace adit {

/// The project's source tree, without a slash at its end. Functions, not macros on every command line: with
/// those no object file would be the same in two clones, and ccache would rebuild each test.
const std::string& source_folder();

/// Where this build's programs are, without a slash at its end.
const std::string& program_folder();

/// A new, empty folder without a slash at its end, removed when the process ends. All files of tests are in
/// such folders, so that no two tests share one.
std::string scratch_folder();

/// True in tests of label long: cases take all their seeds and starts, full lidars, and runs as long as their
/// scenarios. ADIT_ALL_SEEDS in the environment.
bool all_seeds();
inline std::uint64_t seeds(std::uint64_t few, std::uint64_t all) { return all_seeds() ? all : few; }

}  // namespace adit
