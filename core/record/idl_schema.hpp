// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace adit::record {

/// Schema of a type of idl/ for a recording.
struct IdlSchema {
  std::string name{};  ///< Scoped name in the text: "adit::radio::Command", "sensor_msgs::msg::PointCloud2".
  std::string text{};  ///< OMG IDL of the type, with everything that it includes.
};

/// Returns the schema of a DDS type name; ROS 2's names ("sensor_msgs::msg::dds_::PointCloud2_") are known,
/// too. The texts are those that the program was built from. nullopt: idl/ has no such type.
std::optional<IdlSchema> idl_schema(std::string_view dds_type);

}  // namespace adit::record
