#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace adit::bench {

/// Fast DDS with nothing of ours around it: one participant on UDP loopback, one writer, one reader, best
/// effort. What our wire is measured against.
class BareDds {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t>)>;
  /// `handler` runs in Fast DDS's receiving thread.
  BareDds(unsigned domain, const std::string& writes, const std::string& reads, Handler handler);
  ~BareDds();
  void write(std::span<const std::uint8_t> bytes);
  bool matched() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::bench
