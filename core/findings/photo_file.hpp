// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/findings/finding.hpp"
#include "core/store/state_file.hpp"

namespace adit::findings {

/// The two parts of a photo that are sent and stored apart from each other.
enum class PhotoPart : std::uint8_t { thumbnail = 0, picture = 1 };

/// Bytes of a block: a picture or thumbnail is sent in blocks, the last of which may be shorter. A piece with
/// one is as long as a frame of links below 250 kbit/s has room for (356 bytes).
inline constexpr std::size_t kPhotoBlock = 336;
constexpr std::size_t blocks_of(std::size_t bytes) { return (bytes + kPhotoBlock - 1) / kPhotoBlock; }

/// A part of a photo that arrives in blocks, in any order.
class BlockBuffer {
 public:
  BlockBuffer() = default;
  explicit BlockBuffer(std::size_t bytes) : bytes_(bytes), has_(blocks_of(bytes)), left_(has_.size()) {}
  explicit BlockBuffer(store::Bytes whole)
      : bytes_(std::move(whole)), has_(blocks_of(bytes_.size()), true), left_(0) {}

  /// Stores the blocks from `first` on. Returns false, and stores nothing, if they do not fit.
  bool add(std::size_t first, std::span<const std::uint8_t> data);
  /// Whether all blocks from `first` on that `bytes` bytes cover are here.
  bool has(std::size_t first, std::size_t bytes) const;
  bool complete() const { return left_ == 0 && !bytes_.empty(); }
  std::size_t blocks() const { return has_.size(); }
  std::size_t blocks_here() const { return has_.size() - left_; }
  /// All bytes; those that are not here yet are 0.
  const store::Bytes& bytes() const { return bytes_; }
  /// The bytes of one block.
  std::span<const std::uint8_t> block(std::size_t index) const;

 private:
  store::Bytes bytes_{};
  std::vector<bool> has_{};
  std::size_t left_{};
};

/// A photo as far as it is stored.
struct StoredPhoto {
  PhotoRef ref{};
  std::uint8_t importance{};           ///< Of its finding.
  BlockBuffer thumbnail{}, picture{};  ///< `picture`: empty until the first block came.

  bool complete() const { return thumbnail.complete() && picture.complete(); }
  /// Memory that it takes, bytes.
  std::size_t cost() const { return thumbnail.bytes().size() + picture.bytes().size(); }
};

/// Encodes a complete photo with header and checksum.
store::Bytes to_photo_file(const StoredPhoto& photo, std::uint64_t order);
/// Decodes a complete photo and checks its hash. `order` is what to_photo_file() got.
store::LoadStatus read_photo_file(std::span<const std::uint8_t> bytes, StoredPhoto& photo,
                                  std::uint64_t& order);

/// A photo that is not complete is a file of records, each with a checksum: a head, and blocks in the order
/// in which they came.
store::Bytes photo_head_record(const StoredPhoto& photo);
store::Bytes photo_block_record(PhotoPart part, std::size_t first, std::span<const std::uint8_t> data);
/// All records of a photo.
store::Bytes photo_records(const StoredPhoto& photo);
/// Reads records up to the first one that is damaged or cut. Returns false without a head; sets `all` if
/// every byte was read.
bool read_photo_records(std::span<const std::uint8_t> bytes, StoredPhoto& photo, bool& all);

inline constexpr std::size_t kMaxPhotoFile = 512 * 1024;  ///< Of both kinds, bytes.
/// "photo-0123456789abcdef", for a photo that is not complete with ".part" behind it.
std::string photo_file_name(std::uint64_t content, bool complete);
bool is_photo_file(std::string_view name, std::uint64_t& content, bool& complete);

}  // namespace adit::findings
