#pragma once
#include <span>

namespace adit::record {

/// A file of idl/, generated into the program at build time.
struct IdlText {
  const char* path;  ///< from its root: "adit/command.idl", "std_msgs/msg/Header.idl"
  const char* text;
};
std::span<const IdlText> idl_texts();

}  // namespace adit::record
