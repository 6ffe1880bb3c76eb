#pragma once
#include <memory>

#include "core/wire/fastdds/fastdds_wire.hpp"

namespace adit::agent {

/// The parent's own writer of rt/cmd_vel.
class ZeroSender {
 public:
  ZeroSender();
  ~ZeroSender();
  /// Errors of the wire.
  Result<void> open(const wire::FastDdsParams& robot);
  /// Nothing when open() failed; a failed write is followed by the next one.
  void send();

 private:
  struct Endpoints;
  std::unique_ptr<Endpoints> endpoints_;
};

}  // namespace adit::agent
