// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace adit::bench {

/// Fast DDS without any code of ours around it: one participant on UDP loopback, one writer, one reader, best
/// effort. It is the baseline of the wire benchmark.
class BareDds {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t>)>;
  /// `handler` runs on Fast DDS's receiving thread.
  BareDds(unsigned domain, const std::string& writes, const std::string& reads, Handler handler);
  ~BareDds();
  void write(std::span<const std::uint8_t> bytes);
  bool matched() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::bench
