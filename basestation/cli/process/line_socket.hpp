#pragma once
#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "basestation/cli/process/file.hpp"
#include "core/result/result.hpp"

namespace adit::station::cli {

/// One end of a local stream socket that carries JSON, one object a line. Never blocks; what comes in and
/// what waits to go out is bounded.
class LineSocket {
 public:
  static constexpr std::size_t kMaxLine = 256 << 10;
  static constexpr std::size_t kMaxBacklog = 4 << 20;

  LineSocket() = default;
  explicit LineSocket(File socket);
  /// Errors: no_station (nobody listens there), cannot_read.
  static Result<LineSocket> connect(const std::string& path);

  int fd() const { return file_.get(); }
  /// Reads what has arrived; false when the other side is gone or sent an endless line.
  bool pump();
  /// The next whole line; nullopt when there is none yet.
  std::optional<std::string> line();
  /// Queues an object and sends what fits; false when the other side is gone or does not read.
  bool send(const nlohmann::json& object);
  /// The same for an object that text_of() wrote.
  bool send_line(const std::string& text);
  /// One line without its end; bytes that are no UTF-8 are replaced.
  static std::string text_of(const nlohmann::json& object);
  /// Sends what waits; false when the other side is gone.
  bool flush();
  bool has_backlog() const { return !out_.empty(); }
  /// True when the other side has read all that was sent.
  bool is_read() const;
  /// Reads nothing more; what the other side writes from now on fails there.
  void stop_reading();
  /// The process at the other end; 0 when it is not known.
  pid_t peer_pid() const;

 private:
  File file_{};
  std::string in_{};
  std::string out_{};
};

}  // namespace adit::station::cli
