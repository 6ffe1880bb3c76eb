// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace adit::wire {

/// Version of the radio contract. Every type name of the radio domain contains it, so endpoints of releases
/// that cannot read each other do not match. It changes with every change of a type in idl/adit/.
inline constexpr int kContractVersion = 1;
inline constexpr std::string_view kContractTypes = "adit::radio::v1::";

/// Returns the contract version in a type name when it differs from ours: "2", or "0" for a type name without
/// a version. Empty for our own version and for types outside the contract.
inline std::string other_release(std::string_view type) {
  constexpr std::string_view family = "adit::radio::";
  if (!type.starts_with(family) || type.starts_with(kContractTypes)) return {};
  type.remove_prefix(family.size());
  if (!type.starts_with('v')) return "0";
  const std::string_view version = type.substr(1, type.find("::") - 1);
  const bool number = !version.empty() && version.size() < 6 &&
                      version.find_first_not_of("0123456789") == std::string_view::npos;
  return number ? std::string(version) : "0";
}
/// Text for the operator about a station or robot of another release.
inline std::string describe_release(std::string_view name, const std::string& version) {
  return std::string(name.substr(0, 64)) + " speaks version " + version +
         " of the radio contract, we speak " + std::to_string(kContractVersion) +
         ": neither hears the other; install the same release on both";
}

}  // namespace adit::wire
