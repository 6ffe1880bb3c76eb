#include "basestation/cli/process/server.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "basestation/cli/process/snapshot.hpp"
#include "core/command/words.hpp"

namespace adit::station::cli {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr int snapshot_period_ms = 200;
constexpr std::size_t max_replies = 4096;

json outcome_json(std::int64_t id, const Outcome& outcome) {
  return {{"id", id},
          {"outcome",
           {{"exit", outcome.exit_code},
            {"text", outcome.text},
            {"error", outcome.error},
            {"json", outcome.json}}}};
}

/// Only the user who runs the station, and root, may command it.
bool allowed(int fd) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return false;
  return peer.uid == ::geteuid() || peer.uid == 0;
}

}  // namespace

Result<std::unique_ptr<Server>> Server::open(const std::string& folder, const std::string& name) {
  std::unique_ptr<Server> server(new Server);
  server->path_ = folder + "/" + name + ".sock";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (server->path_.size() >= sizeof address.sun_path)
    return {Reason::cannot_write,
            "the path " + server->path_ + " is too long for a socket; set XDG_RUNTIME_DIR"};
  std::memcpy(address.sun_path, server->path_.c_str(), server->path_.size() + 1);

  // The lock goes with the process, however it ends; the socket's file does not.
  const std::string lock = folder + "/" + name + ".lock";
  server->lock_.reset(::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!server->lock_) return {Reason::cannot_write, "cannot write " + lock + ": " + std::strerror(errno)};
  if (::flock(server->lock_.get(), LOCK_EX | LOCK_NB) != 0)
    return {Reason::in_use, "a station named " + name + " is running already"};
  ::unlink(server->path_.c_str());

  server->listener_.reset(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const mode_t mask = ::umask(0177);
  const bool bound =
      server->listener_ &&
      ::bind(server->listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int error = errno;
  ::umask(mask);
  if (!bound || ::listen(server->listener_.get(), 16) != 0)
    return {Reason::cannot_write,
            "cannot listen at " + server->path_ + ": " + std::strerror(bound ? errno : error)};
  server->wake_.reset(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!server->wake_) return {Reason::internal, std::string("no eventfd: ") + std::strerror(errno)};
  return server;
}

Server::~Server() {
  if (listener_) ::unlink(path_.c_str());
}

void Server::reply(std::uint64_t client, json object) {
  {
    const std::lock_guard guard(mutex_);
    if (replies_.size() < max_replies) replies_.push_back({client, std::move(object)});
  }
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);  // full means that it wakes anyway
}

void Server::end() {
  ending_ = true;
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);
}

void Server::tell(const json& notice) { reply(0, {{"notice", notice}}); }

void Server::accept_client() {
  File socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!socket || clients_.size() >= max_clients || !allowed(socket.get())) return;
  clients_[next_client_++].socket = LineSocket(std::move(socket));
}

void Server::drop(std::uint64_t number) {
  const auto found = clients_.find(number);
  if (found == clients_.end()) return;
  for (const auto& [id, handle] : found->second.open)
    strand_->post([station = station_, h = handle] { station->cancel(*h); });
  clients_.erase(found);
}

void Server::begin(std::uint64_t number, Client& client, std::int64_t id, const json& request) {
  const auto handle = std::make_shared<std::uint64_t>(0);
  client.open[id] = handle;
  const auto text = [&](const char* key) {
    const auto found = request.find(key);
    return found != request.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const std::string line = text("do");
  const std::string robot = text("teleop");
  strand_->post([this, number, id, line, robot, handle] {
    const auto done = [this, number, id](const Outcome& outcome) {
      reply(number, outcome_json(id, outcome));
    };
    reply(number, {{"id", id}, {"begun", true}});
    *handle = robot.empty() ? station_->execute(line, done) : station_->teleop(robot, done);
  });
}

bool Server::handle(std::uint64_t number, Client& client, const std::string& line) {
  const json request = json::parse(line, nullptr, false);
  const auto wrong = [&](const char* text) { return client.socket.send({{"wrong", text}}); };
  if (!request.is_object()) return wrong("a JSON object was expected");
  const auto integer = [&](const char* key) -> std::int64_t {
    const auto found = request.find(key);
    return found != request.end() && found->is_number_integer() ? found->get<std::int64_t>() : 0;
  };
  if (request.contains("hello")) return client.socket.send({{"hello", hello_}});
  if (request.contains("watch")) return client.watches = true;
  if (request.contains("notices")) return client.notices = true;
  if (request.contains("cancel")) {
    const auto found = client.open.find(integer("cancel"));
    if (found != client.open.end())
      strand_->post([station = station_, h = found->second] { station->cancel(*h); });
    return true;
  }
  const std::int64_t id = integer("id");
  if (id <= 0) return wrong("an id above 0 was expected");
  if (const auto stick = request.find("stick"); stick != request.end()) {
    std::array<double, 3> velocity{};
    const bool numbers =
        stick->is_array() && stick->size() == 3 &&
        std::all_of(stick->begin(), stick->end(), [](const json& v) { return v.is_number(); });
    if (!numbers) return wrong("a stick has three numbers");
    for (std::size_t i = 0; i < 3; ++i) velocity[i] = std::clamp((*stick)[i].get<double>(), -20.0, 20.0);
    const auto found = client.open.find(id);
    if (found != client.open.end())
      strand_->post([station = station_, h = found->second, velocity] { station->stick(*h, velocity); });
    return true;
  }
  const auto text = [&](const char* key) {
    const auto found = request.find(key);
    return found != request.end() && found->is_string();
  };
  if (!text("do") && !text("teleop")) return wrong("no request that this version knows");
  if (text("teleop") && !command::valid_name(request["teleop"].get<std::string>()))
    return wrong("teleop wants a robot's name");
  if (client.open.contains(id)) return wrong("the id is in use");
  if (client.open.size() >= max_open) return wrong("too many requests at once");
  begin(number, client, id, request);
  return true;
}

void Server::deliver() {
  std::vector<Reply> replies;
  {
    const std::lock_guard guard(mutex_);
    replies.swap(replies_);
  }
  for (Reply& next : replies) {
    if (next.client == 0) {
      const bool snapshot = next.object.contains("snapshot");
      if (snapshot) snapshot_asked_ = false;
      std::vector<std::uint64_t> gone;
      for (auto& [number, client] : clients_)
        if ((snapshot ? client.watches : client.notices) && !client.socket.send(next.object))
          gone.push_back(number);
      for (const std::uint64_t number : gone) drop(number);
      continue;
    }
    const auto found = clients_.find(next.client);
    if (found == clients_.end()) continue;
    Client& client = found->second;
    if (next.object.contains("outcome")) client.open.erase(next.object.value("id", std::int64_t{0}));
    if (!client.socket.send(next.object)) drop(next.client);
  }
}

void Server::ask_snapshot() {
  const bool wanted =
      std::any_of(clients_.begin(), clients_.end(), [](const auto& c) { return c.second.watches; });
  if (!wanted || snapshot_asked_) return;
  snapshot_asked_ = true;
  strand_->post([this] { reply(0, {{"snapshot", snapshot_json(*station_)}}); });
}

void Server::serve(Station& station, Executor& strand, const json& hello, int stop_fd) {
  station_ = &station;
  strand_ = &strand;
  hello_ = hello;
  auto next_snapshot = std::chrono::steady_clock::now();
  while (!ending_) {
    std::vector<pollfd> fds{{stop_fd, POLLIN, 0}, {wake_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
    std::vector<std::uint64_t> numbers;
    bool watched = false;
    for (const auto& [number, client] : clients_) {
      const short events = static_cast<short>(POLLIN | (client.socket.has_backlog() ? POLLOUT : 0));
      fds.push_back({client.socket.fd(), events, 0});
      numbers.push_back(number);
      watched = watched || client.watches;
    }
    if (::poll(fds.data(), fds.size(), watched ? snapshot_period_ms : -1) < 0 && errno != EINTR) return;
    if (fds[0].revents != 0) return;
    if (fds[1].revents != 0) {
      std::uint64_t count = 0;
      (void)!::read(wake_.get(), &count, sizeof count);
      deliver();
    }
    if (fds[2].revents != 0) accept_client();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto found = clients_.find(numbers[i]);
      if (found == clients_.end() || fds[i + 3].revents == 0) continue;
      Client& client = found->second;
      bool good = client.socket.pump() && client.socket.flush();
      // What came with the last bytes of a client that closed is done all the same.
      for (auto line = client.socket.line(); line; line = client.socket.line())
        if (!handle(numbers[i], client, *line)) good = false;
      if (!good) drop(numbers[i]);
    }
    if (const auto now = std::chrono::steady_clock::now(); now >= next_snapshot) {
      ask_snapshot();
      next_snapshot = now + std::chrono::milliseconds(snapshot_period_ms - 10);
    }
  }
  // The last answers, for clients that still read.
  deliver();
  for (auto& [number, client] : clients_) {
    pollfd writable{client.socket.fd(), POLLOUT, 0};
    for (int i = 0; i < 10 && client.socket.has_backlog(); ++i)
      if (::poll(&writable, 1, 20) < 0 || !client.socket.flush()) break;
  }
}

}  // namespace adit::station::cli
