#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/store/disk.hpp"

namespace adit::store {

/// What a file is meant to be.
struct StateFormat {
  std::array<char, 4> kind{};        ///< of state: another one's file is foreign
  std::uint16_t version{1};          ///< of the payload
  std::size_t max_bytes{16 * 1024};  ///< bytes of payload
};

/// What was found in the place of a state.
enum class LoadStatus {
  good,
  nothing,     ///< no such file: the first start
  foreign,     ///< no file of ours, or of another kind
  torn,        ///< ends too early
  corrupt,     ///< bytes are not what was written
  older,       ///< whole, of an earlier version
  newer,       ///< whole, of a later version
  unreadable,  ///< the disk refused
};
/// "torn", as it is told to people.
std::string_view name(LoadStatus found);

struct State {
  LoadStatus found{LoadStatus::nothing};
  std::string text{};          ///< what is wrong, for people; empty when good or nothing
  std::uint64_t generation{};  ///< rises with every save
  Bytes payload{};             ///< good, or older: then in the layout of `version`
  std::uint16_t version{};     ///< of the payload; 0 when the header cannot be trusted
  /// Torn, corrupt or foreign: what follows the place of the header, unchecked, for formats whose payload
  /// carries checksums of its own.
  Bytes remains{};
};

/// A header that never changes, the payload, a checksum over both:
/// "ADIT", kind, u16 version, u16 zero, u32 payload bytes, u64 generation | payload | u32 CRC-32C. Little
/// endian.
Bytes encode_envelope(const StateFormat& format, std::uint64_t generation,
                      std::span<const std::uint8_t> payload);
/// Never fails otherwise than by what it found, whatever the bytes are.
State decode_envelope(const StateFormat& format, std::span<const std::uint8_t> bytes);

/// One state in one file: written whole, durable when save() returns. Whoever finds anything but `good` or
/// `nothing` must not guess.
class StateFile {
 public:
  StateFile(std::shared_ptr<Disk> disk, std::string file, StateFormat format)
      : disk_(std::move(disk)), file_(std::move(file)), format_(format) {}

  State load() const;
  /// Errors: cannot_write, out_of_range when the payload is longer than the format allows; the old state
  /// stays then.
  Result<void> save(std::uint64_t generation, std::span<const std::uint8_t> payload) const;
  const Disk& disk() const { return *disk_; }

 private:
  std::shared_ptr<Disk> disk_;
  std::string file_;
  StateFormat format_;
};

}  // namespace adit::store
