// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/console.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "robot_agent/common/console_answer.hpp"

namespace adit::agent {
namespace {

constexpr int kPatience = 2000;  // ms, for a line and for its answer.
constexpr std::size_t kLine = 256;

/// An owned file descriptor; the destructor closes it.
class Fd {
 public:
  explicit Fd(int fd = -1) : fd_(fd) {}
  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Fd& operator=(Fd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Fd() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

std::string because() { return std::string(": ") + std::strerror(errno); }

Result<std::string> socket_path(const std::string& robot) {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const std::string folder =
      runtime && *runtime ? std::string(runtime) + "/adit" : "/tmp/adit-" + std::to_string(::geteuid());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return Error{Reason::cannot_write, "cannot make the folder " + folder + because()};
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != ::geteuid() ||
      (status.st_mode & 077) != 0)
    return Error{Reason::cannot_write,
                 folder + " must be a folder that is yours alone: chmod 700 it, or remove it"};
  return folder + "/robot-" + robot + ".sock";
}

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    return Error{Reason::cannot_write, "the path " + path + " is too long for a socket; set XDG_RUNTIME_DIR"};
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

Fd connected(const sockaddr_un& address) {
  Fd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (fd && ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return Fd{};
  return fd;
}

bool readable(int fd, int patience) {
  pollfd wait{fd, POLLIN, 0};
  return ::poll(&wait, 1, patience) > 0;
}

/// Reads up to the end of the line; the result excludes the newline.
std::string read_line(int fd) {
  std::string line;
  char c{};
  while (line.size() < kLine && readable(fd, kPatience) && ::read(fd, &c, 1) == 1 && c != '\n') line += c;
  return line;
}

void write_all(int fd, const std::string& text) {
  // An error is ignored: a client that closed the connection does not need the answer.
  (void)!::send(fd, text.data(), text.size(), MSG_NOSIGNAL);
}

bool our_user(int fd) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return ::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         (peer.uid == ::geteuid() || peer.uid == 0);
}

/// An answer that arrives on another thread, or not at all.
struct Waiting {
  std::mutex mutex{};
  std::condition_variable come{};
  std::optional<std::string> text{};
};

}  // namespace

struct Console::Server {
  std::string path{};
  ConsoleHandler handler{};
  Fd socket{};
  Fd stop{};
  std::thread thread{};

  void run() {
    for (;;) {
      pollfd wait[2] = {{socket.get(), POLLIN, 0}, {stop.get(), POLLIN, 0}};
      if (::poll(wait, 2, -1) < 0 && errno != EINTR) return;
      if (wait[1].revents != 0) return;
      if (wait[0].revents == 0) continue;
      const Fd client(::accept4(socket.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (client && our_user(client.get())) serve(client.get());
    }
  }
  void serve(int client) const {
    const std::string line = read_line(client);
    if (line.empty()) return;  // A client that only checked whether an agent runs here.
    const auto waiting = std::make_shared<Waiting>();
    handler(line, [waiting](const std::string& text) {
      const std::lock_guard lock(waiting->mutex);
      waiting->text = text;
      waiting->come.notify_one();
    });
    std::unique_lock lock(waiting->mutex);
    waiting->come.wait_for(lock, std::chrono::milliseconds(kPatience),
                           [&] { return waiting->text.has_value(); });
    if (waiting->text) write_all(client, *waiting->text);
  }
};

Console::Console() : server_(std::make_unique<Server>()) {}

Result<std::unique_ptr<Console>> Console::open(const std::string& robot, ConsoleHandler handler) {
  const auto path = socket_path(robot);
  if (!path) return path.error();
  const auto address = address_of(*path);
  if (!address) return address.error();
  if (connected(*address))
    return Error{Reason::in_use, "a robot_agent named " + robot +
                                     " runs on this machine already; stop it, or choose another --name"};
  ::unlink(path->c_str());  // Removes the socket of an agent that was killed.

  std::unique_ptr<Console> console(new Console);
  Server& server = *console->server_;
  server.path = *path;
  server.handler = std::move(handler);
  server.socket = Fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  server.stop = Fd(::eventfd(0, EFD_CLOEXEC));
  if (!server.socket || !server.stop ||
      ::bind(server.socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0 ||
      ::chmod(path->c_str(), 0600) != 0 || ::listen(server.socket.get(), 4) != 0)
    return Error{Reason::cannot_write, "cannot open the console " + *path + because()};
  server.thread = std::thread([&server] { server.run(); });
  return console;
}

Console::~Console() {
  if (!server_->thread.joinable()) return;
  const std::uint64_t one = 1;
  (void)!::write(server_->stop.get(), &one, sizeof one);
  server_->thread.join();
  ::unlink(server_->path.c_str());
}

Result<std::string> ask_console(const std::string& robot, const std::string& line) {
  const auto path = socket_path(robot);
  if (!path) return path.error();
  const auto address = address_of(*path);
  if (!address) return address.error();
  const Fd fd = connected(*address);
  if (!fd)
    return Error{Reason::no_answer, "no robot_agent named " + robot + " runs on this machine as your user"};
  write_all(fd.get(), line + "\n");
  std::string answer;
  char buffer[512];
  while (readable(fd.get(), 2 * kPatience)) {
    const ssize_t got = ::read(fd.get(), buffer, sizeof buffer);
    if (got <= 0) break;
    answer.append(buffer, static_cast<std::size_t>(got));
  }
  if (answer.empty()) return Error{Reason::no_answer, robot + " does not answer"};
  if (!answer.starts_with(kConsoleRefusal)) return answer;
  answer.pop_back();
  return Error{Reason::not_supported, robot + " " + answer};
}

}  // namespace adit::agent
