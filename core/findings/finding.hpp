// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/store/state_file.hpp"

/// Findings of robots, on robots and stations alike (rule 9): a set keyed by (robot, id).
namespace adit::findings {

/// Identity of a finding.
struct Key {
  std::string robot{};
  std::uint64_t id{};
  auto operator<=>(const Key&) const = default;
};

/// Something that a robot found, with its kind, place and importance. Only its robot changes it; of two
/// findings with the same key the one of the higher revision is valid.
struct Finding {
  static constexpr std::size_t kKind = 32, kText = 128, kData = 400;

  Key key{};                         ///< Unique: two different findings never share a key.
  std::uint32_t revision{};          ///< 0: never changed. Rises with each change, not always by one.
  bool withdrawn{};                  ///< The robot takes it back; a later revision may restore it.
  std::string kind{};                ///< For example artifact, person, gas; 1 to 32 bytes.
  std::uint8_t importance{};         ///< Findings of higher importance are sent first and dropped last.
  std::array<double, 3> position{};  ///< Map frame, m.
  std::uint64_t stamp{};             ///< The robot's clock, ns.
  std::string text{};                ///< At most 128 bytes.
  store::Bytes data{};               ///< At most 400 bytes.
  bool operator==(const Finding&) const = default;
};

/// Whether a finding is within its bounds and has a robot's name, a finite position, and an id other than 0.
bool valid(const Finding& finding);

/// Result of decoding the bytes of a file.
struct FindingFile {
  store::LoadStatus found{store::LoadStatus::corrupt};  ///< Equals `good` exactly when there is a finding.
  std::optional<Finding> finding{};
};

/// Whether two findings differ at most in their revision.
bool same_content(const Finding& a, const Finding& b);

/// Encodes a finding as a file with header and checksum, at most `kMaxFindingFile` bytes, of version 2.
store::Bytes to_file(const Finding& finding);
inline constexpr std::size_t kMaxFindingFile = 4096;
/// Decodes a file of version 1 (revision 0, not withdrawn) or 2.
FindingFile read_finding(std::span<const std::uint8_t> bytes);
/// Decodes a finding; nothing when the bytes are no valid file.
inline std::optional<Finding> from_file(std::span<const std::uint8_t> bytes) {
  return read_finding(bytes).finding;
}
/// Formats an id for users and file names, as sixteen hexadecimal digits.
std::string id_text(std::uint64_t id);
/// Returns "finding-ROBOT-0123456789abcdef".
std::string file_name(const Key& key);
bool is_finding_file(const std::string& name);

}  // namespace adit::findings
