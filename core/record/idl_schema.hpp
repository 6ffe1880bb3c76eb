#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace adit::record {

/// A type of idl/ as a recording describes it.
struct IdlSchema {
  std::string name{};  ///< scoped name in the text: "adit::radio::Command", "sensor_msgs::msg::PointCloud2"
  std::string text{};  ///< OMG IDL of the type, with all that it includes
};

/// By DDS type name; ROS 2's ("sensor_msgs::msg::dds_::PointCloud2_") are known, too. The texts are those the
/// program was built from. nullopt: no such type in idl/.
std::optional<IdlSchema> idl_schema(std::string_view dds_type);

}  // namespace adit::record
