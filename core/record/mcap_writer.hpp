#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/record/mcap.hpp"
#include "core/record/output.hpp"

namespace adit::record {

struct McapWriterParams {
  std::size_t chunk_bytes{256 << 10};  ///< of messages, then the chunk is written, [1, 16 MB]
  bool compress{true};                 ///< chunks by Zstandard, where the build has it
  std::string library{"adit"};         ///< who wrote it
};

/// Writes one MCAP file: chunks with message indexes and CRCs, and at the end statistics, chunk indexes and
/// all schemas and channels again. Schemas and channels stand in front of the chunk that needs them first, so
/// a file that was torn off reads up to its last whole chunk. Ids are those of the file, from 1 for schemas
/// and 0 for channels. After an error nothing more is written.
class McapWriter {
 public:
  McapWriter(Output& out, McapWriterParams params);
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& text);
  std::uint16_t add_channel(std::uint16_t schema, const std::string& topic, const std::string& encoding,
                            const Text& metadata);
  /// Errors: cannot_write of the output, out_of_range for a channel that there is not.
  Result<void> write(std::uint16_t channel, std::uint64_t time, ByteSpan data);
  Result<void> add_metadata(const std::string& name, const Text& entries);
  /// Ends the chunk that is open, so that what was written so far survives the process.
  Result<void> flush();
  /// Summary and footer; nothing may follow.
  Result<void> close();
  /// Bytes in the file with the open chunk as it is.
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
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index{};  ///< of the open chunk: time, offset
  };
  struct MetadataIndex {
    std::string name{};
    std::uint64_t start{}, length{};
  };

  Result<void> emit(ByteSpan data);
  std::vector<std::uint8_t> summary_records(std::uint64_t start, std::uint64_t& offsets_start) const;

  Output& out_;
  McapWriterParams params_;
  Result<void> state_{};  ///< the first error
  std::uint64_t written_{};
  std::uint32_t crc_{};  ///< of all that was written
  std::vector<Schema> schemas_{};
  std::vector<OwnChannel> channels_{};
  std::vector<std::uint8_t> chunk_{}, scratch_{}, packed_{};
  std::uint64_t chunk_first_{}, chunk_last_{}, first_{}, last_{}, messages_{};
  std::vector<ChunkIndex> chunks_{};
  std::vector<MetadataIndex> metadata_{};
  bool closed_{};
};

}  // namespace adit::record
