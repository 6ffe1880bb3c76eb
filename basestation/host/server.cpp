// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/server.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "basestation/client/connection.hpp"
#include "basestation/model/camera_bytes.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/json_reader.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/photo_bytes.hpp"
#include "core/command/parse.hpp"
#include "core/command/words.hpp"

namespace adit::station::host {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

using Clock = std::chrono::steady_clock;

constexpr int kFollowedMs = 200;
constexpr int kPendingMs = 20;
constexpr auto kChangePeriod = 20ms, kMotionPeriod = 100ms;  // Shortest time between two differences.
constexpr auto kSignOfLife = 400ms;   // Longest: a client counts a station silent that says nothing for 1 s.
constexpr std::size_t kMaxTiles = 3;  // In one answer: a tile takes up to 0.1 MB as text.
constexpr std::size_t kMaxEventText = 400;  // Length of an outcome's text in the event for the other clients.

json json_of(const Outcome& outcome) {
  return outcome_json(outcome.exit_code, outcome.text, outcome.error, outcome.json);
}

/// The outcome of a request that was not begun.
json busy(const std::string& why) { return json_of(failed_outcome(kExitRefused, {Reason::queue_full, why})); }

/// Parses a command line; a file in it is relative to `folder`. Errors: as of command::parse().
Result<command::Request> parsed(const std::string& line, const std::string& folder) {
  auto request = command::parse(line);
  if (!request || folder.empty()) return request;
  for (command::ArgumentValue& value : request->values) {
    if ((value.name != "FILE" && value.name != "--export" && value.name != "--photo") ||
        value.words.front().empty())
      continue;
    std::string& file = value.words.front();
    file = (std::filesystem::path(folder) / file).lexically_normal().string();
    // The same bounds as for a typed word.
    if (const auto typed = command::split_words(client::quoted({file})); !typed) return typed.error();
  }
  return request;
}

/// Whether the peer is the user who runs the station, or root.
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

  // The lock ends with the process in any case; the socket's file remains.
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

void Server::wake() {
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);  // If the counter is full, the thread wakes anyway.
}

void Server::hand_over(Reply reply) {
  {
    const std::lock_guard guard(mutex_);
    // The number of answers is bounded by the open requests.
    if (reply.kind != Reply::Kind::answer && handed_over_ == kMaxHandedOver) {
      ++lost_;
    } else {
      handed_over_ += reply.kind == Reply::Kind::answer ? 0 : 1;
      replies_.push_back(std::move(reply));
    }
  }
  wake();
}

void Server::end() {
  ending_ = true;
  wake();
}

void Server::notify(const Notice& notice) {
  hand_over({Reply::Kind::notice, 0, {{"notice", json_of(notice)}}});
}

void Server::accept_client() {
  client::File file(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!file || !allowed(file.get())) return;
  client::LineSocket socket(std::move(file));
  if (clients_.size() >= kMaxClients) {
    const auto leaving =
        std::find_if(clients_.begin(), clients_.end(), [](const auto& c) { return c.second.cut_off; });
    if (leaving == clients_.end()) {
      socket.send_line(line_of(
          {{"cut_off", std::to_string(kMaxClients) + " programs are connected to the station already"}}));
      return;
    }
    drop(leaving->first);
  }
  Client& client = clients_[next_client_++];
  client.pid = socket.peer_pid();
  client.socket = std::move(socket);
}

void Server::cancel_all(Client& client) {
  // The requests of a client end even if the strand's queue is full.
  for (const auto& [id, handle] : std::exchange(client.open, {}))
    strand_->post_control([station = station_, h = handle] { station->cancel(*h); });
}

void Server::drop(std::uint64_t number) {
  const auto found = clients_.find(number);
  if (found == clients_.end()) return;
  cancel_all(found->second);
  if (found->second.follows) --followers_;
  clients_.erase(found);
}

void Server::cut_off(Client& client, const std::string& why) {
  if (client.cut_off) return;
  client.cut_off = true;
  cancel_all(client);
  client.socket.stop_reading();
  client.outbox.clear();
  (void)client.outbox.reply(line_of({{"cut_off", why}}));
}

void Server::answer(Client& client, const json& object) {
  if (!client.outbox.reply(line_of(object)))
    cut_off(client, "the program did not read what the station answered");
}

bool Server::push(Client& client) {
  if (!client.socket.flush()) return false;
  while (!client.socket.has_backlog()) {
    const auto line = client.outbox.next();
    if (!line) return !client.cut_off;
    if (!client.socket.send_line(*line)) return false;
  }
  return true;
}

void Server::begin(std::uint64_t number, Client& client, std::int64_t id, const std::string& line,
                   const std::string& robot) {
  const auto handle = std::make_shared<std::uint64_t>(0);
  client.open[id] = handle;
  const auto answer = [this, number, id](const Outcome& outcome) {
    hand_over({Reply::Kind::answer, number, {{"id", id}, {"outcome", json_of(outcome)}}});
  };
  const bool posted = strand_->post([this, number, id, line, robot, handle, front_end = client.front_end,
                                     folder = client.folder, pid = client.pid, answer] {
    const auto typed = parsed(line, folder);
    const CommandEvent event{.id = ++last_command_,
                             .line = (robot.empty() ? line : "teleop " + robot).substr(0, kMaxEventText),
                             .query = robot.empty() && typed && typed->info->runs == command::Runs::query,
                             .front_end = front_end,
                             .pid = pid};
    const auto done = [this, number, event, answer](const Outcome& outcome) {
      answer(outcome);
      CommandEvent ended = event;
      ended.ended = true;
      ended.exit_code = outcome.exit_code;
      ended.text = outcome.text.substr(0, kMaxEventText);
      ended.error = outcome.error.substr(0, kMaxEventText);
      hand_over({Reply::Kind::event, number, json_of(ended)});
    };
    hand_over({Reply::Kind::answer, number, {{"id", id}, {"begun", true}}});
    hand_over({Reply::Kind::event, number, json_of(event)});
    *handle = robot.empty() ? station_->execute(typed, done) : station_->teleop(robot, done);
  });
  if (posted) return;
  hand_over({Reply::Kind::answer, number, {{"id", id}, {"outcome", busy("the station has too much to do")}}});
}

void Server::ask_map(std::uint64_t number, Client& client, const json& wanted) {
  std::uint64_t run = 0, revision = 0;
  std::string misfit;
  JsonReader in(wanted, misfit);
  in.read("run", run);
  in.read("revision", revision);
  std::array<double, 3> place{};
  in.read("look", place);
  std::optional<LookedAt> look;
  if (in.has("look")) look = LookedAt{place[0], place[1], place[2]};
  if (look && !valid(*look)) in.refuse("look");
  if (!misfit.empty()) return answer(client, {{"wrong", "the map's '" + misfit + "' does not fit"}});
  if (run != run_) revision = 0;  // Revisions of an earlier run mean nothing.
  client.map_asked = strand_->post([this, number, revision, look] {
    if (look) station_->look_at(*look);
    station_->map_since(revision, kMaxTiles, [this, number](MapUpdate update, bool more) {
      update.run = run_;
      hand_over({Reply::Kind::answer, number, {{"map", json_of(update)}, {"more", more}}});
    });
  });
  if (!client.map_asked) answer(client, {{"wrong", "the station has too much to do"}});
}

std::function<void(const json&)> Server::open_request(std::uint64_t number, Client& client, std::int64_t id) {
  client.open[id] = std::make_shared<std::uint64_t>(0);
  return [this, number, id](const json& outcome) {
    hand_over({Reply::Kind::answer, number, {{"id", id}, {"outcome", outcome}}});
  };
}

void Server::ask_photo(std::uint64_t number, Client& client, std::int64_t id, const std::string& photo,
                       const std::string& part) {
  const auto content = photo_id_from(photo);
  const auto which = photo_part_from(part);
  if (!content || !which)
    return answer(client, {{"wrong", "a photo has sixteen hexadecimal digits, and a part"}});
  const auto reply = open_request(number, client, id);
  const bool posted = strand_->post([this, reply, content, which] {
    const store::Bytes* bytes = station_->photo(*content, *which);
    reply(json_of(bytes ? Outcome{.json = photo_json(*bytes)}
                        : failed_outcome(kExitRefused, {Reason::cannot_read, "the photo is not here"})));
  });
  if (!posted) reply(busy("the station has too much to do"));
}

void Server::ask_camera(std::uint64_t number, Client& client, std::int64_t id, const CameraRequest& wanted) {
  const auto reply = open_request(number, client, id);
  const bool posted = strand_->post([this, reply, wanted] {
    Cameras& cameras = station_->cameras();
    if (const auto looked = cameras.look(wanted.robot, wanted.camera, wanted.width, wanted.rate); !looked)
      return reply(json_of(failed_outcome(kExitRefused, looked.error())));
    cameras.next(wanted.robot, wanted.camera, wanted.after, [reply](const CameraPicture& picture) {
      reply(json_of(Outcome{.json = camera_json(picture)}));
    });
  });
  if (!posted) reply(busy("the station has too much to do"));
}

void Server::handle(std::uint64_t number, Client& client, const std::string& text) {
  const json request = json::parse(text, nullptr, false);
  const auto wrong = [&](const std::string& why) { answer(client, {{"wrong", why}}); };
  if (!request.is_object()) return wrong("a JSON object was expected");
  std::int64_t id = 0, cancelled = 0;
  std::string front_end, folder = "/", line, robot, photo, part, misfit;
  std::array<double, 3> stick{};
  JsonReader in(request, misfit);
  in.read("id", id);
  in.read("cancel", cancelled);
  in.read("front_end", front_end);
  in.read("folder", folder);
  in.read("do", line);
  in.read("teleop", robot);
  in.read("photo", photo);
  in.read("part", part);
  in.read("stick", stick);
  if (!misfit.empty()) return wrong("'" + misfit + "' does not fit");
  if (in.has("hello")) return answer(client, {{"hello", hello_}});
  if (in.has("follow")) {
    if (!std::exchange(client.follows, true) && followers_++ == 0) {
      newest_.reset();  // It was not followed for a while and is old.
      newest_world_.reset();
    }
    client.sent.reset();  // It gets the complete state, also if it asks again.
    return ask_world();
  }
  if (in.has("notices")) return void(client.notices = true);
  if (in.has("front_end")) {
    if (!command::valid_name(front_end)) return wrong("a front end has a name of 1 to 32 of A-Z a-z 0-9 _ -");
    client.front_end = front_end;
    if (!folder.starts_with('/')) return wrong("a front end's folder is an absolute path");
    if (in.has("folder")) client.folder = folder;
    return;
  }
  if (in.has("map")) {
    if (client.map_asked) return wrong("the map was asked for already");
    return ask_map(number, client, request["map"]);
  }
  if (in.has("cancel")) {
    const auto found = client.open.find(cancelled);
    if (found != client.open.end())
      strand_->post_control([station = station_, h = found->second] { station->cancel(*h); });
    return;
  }
  if (id <= 0) return wrong("an id above 0 was expected");
  if (in.has("stick")) {
    if (std::ranges::any_of(stick, [](double v) { return std::isnan(v); }))
      return wrong("a stick has three numbers");
    for (double& axis : stick) axis = std::clamp(axis, -20.0, 20.0);
    const StickVelocity velocity{stick[0], stick[1], stick[2]};
    const auto found = client.open.find(id);
    if (found != client.open.end())
      strand_->post([station = station_, h = found->second, velocity] { station->stick(*h, velocity); });
    return;
  }
  if (!in.has("do") && !in.has("teleop") && !in.has("photo") && !in.has("camera"))
    return wrong("no request that this version knows");
  if (in.has("teleop") && !command::valid_name(robot)) return wrong("teleop wants a robot's name");
  if (client.open.contains(id)) return wrong("the id is in use");
  if (client.open.size() >= kMaxOpen)
    return answer(client, {{"id", id}, {"outcome", busy("this program asks for too much at once")}});
  if (in.has("camera")) {
    const auto wanted = camera_request_from(request);
    return wanted ? ask_camera(number, client, id, *wanted) : wrong(wanted.error().text);
  }
  if (in.has("photo")) return ask_photo(number, client, id, photo, part);
  begin(number, client, id, line, robot);
}

void Server::deliver(const Reply& reply) {
  if (reply.kind == Reply::Kind::answer) {
    const auto found = clients_.find(reply.client);
    if (found == clients_.end() || found->second.cut_off) return;
    Client& client = found->second;
    if (reply.object.contains("map")) client.map_asked = false;
    if (reply.object.contains("outcome")) client.open.erase(reply.object.value("id", std::int64_t{0}));
    return answer(client, reply.object);
  }
  const std::string text = reply.kind == Reply::Kind::notice ? line_of(reply.object) : "";
  for (auto& [number, client] : clients_) {
    if (client.cut_off) continue;
    if (reply.kind == Reply::Kind::notice) {
      if (client.notices) client.outbox.event(text);
      continue;
    }
    json event = reply.object;
    event["mine"] = number == reply.client;
    client.outbox.event(line_of(event));
  }
}

void Server::deliver() {
  std::vector<Reply> replies;
  std::optional<World> world;
  std::size_t lost = 0;
  {
    const std::lock_guard guard(mutex_);
    replies.swap(replies_);
    world.swap(world_);
    handed_over_ = 0;
    lost = std::exchange(lost_, 0);
  }
  for (const Reply& next : replies) deliver(next);
  if (world && followers_ > 0) {
    newest_ = std::make_shared<const EncodedWorld>(encoded(*world));
    newest_world_ = std::move(world);
  }
  for (auto& [number, client] : clients_)
    if (!client.cut_off) client.outbox.lost(lost);
}

void Server::changed(const Station& station) {
  if (followers_ > 0) take(station.world());
}

void Server::take(World world) {
  {
    const std::lock_guard guard(mutex_);
    world_ = std::move(world);
  }
  wake();
}

void Server::ask_world() {
  strand_->post([this] { take(station_->world()); });
}

bool Server::follow(Client& client, Clock::time_point now) {
  if (!client.follows || client.cut_off || !newest_ || client.sent == newest_) return false;
  if (!client.sent) {
    answer(client, {{"world", json_of(*newest_world_)}});
    client.sent = newest_;
    client.sent_at = now;
    return false;
  }
  // A client that does not read gets one difference later, not many.
  const auto since = now - client.sent_at;
  if (since < kChangePeriod || !client.outbox.empty() || !client.socket.is_read()) return true;
  const Delta delta = difference(*client.sent, *newest_);
  if (delta.urgency == Urgency::none && since < kSignOfLife) {
    client.sent = newest_;  // Nothing differs between the two.
    return false;
  }
  if (delta.urgency == Urgency::motion && since < kMotionPeriod) return true;
  answer(client, {{"delta", delta.json}});
  client.sent = newest_;
  client.sent_at = now;
  return false;
}

void Server::read(std::uint64_t number, Client& client) {
  const bool open = client.socket.pump();
  // Requests in the last bytes of a client that closed the connection are still executed.
  for (auto line = client.socket.line(); line && !client.cut_off; line = client.socket.line())
    handle(number, client, *line);
  if (!open) drop(number);
}

void Server::serve(Station& station, Executor& strand, const json& hello, int stop_fd) {
  station_ = &station;
  strand_ = &strand;
  hello_ = hello;
  run_ = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  auto next_sign = Clock::now();
  bool pending = false;  // A client that follows is to receive something soon.
  while (!ending_) {
    std::vector<pollfd> fds{{stop_fd, POLLIN, 0}, {wake_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
    std::vector<std::uint64_t> numbers;
    for (const auto& [number, client] : clients_) {
      const short events =
          static_cast<short>((client.cut_off ? 0 : POLLIN) | (client.socket.has_backlog() ? POLLOUT : 0));
      fds.push_back({client.socket.fd(), events, 0});
      numbers.push_back(number);
    }
    const int limit = pending ? kPendingMs : followers_ > 0 ? kFollowedMs : -1;
    if (::poll(fds.data(), fds.size(), limit) < 0 && errno != EINTR) return;
    if (fds[0].revents != 0) return;
    if (fds[1].revents != 0) {
      std::uint64_t count = 0;
      (void)!::read(wake_.get(), &count, sizeof count);
      deliver();
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto found = clients_.find(numbers[i]);
      if (found == clients_.end() || (fds[i + 3].revents & ~POLLOUT) == 0) continue;
      if (found->second.cut_off)
        drop(numbers[i]);  // It disconnected.
      else
        read(numbers[i], found->second);
    }
    if (fds[2].revents != 0) accept_client();
    const auto now = Clock::now();
    pending = false;
    for (auto& [number, client] : clients_) pending = follow(client, now) || pending;
    std::vector<std::uint64_t> gone;
    for (auto& [number, client] : clients_)
      if (!push(client)) gone.push_back(number);
    for (const std::uint64_t number : gone) drop(number);
    if (followers_ > 0 && now >= next_sign) {
      ask_world();
      next_sign = now + kSignOfLife;
    }
  }
  // Sends the last answers to clients that still read.
  deliver();
  for (auto& [number, client] : clients_) {
    pollfd writable{client.socket.fd(), POLLOUT, 0};
    for (int i = 0; i < 10 && push(client) && client.socket.has_backlog(); ++i)
      if (::poll(&writable, 1, 20) < 0) break;
  }
}

}  // namespace adit::station::host
