// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/record/mcap.hpp"
#include "core/record/output.hpp"

namespace adit::record {

struct McapWriterParams {
  std::size_t chunk_bytes{256 << 10};  ///< Bytes of messages after which a chunk is written, [1, 16 MB].
  bool compress{true};                 ///< Compress chunks with Zstandard, if it is built in.
  std::string library{"adit"};         ///< Name of the writing program.
};

/// Writes one MCAP file: chunks with message indexes and CRCs, and at the end statistics, chunk indexes and
/// all schemas and channels again. Schemas and channels precede the first chunk that needs them, so a
/// truncated file is readable up to its last complete chunk. Ids are those of the file, from 1 for schemas
/// and 0 for channels. After an error nothing more is written.
class McapWriter {
 public:
  McapWriter(Output& out, McapWriterParams params);
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& text);
  std::uint16_t add_channel(std::uint16_t schema, const std::string& topic, const std::string& encoding,
                            const Text& metadata);
  /// Writes a message. Errors: cannot_write of the output, out_of_range for a channel that does not exist.
  Result<void> write(std::uint16_t channel, std::uint64_t time, ByteSpan data);
  Result<void> add_metadata(const std::string& name, const Text& entries);
  /// Ends the open chunk, so that everything written so far survives the process.
  Result<void> flush();
  /// Writes summary and footer; nothing may be written afterwards.
  Result<void> close();
  /// Bytes in the file, including the open chunk uncompressed.
  std::uint64_t size() const { return written_ + chunk_.size(); }
  std::uint64_t messages() const { return messages_; }

 private:
  struct ChunkIndex {
    std::uint64_t first{}, last{}, start{}, length{}, index_length{};
    std::map<std::uint16_t, std::uint64_t> indexes{};
    std::string compression{};
    std::uint64_t compressed{}, uncompressed{};
  };
  struct OwnChannel {
    Channel info{};
    std::uint64_t messages{};
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index{};  ///< Index of the open chunk: time, offset.
  };
  struct MetadataIndex {
    std::string name{};
    std::uint64_t start{}, length{};
  };

  Result<void> emit(ByteSpan data);
  std::vector<std::uint8_t> summary_records(std::uint64_t start, std::uint64_t& offsets_start) const;

  Output& out_;
  McapWriterParams params_;
  Result<void> state_{};  ///< The first error.
  std::uint64_t written_{};
  std::uint32_t crc_{};  ///< CRC of all bytes written.
  std::vector<Schema> schemas_{};
  std::vector<OwnChannel> channels_{};
  std::vector<std::uint8_t> chunk_{}, scratch_{}, packed_{};
  std::uint64_t chunk_first_{}, chunk_last_{}, first_{}, last_{}, messages_{};
  std::vector<ChunkIndex> chunks_{};
  std::vector<MetadataIndex> metadata_{};
  bool closed_{};
};

}  // namespace adit::record
