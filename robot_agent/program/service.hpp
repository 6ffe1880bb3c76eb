// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace adit::agent {

/// Reports the state of this process to the service manager with the protocol of sd_notify(3): a datagram to
/// the socket that NOTIFY_SOCKET names. Without that variable nothing is sent.
class Service {
 public:
  /// `socket`: a path, or "@name" for an abstract one; as in NOTIFY_SOCKET. Empty: nothing is sent.
  explicit Service(std::string socket) : socket_(std::move(socket)) {}
  static Service from_environment();

  /// "READY=1", "WATCHDOG=1", "STOPPING=1", "STATUS=...". Callable from any thread; never blocks. Returns
  /// false if it was not sent.
  bool notify(std::string_view state) const;

 private:
  std::string socket_;
};

}  // namespace adit::agent
