// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <optional>
#include <string>

#include "basestation/client/file.hpp"
#include "core/result/result.hpp"

namespace adit::station::client {

/// One end of a local stream socket that carries lines of text. Never blocks; input and output
/// buffers are bounded.
class LineSocket {
 public:
  static constexpr std::size_t kMaxLine = 2 << 20;  ///< The state of 64 robots with 16 areas each is 0.8 MB.
  static constexpr std::size_t kMaxBacklog = 4 << 20;

  LineSocket() = default;
  explicit LineSocket(File socket);
  /// Connects to a listening socket. Errors: no_station (no process listens there), cannot_read.
  static Result<LineSocket> connect(const std::string& path);

  int fd() const { return file_.get(); }
  /// Reads the available bytes; returns false if the peer closed the connection or sent a line that is too
  /// long.
  bool pump();
  /// The next complete line; nullopt if there is none yet.
  std::optional<std::string> line();
  /// Queues a line and sends as much as possible; returns false if the peer closed the connection or does not
  /// read. `text`: without the newline.
  bool send_line(const std::string& text);
  /// Sends queued output; returns false if the peer closed the connection.
  bool flush();
  bool has_backlog() const { return !out_.empty(); }
  /// Whether the peer has read everything that was sent.
  bool is_read() const;
  /// Stops reading; further writes of the peer fail.
  void stop_reading();
  /// Process id of the peer; 0: unknown.
  pid_t peer_pid() const;

 private:
  File file_{};
  std::string in_{};
  std::string out_{};
};

}  // namespace adit::station::client
