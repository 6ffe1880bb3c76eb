// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/record/bytes.hpp"
#include "core/result/result.hpp"

namespace adit::record {

/// Destination of the bytes of a recording.
class Output {
 public:
  virtual ~Output() = default;
  /// Appends bytes. Error cannot_write: the disk is full, or not available. Bytes appended before remain.
  virtual Result<void> append(ByteSpan data) = 0;
};

/// Writes to memory, for tests and short recordings.
class MemoryOutput final : public Output {
 public:
  Result<void> append(ByteSpan data) override {
    bytes.insert(bytes.end(), data.begin(), data.end());
    return {};
  }
  std::vector<std::uint8_t> bytes{};
};

/// Creates a file of mode 0600. Errors: cannot_write; in_use when `may_exist` is false and there is one.
Result<std::unique_ptr<Output>> open_file(const std::string& path, bool may_exist);

}  // namespace adit::record
