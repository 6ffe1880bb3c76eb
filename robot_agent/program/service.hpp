#pragma once
#include <string>
#include <string_view>

namespace adit::agent {

/// Tells the service manager how we are: the protocol of sd_notify(3), a datagram on the socket that
/// NOTIFY_SOCKET names. Without one nothing is sent.
class Service {
 public:
  /// `socket`: a path, or "@name" for an abstract one; as in NOTIFY_SOCKET. Empty: nobody listens.
  explicit Service(std::string socket) : socket_(std::move(socket)) {}
  static Service from_environment();

  /// "READY=1", "WATCHDOG=1", "STOPPING=1", "STATUS=..."; from any thread, never waits. False when it was not
  /// sent.
  bool notify(std::string_view state) const;

 private:
  std::string socket_;
};

}  // namespace adit::agent
