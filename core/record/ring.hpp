// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "core/record/output.hpp"

namespace adit::record {

/// Folder, names and sizes of the files of a ring.
struct RingParams {
  std::string folder{};  ///< Created when missing, mode 0700.
  std::string name{};    ///< Files are NAME-000001.mcap and so on; [A-Za-z0-9_-].
  int segments{8};  ///< The folder holds at most this many times `segment_bytes` of this name, [2, 1000].
  std::uint64_t segment_bytes{4 << 20};  ///< Size of one file, [4 kB, 1 GB].
  /// Opens a file; replaced in tests.
  std::function<Result<std::unique_ptr<Output>>(const std::string& path)> open{};
};

/// The numbered files of one recorder. The oldest are removed when the files exceed their total size or
/// number. Files of earlier runs count, so that a restart loses nothing of the last minutes.
class Ring {
 public:
  explicit Ring(RingParams params) : params_(std::move(params)) {}
  /// Makes room for a complete segment and opens the next file. Error cannot_write.
  Result<std::unique_ptr<Output>> next();
  /// Path of the file that next() opened last.
  const std::string& path() const { return path_; }
  const RingParams& params() const { return params_; }

 private:
  Result<std::uint64_t> make_room();

  RingParams params_;
  std::string path_{};
};

}  // namespace adit::record
