// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

namespace adit::record {

/// A file of idl/, compiled into the program.
struct IdlText {
  const char* path;  ///< Path in idl/: "adit/command.idl", "std_msgs/msg/Header.idl".
  const char* text;
};
std::span<const IdlText> idl_texts();

}  // namespace adit::record
