// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <exception>

#include "core/exec/generation.hpp"
#include "core/wire/participant.hpp"

/// Typed writers and readers over the byte-level wire, for IDL-generated types. Include it in .cpp files,
/// beside the generated type.
namespace adit::wire {

/// Serialises `sample` into `out` (encapsulation header first, little endian).
template <class T>
void encode(const T& sample, std::vector<std::uint8_t>& out) {
  out.resize(4 + T::getCdrSerializedSize(sample));
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(out.data()), out.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  sample.serialize(cdr);
  out.resize(cdr.getSerializedDataLength());
}

/// Deserialises a sample. Returns false when the bytes are no sample of T (wrong encapsulation, truncated, a
/// bool of 2, lengths beyond the data, more than padding after its end). Never throws. A sequence is never
/// longer than the bytes left, so allocations stay below 128 times their number. Bounds of sequences are not
/// checked, as the generated code does not: a receiver that stores a sequence must check its length.
template <class T>
bool decode(std::span<const std::uint8_t> bytes, T& sample) {
  if (bytes.size() < 4 || bytes[0] != 0 || bytes[1] > 1)
    return false;  // Fast CDR would accept parameter lists, too.
  try {
    // FastBuffer takes a mutable pointer, but a deserialising Cdr only reads.
    auto* data = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    eprosima::fastcdr::FastBuffer buffer(data, bytes.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                               eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.read_encapsulation();
    sample.deserialize(cdr);
    constexpr std::size_t padding = 3;  // CDR pads to four bytes.
    return bytes.size() - cdr.getSerializedDataLength() <= padding;
  } catch (const std::exception&) {
    return false;  // The caller counts it as malformed.
  }
}

/// Writes one topic in its generated type; empty until created by make(). Only one strand may write.
template <class T>
class Writer {
 public:
  Writer() = default;
  /// `wire` must outlive the writer. An empty `partition` means the default one. Errors are those of
  /// Participant.
  static Result<Writer> make(Participant& wire, const Topic<T>& topic, const std::string& partition = {}) {
    auto raw = wire.make_writer(topic, partition);
    if (!raw) return raw.error();
    Writer writer;
    writer.raw_ = std::move(*raw);
    return writer;
  }
  /// Makes the writer work only while `generation`, that of the component that owns it, is valid. Call it
  /// before the writer is shared.
  void bind(std::shared_ptr<const Generation> generation) { generation_ = std::move(generation); }
  /// Serialises and queues a sample; never blocks. An error says why it could not be queued, and is also
  /// counted; `cancelled`: the generation was revoked, by any thread, and nothing was written.
  Result<void> write(const T& sample) {
    if (generation_ && !generation_->valid())
      return Error{Reason::cancelled, "the component that writes this topic was replaced"};
    encode(sample, buffer_);
    return raw_->write(buffer_);
  }
  std::size_t matched() const { return raw_ ? raw_->matched() : 0; }
  explicit operator bool() const { return raw_ != nullptr; }

 private:
  std::unique_ptr<RawWriter> raw_{};
  std::shared_ptr<const Generation> generation_{};
  std::vector<std::uint8_t> buffer_{};  // Reused, so that no sample allocates after the first.
};

/// Creates a reader of T: `handler(const T&, const SampleInfo&)` runs on `strand` while `generation`, if
/// there is one, is valid; afterwards samples are dropped.
template <class T, class Handler>
Result<std::unique_ptr<RawReader>> make_reader(Participant& wire, const Topic<T>& topic, Executor& strand,
                                               Handler handler, const std::string& partition = {},
                                               std::shared_ptr<const Generation> generation = nullptr) {
  return wire.make_reader(
      topic, partition, strand,
      [handler = std::move(handler), sample = std::make_shared<T>(), generation = std::move(generation)](
          std::span<const std::uint8_t> bytes, const SampleInfo& info) mutable {
        if (generation && !generation->valid()) return true;
        *sample = T{};
        if (!decode(bytes, *sample)) return false;
        handler(static_cast<const T&>(*sample), info);
        return true;
      });
}

}  // namespace adit::wire
