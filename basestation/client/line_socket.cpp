// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/line_socket.hpp"

#include <fcntl.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>

namespace adit::station::client {

LineSocket::LineSocket(File socket) : file_(std::move(socket)) {
  ::fcntl(file_.get(), F_SETFL, ::fcntl(file_.get(), F_GETFL) | O_NONBLOCK);
}

Result<LineSocket> LineSocket::connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    return {Reason::cannot_read, "the path " + path + " is too long for a socket; set XDG_RUNTIME_DIR"};
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  File file(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!file) return {Reason::cannot_read, std::string("no socket: ") + std::strerror(errno)};
  // A station that hangs accepts nothing: once its queue is full, a blocking connect would wait for it
  // forever.
  const bool connected =
      ::connect(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (!connected && errno == EAGAIN)
    return {Reason::cannot_read, "the station at " + path + " hangs; end its process"};
  if (!connected) return {Reason::no_station, "nobody listens at " + path + ": " + std::strerror(errno)};
  return LineSocket(std::move(file));
}

bool LineSocket::pump() {
  char buffer[16384];
  for (;;) {
    const ssize_t size = ::recv(file_.get(), buffer, sizeof buffer, 0);
    if (size > 0) {
      in_.append(buffer, static_cast<std::size_t>(size));
      if (in_.size() > kMaxLine && in_.find('\n') == std::string::npos) return false;
      if (in_.size() > 4 * kMaxLine) return true;  // The rest is read after these lines are taken.
    } else {
      return size < 0 && (errno == EAGAIN || errno == EINTR);
    }
  }
}

std::optional<std::string> LineSocket::line() {
  const std::size_t end = in_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string text = in_.substr(0, end);
  in_.erase(0, end + 1);
  return text;
}

bool LineSocket::send_line(const std::string& text) {
  if (out_.size() > kMaxBacklog) return false;
  out_ += text + "\n";
  return flush();
}

bool LineSocket::is_read() const {
  int unread = 0;
  return out_.empty() && ::ioctl(file_.get(), SIOCOUTQ, &unread) == 0 && unread == 0;
}

void LineSocket::stop_reading() {
  ::shutdown(file_.get(), SHUT_RD);
  in_.clear();
}

pid_t LineSocket::peer_pid() const {
  ucred peer{};
  socklen_t size = sizeof peer;
  return ::getsockopt(file_.get(), SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 ? peer.pid : 0;
}

bool LineSocket::flush() {
  while (!out_.empty()) {
    const ssize_t size = ::send(file_.get(), out_.data(), out_.size(), MSG_NOSIGNAL);
    if (size > 0)
      out_.erase(0, static_cast<std::size_t>(size));
    else if (size < 0 && errno == EINTR)
      continue;
    else
      return size < 0 && errno == EAGAIN;
  }
  return true;
}

}  // namespace adit::station::client
