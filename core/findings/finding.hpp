// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/store/state_file.hpp"

/// Findings of robots, on robots and stations alike (rule 9): a set keyed by (robot, id).
namespace adit::findings {

/// The 128 bits that its robot drew at its first start; zero: unknown, for findings of version 1 or 2.
using Owner = std::array<std::uint8_t, 16>;

/// Identity of a finding. Two robots may have one name, for example when one replaces the other: then their
/// owners differ.
struct Key {
  std::string robot{};
  std::uint64_t id{};
  Owner owner{};
  auto operator<=>(const Key&) const = default;
};

/// Place relative to a submap of the finding's robot, so that it moves with corrections of the map.
struct Anchor {
  std::uint64_t start{};          ///< Of the submap's key.
  std::uint32_t submap{};         ///< Its number.
  std::array<float, 3> offset{};  ///< In the submap's frame, m; up to kFarthest from its origin.
  float yaw{};                    ///< Of the submap in the map frame when the finding got its place, rad.
  static constexpr float kFarthest = 1000.0f;
  bool operator==(const Anchor&) const = default;
};

/// Names the photo of a finding; photos are stored and sent apart from findings.
struct PhotoRef {
  std::uint64_t content{};    ///< Hash of the whole JPEG; not 0.
  std::uint32_t bytes{};      ///< Of the JPEG; at most kMaxBytes.
  std::uint16_t thumbnail{};  ///< Bytes of its thumbnail; at most kMaxThumbnail.
  static constexpr std::uint32_t kMaxBytes = 262144;
  static constexpr std::uint16_t kMaxThumbnail = 4096;
  bool operator==(const PhotoRef&) const = default;
};

/// Whether a photo has a name, and sizes within their bounds.
bool valid(const PhotoRef& photo);

/// Something that a robot found, with its kind, place and importance. Only its robot changes it; of two
/// findings with the same key the one of the higher revision is valid.
struct Finding {
  static constexpr std::size_t kKind = 32, kText = 128, kData = 400;

  Key key{};                         ///< Unique: two different findings never share a key.
  std::uint32_t revision{};          ///< 0: never changed. Rises with each change, not always by one.
  bool withdrawn{};                  ///< The robot takes it back; a later revision may restore it.
  std::string kind{};                ///< For example artifact, person, gas; 1 to 32 bytes.
  std::uint8_t importance{};         ///< Findings of higher importance are sent first and dropped last.
  std::array<double, 3> position{};  ///< Map frame, m, as the robot had its map then.
  std::uint64_t stamp{};             ///< The robot's clock, ns.
  std::string text{};                ///< At most 128 bytes.
  store::Bytes data{};               ///< At most 400 bytes.
  std::optional<Anchor> anchor{};    ///< The same place; nothing: the robot has no submaps.
  std::optional<PhotoRef> photo{};
  bool operator==(const Finding&) const = default;
};

/// Whether a finding is within its bounds and has a robot's name, a finite place, and an id other than 0.
bool valid(const Finding& finding);

/// Result of decoding the bytes of a file.
struct FindingFile {
  store::LoadStatus found{store::LoadStatus::corrupt};  ///< Equals `good` exactly when there is a finding.
  std::optional<Finding> finding{};
};

/// Whether two findings differ at most in their revision and anchor: a place that stays is no change,
/// whichever submap it belongs to.
bool same_content(const Finding& a, const Finding& b);

/// Encodes a finding as a file with header and checksum, at most `kMaxFindingFile` bytes, of version 3.
store::Bytes to_file(const Finding& finding);
inline constexpr std::size_t kMaxFindingFile = 4096;
/// Decodes a file of version 1 (revision 0, not withdrawn), 2 (no owner, anchor and photo) or 3.
FindingFile read_finding(std::span<const std::uint8_t> bytes);
/// Decodes a finding; nothing when the bytes are no valid file.
inline std::optional<Finding> from_file(std::span<const std::uint8_t> bytes) {
  return read_finding(bytes).finding;
}
/// Formats an id for users and file names, as sixteen hexadecimal digits.
std::string id_text(std::uint64_t id);
/// Formats an owner as 32 hexadecimal digits.
std::string owner_text(const Owner& owner);
/// Reads what owner_text() wrote; an empty text is the unknown owner. Returns false for any other text.
bool read_owner(std::string_view text, Owner& owner);
/// Returns "finding-ROBOT-0123456789abcdef", with the owner's 32 digits behind it if there is one.
std::string file_name(const Key& key);
bool is_finding_file(const std::string& name);

}  // namespace adit::findings
