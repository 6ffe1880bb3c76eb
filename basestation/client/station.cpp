// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/station.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include "basestation/client/connection.hpp"
#include "basestation/client/paths.hpp"
#include "basestation/client/stop.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::station::client {
namespace {

using namespace std::chrono_literals;

constexpr auto kSeek = 200ms;  // Period in which a lost station is sought.
constexpr auto kMapPeriod = 1000ms;
constexpr auto kMapAnswer = 5000ms;  // Later, it is asked for again.
constexpr int kPollMs = 200;
constexpr std::size_t kMaxCalls = 256;  // That wait to be written.

CommandOutcome no_answer(const std::string& why) { return {.exit_code = kExitNoAnswer, .error = why + "\n"}; }

}  // namespace

Result<std::unique_ptr<Station>> Station::open(const StationOptions& options, const std::string& front_end) {
  auto connected = connect_or_launch(options);
  if (!connected) return connected.error();
  return std::unique_ptr<Station>(new Station(options, front_end, std::move(*connected)));
}

Station::Station(const StationOptions& options, std::string front_end, Connected connected)
    : front_end_(std::move(front_end)),
      remark_(std::move(connected.remark)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      options_(options) {
  thread_ = std::thread([this, first = std::move(connected.socket)]() mutable { run(std::move(first)); });
}

Station::~Station() {
  ending_ = true;
  wake();
  thread_.join();
  std::list<RunningStop> stops;
  {
    const std::lock_guard guard(mutex_);
    stops.swap(stops_);
  }
  // Joined, not counted: a thread that has counted itself out may still hold the mutex.
  for (RunningStop& stop : stops) stop.thread.join();
}

std::shared_ptr<const World> Station::world() const {
  const std::lock_guard guard(mutex_);
  return world_;
}

std::shared_ptr<const TileMap> Station::map() const {
  const std::lock_guard guard(mutex_);
  return map_;
}

Link Station::link() const {
  const std::lock_guard guard(mutex_);
  Link link = link_;
  link.silent_for = std::chrono::duration<double>(Clock::now() - heard_).count();
  return link;
}

StationOptions Station::options() const {
  const std::lock_guard guard(mutex_);
  return options_;
}

void Station::on_change(std::function<void()> poke) {
  std::unique_lock guard(mutex_);
  poke_ = std::move(poke);
  poked_ = false;
  poked_through_.wait(guard, [this] { return pokes_running_ == 0; });
}

Changes Station::take() {
  Changes changes;
  std::vector<std::pair<Done, CommandOutcome>> ended;
  {
    const std::lock_guard guard(mutex_);
    changes = std::exchange(changes_, {});
    ended.swap(ended_);
    poked_ = false;
  }
  for (const auto& [done, outcome] : ended)
    if (done) done(outcome);
  return changes;
}

Station::RequestId Station::execute(const std::string& line, Done done) {
  return ask([line](Connection& connection) { return connection.execute(line); }, std::move(done));
}

Station::RequestId Station::photo(const std::string& id, findings::PhotoPart part, Done done) {
  return ask([id, part](Connection& connection) { return connection.photo(id, part); }, std::move(done));
}

Station::RequestId Station::camera(const CameraRequest& request, Done done) {
  return ask([request](Connection& connection) { return connection.camera(request); }, std::move(done));
}

Station::RequestId Station::drive(const std::string& robot, Done done) {
  return ask([robot](Connection& connection) { return connection.teleop(robot); }, std::move(done));
}

Station::RequestId Station::ask(std::function<std::int64_t(Connection&)> request, Done done) {
  std::unique_lock guard(mutex_);
  const RequestId id = next_++;
  if (calls_.size() >= kMaxCalls) {
    end(std::move(done), no_answer("the station does not read; this was not sent"), guard);
    return id;
  }
  open_[id] = std::move(done);
  calls_.push_back(
      [this, id, request = std::move(request)](Connection& connection) { sent_[id] = request(connection); });
  guard.unlock();
  wake();
  return id;
}

void Station::stick(RequestId drive, const StickVelocity& velocity) {
  {
    const std::lock_guard guard(mutex_);
    sticks_[drive] = velocity;
  }
  wake();
}

void Station::cancel(RequestId request) {
  {
    const std::lock_guard guard(mutex_);
    calls_.push_back([this, request](Connection& connection) {
      if (const auto sent = sent_.find(request); sent != sent_.end()) connection.cancel(sent->second);
    });
  }
  wake();
}

void Station::stop(const std::vector<std::string>& robots, Done done) {
  std::vector<std::string> words{"stop"};
  if (robots.empty()) words.push_back("all");
  words.insert(words.end(), robots.begin(), robots.end());
  join_ended_stops();
  std::unique_lock guard(mutex_);
  if (stops_.size() >= kMaxStops) {
    end(std::move(done), no_answer("too many stops have no answer yet; this was not sent"), guard);
    return;
  }
  RunningStop& stop = stops_.emplace_back();
  stop.thread = std::thread([this, &stop, line = quoted(words), done = std::move(done)]() mutable {
    CommandOutcome outcome = run_stop(options(), front_end_, line);
    std::unique_lock lock(mutex_);
    end(std::move(done), std::move(outcome), lock);
    lock.lock();
    stop.ended = true;
  });
}

void Station::join_ended_stops() {
  std::list<RunningStop> ended;
  {
    const std::lock_guard guard(mutex_);
    for (auto stop = stops_.begin(); stop != stops_.end();) {
      const auto next = std::next(stop);
      if (stop->ended) ended.splice(ended.end(), stops_, stop);
      stop = next;
    }
  }
  for (RunningStop& stop : ended) stop.thread.join();
}

void Station::want_map(bool wanted) {
  map_wanted_ = wanted;
  wake();
}

void Station::look_at(const std::optional<LookedAt>& place) {
  const std::lock_guard guard(mutex_);
  look_ = place;
}

Result<void> Station::start_station() { return launch(options()); }

void Station::wake() {
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);  // If the counter is full, the thread wakes anyway.
}

void Station::poke(std::unique_lock<std::mutex>& guard) {
  std::function<void()> call;
  if (!poked_ && poke_) {
    poked_ = true;
    call = poke_;
  }
  if (call) ++pokes_running_;
  guard.unlock();
  if (!call) return;
  call();
  const std::lock_guard ended(mutex_);
  --pokes_running_;
  poked_through_.notify_all();
}

void Station::end(Done done, CommandOutcome outcome, std::unique_lock<std::mutex>& guard) {
  ended_.emplace_back(std::move(done), std::move(outcome));
  poke(guard);
}

template <class Change>
void Station::change(const Change& make) {
  std::unique_lock guard(mutex_);
  make();
  poke(guard);
}

template <class T>
void Station::add_change(std::vector<T>& list, const T& value) {
  if (list.size() < kMaxChanges)
    list.push_back(value);
  else
    ++changes_.missed;
}

void Station::pause(std::chrono::milliseconds time) {
  pollfd wake{wake_.get(), POLLIN, 0};
  ::poll(&wake, 1, static_cast<int>(time.count()));
  drain();
}

void Station::drain() {
  std::uint64_t count = 0;
  (void)!::read(wake_.get(), &count, sizeof count);
}

void Station::run(LineSocket first) {
  std::optional<LineSocket> socket(std::move(first));
  while (!ending_) {
    if (socket) {
      serve(std::move(*socket));
      socket.reset();
      continue;
    }
    pause(kSeek);
    {
      // What is asked meanwhile has no station to go to.
      std::unique_lock guard(mutex_);
      calls_.clear();
      sticks_.clear();
      for (auto& [id, done] : std::exchange(open_, {}))
        ended_.emplace_back(std::move(done), no_answer("no station is running; this was not sent"));
      if (!ended_.empty()) poke(guard);
    }
    if (const auto path = socket_path(options_.name))
      if (auto found = LineSocket::connect(*path)) socket.emplace(std::move(*found));
  }
}

void Station::serve(LineSocket socket) {
  Connection connection(std::move(socket), front_end_);
  listen(connection);
  connection.hello();
  connection.follow();
  connection.notices();
  sent_.clear();
  next_map_ = {};
  change([&] {
    link_ = {.connected = true};
    heard_ = Clock::now();
    changes_.link = true;
  });
  bool open = true;
  while (open && !ending_) {
    write(connection);
    open = connection.wait(kPollMs, wake_.get());
    drain();
    if (!connection.not_understood().empty()) {
      std::unique_lock guard(mutex_);
      if (link_.why.empty()) {
        link_.why = "the station speaks another version: " + connection.not_understood();
        changes_.link = true;
        poke(guard);
      }
    }
  }
  const std::string why = connection.gone();
  change([&] {
    link_ = {.connected = false, .why = why};
    changes_.link = true;
    calls_.clear();
    sticks_.clear();
    for (auto& [id, done] : std::exchange(open_, {})) ended_.emplace_back(std::move(done), no_answer(why));
  });
}

void Station::write(Connection& connection) {
  std::deque<std::function<void(Connection&)>> calls;
  std::map<RequestId, StickVelocity> sticks;
  std::optional<LookedAt> look;
  {
    const std::lock_guard guard(mutex_);
    calls.swap(calls_);
    sticks.swap(sticks_);
    look = look_;
  }
  // Sticks first: the last zero of a drive comes before its end.
  for (const auto& [drive, velocity] : sticks)
    if (const auto sent = sent_.find(drive); sent != sent_.end())
      connection.stick(sent->second, velocity.vx, velocity.vy, velocity.wz);
  for (const auto& call : calls) call(connection);
  if (!map_wanted_ || Clock::now() < next_map_) return;
  next_map_ = Clock::now() + kMapAnswer;
  connection.map(run_, map()->revision, look);
}

void Station::listen(Connection& connection) {
  connection.on_world = [this](const World& world) {
    auto newest = std::make_shared<const World>(world);
    change([&] {
      world_ = std::move(newest);
      heard_ = Clock::now();
      changes_.world = true;
    });
  };
  connection.on_map = [this](MapUpdate update, bool more) { take_map(std::move(update), more); };
  connection.on_hello = [this](const StationOptions& running) {
    const std::lock_guard guard(mutex_);
    options_.domain = running.domain;
    options_.interfaces = running.interfaces;
    options_.peers = running.peers;
  };
  connection.on_notice = [this](const Notice& notice) {
    change([&] { add_change(changes_.notices, notice); });
  };
  connection.on_command = [this](const CommandEvent& event) {
    change([&] { add_change(changes_.commands, event); });
  };
  connection.on_missed = [this](std::size_t count) { change([&] { changes_.missed += count; }); };
  connection.on_outcome = [this](std::int64_t id, const CommandOutcome& outcome) {
    for (auto sent = sent_.begin(); sent != sent_.end(); ++sent) {
      if (sent->second != id) continue;
      std::unique_lock guard(mutex_);
      auto request = open_.extract(sent->first);
      sent_.erase(sent);
      if (request) end(std::move(request.mapped()), outcome, guard);
      return;
    }
  };
}

void Station::take_map(MapUpdate update, bool more) {
  const std::shared_ptr<const TileMap> known = update.run == run_ ? map() : std::make_shared<TileMap>();
  const bool same = std::exchange(run_, update.run) == update.run;
  next_map_ = more ? Clock::time_point{} : Clock::now() + kMapPeriod;
  if (same && update.tiles.empty()) return;
  auto newest = std::make_shared<const TileMap>(updated(*known, std::move(update)));
  change([&] {
    map_ = std::move(newest);
    changes_.map = true;
  });
}

}  // namespace adit::station::client
