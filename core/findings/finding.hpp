#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/store/state_file.hpp"

/// What robots find, on robots and stations alike (rule 9): a set keyed by (robot, id).
namespace adit::findings {

struct Key {
  std::string robot{};
  std::uint64_t id{};
  auto operator<=>(const Key&) const = default;
};

struct Finding {
  static constexpr std::size_t kKind = 32, kText = 128, kData = 400;

  Key key{};                         ///< never two different ones under one key
  std::string kind{};                ///< e.g. artifact, person, gas; 1 to 32 bytes
  std::uint8_t importance{};         ///< higher ones are sent first, and given up last
  std::array<double, 3> position{};  ///< map frame, m
  std::uint64_t stamp{};             ///< the robot's clock, ns
  std::string text{};                ///< at most 128 bytes
  store::Bytes data{};               ///< at most 400 bytes
  bool operator==(const Finding&) const = default;
};

/// Bounds, a robot's name, a finite place, an id that is not 0.
bool valid(const Finding& finding);

/// What the bytes of a file gave.
struct FindingFile {
  store::LoadStatus found{store::LoadStatus::corrupt};  ///< good exactly when there is a finding
  std::optional<Finding> finding{};
};

/// As a sealed file, at most `kMaxFindingFile` bytes.
store::Bytes to_file(const Finding& finding);
inline constexpr std::size_t kMaxFindingFile = 4096;
FindingFile read_finding(std::span<const std::uint8_t> bytes);
/// The finding alone; nothing when the bytes are none that was sealed.
inline std::optional<Finding> from_file(std::span<const std::uint8_t> bytes) {
  return read_finding(bytes).finding;
}
/// Sixteen hexadecimal digits, as people and files see an id.
std::string id_text(std::uint64_t id);
/// "finding-ROBOT-0123456789abcdef"
std::string file_name(const Key& key);
bool is_finding_file(const std::string& name);

}  // namespace adit::findings
