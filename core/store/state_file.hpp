// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/store/disk.hpp"

namespace adit::store {

/// Expected format of a file.
struct StateFormat {
  std::array<char, 4> kind{};        ///< Kind of state: a file of another kind is foreign.
  std::uint16_t version{1};          ///< Version of the payload.
  std::size_t max_bytes{16 * 1024};  ///< Largest payload, bytes.
};

/// Result of loading a state.
enum class LoadStatus {
  good,
  nothing,     ///< No such file: the first start.
  foreign,     ///< Not a state file, or one of another kind.
  torn,        ///< Truncated.
  corrupt,     ///< The checksum does not match.
  older,       ///< Complete, of an earlier version.
  newer,       ///< Complete, of a later version.
  unreadable,  ///< The disk refused.
};
/// Name for users, such as "torn".
std::string_view name(LoadStatus found);

/// Result of loading a state.
struct State {
  LoadStatus found{LoadStatus::nothing};
  std::string text{};          ///< Error text for users; empty when `good` or `nothing`.
  std::uint64_t generation{};  ///< Rises with every save.
  Bytes payload{};             ///< Valid when good, or older: then in the layout of `version`.
  std::uint16_t version{};     ///< Version of the payload; 0 when the header cannot be trusted.
  /// Torn, corrupt or foreign: the bytes after the position of the header, unchecked, for formats whose
  /// payload has checksums of its own.
  Bytes remains{};
};

/// Encodes a fixed header, the payload, and a checksum over both: "ADIT", kind, u16 version, u16 zero, u32
/// payload bytes, u64 generation | payload | u32 CRC-32C. Little endian.
Bytes encode_envelope(const StateFormat& format, std::uint64_t generation,
                      std::span<const std::uint8_t> payload);
/// Decodes any bytes; errors appear only in the result.
State decode_envelope(const StateFormat& format, std::span<const std::uint8_t> bytes);

/// One state in one file: save() replaces it atomically and is durable on return. After a result other than
/// `good` or `nothing`, the caller must not assume a default state.
class StateFile {
 public:
  StateFile(std::shared_ptr<Disk> disk, std::string file, StateFormat format)
      : disk_(std::move(disk)), file_(std::move(file)), format_(format) {}

  State load() const;
  /// Saves a state. Errors: cannot_write; out_of_range when the payload is longer than the format allows. The
  /// old state then remains.
  Result<void> save(std::uint64_t generation, std::span<const std::uint8_t> payload) const;
  const Disk& disk() const { return *disk_; }

 private:
  std::shared_ptr<Disk> disk_;
  std::string file_;
  StateFormat format_;
};

}  // namespace adit::store
