// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "core/store/disk.hpp"

namespace adit::store {

// A file that cannot be used is never deleted: it is renamed to "FILE.why", "FILE.why-2" and so on. At most
// eight of a kind are stored; then the last one is replaced. Both functions return the new name, or an empty
// text when the disk refuses.

/// Renames a file that cannot be used at all.
std::string set_aside(Disk& disk, const std::string& file, std::string_view why);

/// Copies a file that is usable in part, so that its good part survives a power cut during the repair.
std::string copy_aside(Disk& disk, const std::string& file, std::string_view why);

}  // namespace adit::store
