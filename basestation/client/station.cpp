// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/station.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "basestation/client/connection.hpp"
#include "basestation/client/launch.hpp"
#include "basestation/client/paths.hpp"
#include "basestation/client/stop.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::station::client {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using RequestId = Station::RequestId;

constexpr auto kSeek = 200ms;  // Period in which a lost station is sought.
constexpr auto kMapPeriod = 1000ms;
constexpr auto kMapAnswer = 5000ms;  // Later, it is asked for again.
constexpr int kPollMs = 200;
constexpr std::size_t kMaxAsked = 256;  // Requests that wait to be written.

/// A call of the owner, for the thread.
struct Asked {
  enum class Kind : std::uint8_t { execute, drive, stick, cancel };
  Kind kind{};
  RequestId id{};
  std::string text{};
  StickVelocity velocity{};
};

CommandOutcome no_answer(const std::string& why) { return {.exit_code = kExitNoAnswer, .error = why + "\n"}; }

}  // namespace

class Station::Impl {
 public:
  Impl(StationOptions options, std::string front_end, LineSocket socket)
      : name_(options.name),
        front_end_(std::move(front_end)),
        wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        options_(std::move(options)) {
    link_.connected = true;
    thread_ = std::thread([this, first = std::move(socket)]() mutable { run(std::move(first)); });
  }
  ~Impl() {
    ending_ = true;
    wake();
    thread_.join();
    std::unique_lock guard(mutex_);
    stops_ended_.wait(guard, [this] { return stops_ == 0; });
  }

  std::shared_ptr<const World> world() const {
    const std::lock_guard guard(mutex_);
    return world_;
  }
  std::shared_ptr<const TileMap> map() const {
    const std::lock_guard guard(mutex_);
    return map_;
  }
  Link link() const {
    const std::lock_guard guard(mutex_);
    Link link = link_;
    link.silent_for = std::chrono::duration<double>(Clock::now() - heard_).count();
    return link;
  }
  void on_change(std::function<void()> poke) {
    const std::lock_guard guard(mutex_);
    poke_ = std::move(poke);
  }
  Changes take() {
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

  RequestId ask(Asked::Kind kind, const std::string& text, Done done) {
    std::unique_lock guard(mutex_);
    const RequestId id = next_++;
    if (asked_.size() >= kMaxAsked) {
      end(std::move(done), no_answer("the station does not read; this was not sent"), guard);
      return id;
    }
    open_[id] = std::move(done);
    asked_.push_back({kind, id, text, {}});
    guard.unlock();
    wake();
    return id;
  }
  void stick(RequestId id, const StickVelocity& velocity) {
    {
      const std::lock_guard guard(mutex_);
      // Only the newest stick counts.
      for (Asked& waits : asked_)
        if (waits.kind == Asked::Kind::stick && waits.id == id) {
          waits.velocity = velocity;
          return;
        }
      asked_.push_back({Asked::Kind::stick, id, {}, velocity});
    }
    wake();
  }
  void cancel(RequestId id) {
    {
      const std::lock_guard guard(mutex_);
      asked_.push_back({Asked::Kind::cancel, id, {}, {}});
    }
    wake();
  }
  void stop(const std::string& line, Done done) {
    {
      const std::lock_guard guard(mutex_);
      ++stops_;
    }
    std::thread([this, line, done = std::move(done)]() mutable {
      CommandOutcome outcome = run_stop(options(), front_end_, line);
      std::unique_lock guard(mutex_);
      end(std::move(done), std::move(outcome), guard);
      guard.lock();
      if (--stops_ == 0) stops_ended_.notify_all();
    }).detach();
  }
  void look_at(const std::optional<LookedAt>& place) {
    const std::lock_guard guard(mutex_);
    look_ = place;
  }
  std::optional<LookedAt> look() const {
    const std::lock_guard guard(mutex_);
    return look_;
  }
  void want_map(bool wanted) {
    map_wanted_ = wanted;
    wake();
  }
  StationOptions options() const {
    const std::lock_guard guard(mutex_);
    return options_;
  }

 private:
  void wake() {
    const std::uint64_t one = 1;
    (void)!::write(wake_.get(), &one, sizeof one);  // If the counter is full, the thread wakes anyway.
  }
  /// Calls the owner unless that is pending. Releases the lock.
  void poke(std::unique_lock<std::mutex>& guard) {
    std::function<void()> call;
    if (!poked_ && poke_) {
      poked_ = true;
      call = poke_;
    }
    guard.unlock();
    if (call) call();
  }
  void end(Done done, CommandOutcome outcome, std::unique_lock<std::mutex>& guard) {
    ended_.emplace_back(std::move(done), std::move(outcome));
    poke(guard);
  }
  template <class Change>
  void change(const Change& make) {
    std::unique_lock guard(mutex_);
    make();
    poke(guard);
  }
  template <class T>
  void keep(std::vector<T>& list, const T& value) {
    if (list.size() < kMaxChanges)
      list.push_back(value);
    else
      ++changes_.missed;
  }

  void run(LineSocket first);
  void serve(LineSocket socket);
  void write(Connection& connection);
  void listen(Connection& connection);
  /// Waits for `wake_` or the time.
  void pause(std::chrono::milliseconds time) {
    pollfd wake{wake_.get(), POLLIN, 0};
    ::poll(&wake, 1, static_cast<int>(time.count()));
    drain();
  }
  void drain() {
    std::uint64_t count = 0;
    (void)!::read(wake_.get(), &count, sizeof count);
  }

  const std::string name_;
  const std::string front_end_;
  File wake_;
  std::atomic<bool> ending_{false}, map_wanted_{false};

  // Of the thread alone.
  std::map<RequestId, std::int64_t> sent_{};  ///< The connection's id of each open request.
  std::uint64_t run_{};                       ///< The station's run to which the map belongs.
  Clock::time_point next_map_{};              ///< When the map is asked for.

  mutable std::mutex mutex_{};  // Guards all below.
  std::optional<LookedAt> look_{};
  StationOptions options_;  // Domain and network as the running station has them.
  std::shared_ptr<const World> world_{std::make_shared<World>()};
  std::shared_ptr<const TileMap> map_{std::make_shared<TileMap>()};
  Link link_{};
  Clock::time_point heard_{Clock::now()};
  Changes changes_{};
  std::function<void()> poke_{};
  bool poked_{false};
  RequestId next_{1};
  std::deque<Asked> asked_{};
  std::map<RequestId, Done> open_{};
  std::vector<std::pair<Done, CommandOutcome>> ended_{};
  int stops_{};
  std::condition_variable stops_ended_{};

  std::thread thread_{};
};

void Station::Impl::run(LineSocket first) {
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
      asked_.clear();
      for (auto& [id, done] : std::exchange(open_, {}))
        ended_.emplace_back(std::move(done), no_answer("no station is running; this was not sent"));
      if (!ended_.empty()) poke(guard);
    }
    if (const auto path = socket_path(name_))
      if (auto found = LineSocket::connect(*path)) socket.emplace(std::move(*found));
  }
}

void Station::Impl::serve(LineSocket socket) {
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
    if (map_wanted_ && Clock::now() >= next_map_) {
      next_map_ = Clock::now() + kMapAnswer;
      connection.map(run_, map()->revision, look());
    }
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
    asked_.clear();
    for (auto& [id, done] : std::exchange(open_, {})) ended_.emplace_back(std::move(done), no_answer(why));
  });
}

void Station::Impl::write(Connection& connection) {
  std::deque<Asked> asked;
  {
    const std::lock_guard guard(mutex_);
    asked.swap(asked_);
  }
  for (const Asked& next : asked) switch (next.kind) {
      case Asked::Kind::execute:
        sent_[next.id] = connection.execute(next.text);
        break;
      case Asked::Kind::drive:
        sent_[next.id] = connection.teleop(next.text);
        break;
      case Asked::Kind::stick:
        if (const auto drive = sent_.find(next.id); drive != sent_.end())
          connection.stick(drive->second, next.velocity.vx, next.velocity.vy, next.velocity.wz);
        break;
      case Asked::Kind::cancel:
        if (const auto request = sent_.find(next.id); request != sent_.end())
          connection.cancel(request->second);
        break;
    }
}

void Station::Impl::listen(Connection& connection) {
  connection.on_world = [this](const World& world) {
    auto newest = std::make_shared<const World>(world);
    change([&] {
      world_ = std::move(newest);
      heard_ = Clock::now();
      changes_.world = true;
    });
  };
  connection.on_map = [this](MapUpdate update, bool more) {
    const TileMap empty{};
    const std::shared_ptr<const TileMap> known = map();
    const bool same = update.run == run_;
    run_ = update.run;
    next_map_ = more ? Clock::time_point{} : Clock::now() + kMapPeriod;
    if (same && update.tiles.empty()) return;
    auto newest = std::make_shared<const TileMap>(updated(same ? *known : empty, std::move(update)));
    change([&] {
      map_ = std::move(newest);
      changes_.map = true;
    });
  };
  connection.on_hello = [this](const StationOptions& running) {
    const std::lock_guard guard(mutex_);
    options_.domain = running.domain;
    options_.interfaces = running.interfaces;
    options_.peers = running.peers;
  };
  connection.on_notice = [this](const Notice& notice) { change([&] { keep(changes_.notices, notice); }); };
  connection.on_command = [this](const CommandEvent& event) {
    change([&] { keep(changes_.commands, event); });
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

Station::Station(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Station::~Station() = default;

Result<std::unique_ptr<Station>> Station::open(const StationOptions& options, const std::string& front_end) {
  auto connected = connect_or_launch(options);
  if (!connected) return connected.error();
  std::unique_ptr<Station> station(
      new Station(std::make_unique<Impl>(options, front_end, std::move(connected->socket))));
  station->remark_ = std::move(connected->remark);
  return station;
}

std::shared_ptr<const World> Station::world() const { return impl_->world(); }
std::shared_ptr<const TileMap> Station::map() const { return impl_->map(); }
Link Station::link() const { return impl_->link(); }
void Station::on_change(std::function<void()> poke) { impl_->on_change(std::move(poke)); }
Changes Station::take() { return impl_->take(); }
void Station::cancel(RequestId request) { impl_->cancel(request); }
void Station::want_map(bool wanted) { impl_->want_map(wanted); }
void Station::look_at(const std::optional<LookedAt>& place) { impl_->look_at(place); }
void Station::stick(RequestId drive, const StickVelocity& velocity) { impl_->stick(drive, velocity); }

Station::RequestId Station::execute(const std::string& line, Done done) {
  return impl_->ask(Asked::Kind::execute, line, std::move(done));
}

Station::RequestId Station::drive(const std::string& robot, Done done) {
  return impl_->ask(Asked::Kind::drive, robot, std::move(done));
}

void Station::stop(const std::vector<std::string>& robots, Done done) {
  std::vector<std::string> words{"stop"};
  if (robots.empty()) words.push_back("all");
  words.insert(words.end(), robots.begin(), robots.end());
  impl_->stop(quoted(words), std::move(done));
}

std::vector<Action> Station::actions(const std::vector<std::string>& robots) const {
  const std::shared_ptr<const World> world = this->world();
  std::vector<const Robot*> selection;
  for (const std::string& name : robots)
    if (const Robot* robot = world->robot(name)) selection.push_back(robot);
  return station::actions(selection);
}

Result<void> Station::start_station() { return launch(impl_->options()); }

}  // namespace adit::station::client
