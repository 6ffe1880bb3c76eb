// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/connection.hpp"

#include <poll.h>

#include <algorithm>
#include <filesystem>

#include "basestation/model/camera_bytes.hpp"
#include "basestation/model/delta.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/json_reader.hpp"
#include "basestation/model/photo_bytes.hpp"

namespace adit::station::client {

using nlohmann::json;

Connection::Connection(LineSocket socket, const std::string& front_end) : socket_(std::move(socket)) {
  json about{{"front_end", front_end}};
  std::error_code failed;
  if (const auto folder = std::filesystem::current_path(failed); !failed) about["folder"] = folder.string();
  send(line_of(about));
}

Connection::~Connection() = default;

void Connection::send(const std::string& line) {
  if (connected_ && can_send_) can_send_ = socket_.send_line(line);
}

std::int64_t Connection::execute(const std::string& line) {
  send(line_of({{"id", next_}, {"do", line}}));
  return next_++;
}

std::int64_t Connection::teleop(const std::string& robot) {
  send(line_of({{"id", next_}, {"teleop", robot}}));
  return next_++;
}

std::int64_t Connection::photo(const std::string& id, findings::PhotoPart part) {
  send(line_of({{"id", next_}, {"photo", id}, {"part", word_of(part)}}));
  return next_++;
}

std::int64_t Connection::camera(const CameraRequest& request) {
  json wanted = json_of(request);
  wanted["id"] = next_;
  send(line_of(wanted));
  return next_++;
}

void Connection::stick(std::int64_t id, double vx, double vy, double wz) {
  send(line_of({{"id", id}, {"stick", {vx, vy, wz}}}));
}

void Connection::cancel(std::int64_t id) { send(line_of({{"cancel", id}})); }
void Connection::hello() { send(line_of({{"hello", true}})); }
void Connection::follow() { send(line_of({{"follow", true}})); }
void Connection::notices() { send(line_of({{"notices", true}})); }

void Connection::map(std::uint64_t run, std::uint64_t revision, const std::optional<LookedAt>& look) {
  json wanted{{"run", run}, {"revision", revision}};
  if (look) wanted["look"] = {look->x, look->y, look->radius};
  send(line_of({{"map", wanted}}));
}

void Connection::handle(const std::string& line) {
  const json object = json::parse(line, nullptr, false);
  const auto misunderstand = [&](const std::string& why) {
    if (not_understood_.empty()) not_understood_ = why;
  };
  if (!object.is_object()) return misunderstand("a line that is no JSON object");
  const auto pass = [&]<class T>(const Result<T>& read, const std::function<void(const T&)>& callback) {
    if (!read) return misunderstand(read.error().text);
    if (callback) callback(*read);
  };
  std::string wrong;
  JsonReader in(object, wrong);
  std::int64_t id = 0;
  std::size_t missed = 0;
  bool more = false;
  in.read("id", id);
  in.read("missed", missed);
  in.read("more", more);
  in.read("cut_off", cut_off_);
  std::string refused;
  in.read("wrong", refused);
  if (!wrong.empty()) return misunderstand("'" + wrong + "' does not fit");
  if (!refused.empty()) return misunderstand("it refuses a request: " + refused);
  if (const auto world = object.find("world"); world != object.end()) {
    world_ = std::make_unique<WorldBuilder>();
    if (const auto started = world_->start(*world); !started) return misunderstand(started.error().text);
    if (on_world) on_world(world_->world());
  }
  if (const auto delta = object.find("delta"); delta != object.end() && world_) {
    if (const auto applied = world_->apply(*delta); !applied) {
      misunderstand(applied.error().text);
      world_.reset();
      return follow();
    }
    if (on_world) on_world(world_->world());
  }
  if (const auto notice = object.find("notice"); notice != object.end())
    pass(notice_from(*notice), std::function([&](const Notice& heard) {
           if (world_) world_->add(heard);
           if (on_notice) on_notice(heard);
         }));
  if (const auto hello = object.find("hello"); hello != object.end() && on_hello) {
    StationOptions running;
    JsonReader about(*hello, wrong);
    about.read("station", running.name);
    about.read("domain", running.domain);
    about.read("link", running.link);
    about.read("interfaces", running.interfaces);
    about.read("peers", running.peers);
    if (!wrong.empty()) return misunderstand("'" + wrong + "' does not fit");
    on_hello(running);
  }
  if (missed > 0 && on_missed) on_missed(missed);
  if (object.contains("event")) return pass(event_from(object), on_command);
  if (const auto update = object.find("map"); update != object.end()) {
    auto read = map_update_from(*update);
    if (!read) return misunderstand(read.error().text);
    if (on_map) on_map(std::move(*read), more);
  }
  if (object.contains("begun") && on_begun) on_begun(id);
  if (const auto outcome = object.find("outcome"); outcome != object.end())
    pass(outcome_from(*outcome), std::function([&](const CommandOutcome& ended) {
           if (on_outcome) on_outcome(id, ended);
         }));
}

std::string Connection::gone() const {
  return cut_off_.empty() ? "the station ended before it answered"
                          : "the station ended the connection: " + cut_off_;
}

bool Connection::wait(int timeout_ms, int other_fd) {
  if (!connected_) return false;
  pollfd fds[2] = {{socket_.fd(), static_cast<short>(POLLIN | (socket_.has_backlog() ? POLLOUT : 0)), 0},
                   {other_fd, POLLIN, 0}};
  const bool ready =
      ::poll(fds, other_fd >= 0 ? 2 : 1, can_send_ ? timeout_ms : 0) > 0 && fds[0].revents != 0;
  if (can_send_ && !ready) return true;
  can_send_ = can_send_ && socket_.flush();
  // Reads after the last send: if that failed, the station may have written the reason.
  const bool open = socket_.pump() && can_send_;
  for (auto line = socket_.line(); line; line = socket_.line()) handle(*line);
  connected_ = connected_ && open;
  return connected_;
}

std::string quoted(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
             std::string_view("_-+./:").find(c) != std::string_view::npos;
    });
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace adit::station::client
