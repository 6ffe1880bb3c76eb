// SPDX-License-Identifier: Apache-2.0
// A front end with a loop of its own, and a real station's socket.
#include "basestation/client/station.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <future>
#include <mutex>

#include "basestation/model/outcome.hpp"
#include "perception/map/export/map_file.hpp"
#include "tests/client/server_bench.hpp"

namespace adit::station::client {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// The owner's loop: takes what changed whenever it is poked.
class Owner {
 public:
  explicit Owner(client::Station& station) : station_(station) {
    station_.on_change([this] {
      const std::lock_guard guard(mutex_);
      ++pokes_;
      poked_ = true;
      changed_.notify_all();
    });
  }
  ~Owner() { station_.on_change({}); }
  /// Takes changes until the condition holds. False after 20 s.
  bool until(const std::function<bool()>& condition) {
    // By the system's clock: the thread sanitizer does not know the wait by the steady one.
    const auto limit = std::chrono::system_clock::now() + 20s;
    for (;;) {
      const Changes changes = station_.take();
      all_.world = all_.world || changes.world;
      all_.link = all_.link || changes.link;
      all_.map = all_.map || changes.map;
      for (const CommandEvent& event : changes.commands) all_.commands.push_back(event);
      for (const Notice& notice : changes.notices) all_.notices.push_back(notice);
      if (condition()) return true;
      std::unique_lock guard(mutex_);
      if (!changed_.wait_until(guard, limit, [this] { return poked_; })) return false;
      poked_ = false;
    }
  }
  const Changes& all() const { return all_; }
  int pokes() {
    const std::lock_guard guard(mutex_);
    return pokes_;
  }

 private:
  client::Station& station_;
  Changes all_{};
  std::mutex mutex_{};
  std::condition_variable changed_{};
  bool poked_{false};
  int pokes_{};
};

class ClientTest : public host::ServerBench {
 protected:
  explicit ClientTest(Duration grace = {})
      : ServerBench(grace),
        options_{.name = "op1", .program = "/bin/echo"},
        station_(client::Station::open(options_, "gui").value()),
        owner_(std::make_unique<Owner>(*station_)) {}

  StationOptions options_;
  std::unique_ptr<client::Station> station_;
  std::unique_ptr<Owner> owner_;
};

TEST_F(ClientTest, HasTheWorldAndTheOutcomesOfItsCommands) {
  std::optional<CommandOutcome> outcome;
  station_->execute("take r9", [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(
      owner_->until([&] { return outcome && owner_->all().world && !owner_->all().commands.empty(); }));
  EXPECT_EQ(outcome->exit_code, kExitRefused);
  EXPECT_THAT(outcome->error, HasSubstr("no robot of that name"));
  EXPECT_EQ(station_->world()->station, "op1");
  EXPECT_TRUE(station_->link().connected);
  EXPECT_EQ(station_->link().why, "");
  EXPECT_EQ(owner_->all().commands.front().line, "take r9");
  EXPECT_EQ(owner_->all().commands.front().front_end, "gui");
}

TEST_F(ClientTest, APhotoThatIsNotHereIsRefusedAndIsNoCommand) {
  std::optional<CommandOutcome> outcome;
  station_->photo("00000000000000ff", findings::PhotoPart::thumbnail,
                  [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return outcome && owner_->all().world; }));
  EXPECT_EQ(outcome->exit_code, kExitRefused);
  EXPECT_THAT(outcome->error, HasSubstr("not here"));
  EXPECT_TRUE(owner_->all().commands.empty());
}

TEST_F(ClientTest, IsPokedOnceUntilItTakesAndLosesNothingMeanwhile) {
  ASSERT_TRUE(owner_->until([&] { return owner_->all().world; }));
  const int before = owner_->pokes();
  auto other = client::Station::open(options_, "other").value();
  Owner others(*other);
  constexpr int asked = 200;  // More at once than the station begins: the rest is refused, none is forgotten.
  int ended = 0, refused = 0;
  for (int i = 0; i < asked; ++i)
    other->execute("list", [&](const CommandOutcome& outcome) {
      ++ended;
      refused += outcome.exit_code == kExitDone ? 0 : 1;
    });
  ASSERT_TRUE(others.until([&] { return ended == asked; }));
  EXPECT_LT(refused, asked);
  EXPECT_LE(owner_->pokes() - before, 1);
  const auto begun_and_ended = static_cast<std::size_t>(2 * (asked - refused));
  ASSERT_TRUE(owner_->until([&] { return owner_->all().commands.size() == begun_and_ended; }));
}

TEST_F(ClientTest, AStationAtRestGivesSignsOfLife) {
  ASSERT_TRUE(owner_->until([&] { return owner_->all().world; }));
  const double before = station_->world()->at;
  ASSERT_TRUE(owner_->until([&] { return station_->world()->at > before + 1.0; }));
  EXPECT_LT(station_->link().silent_for, 1.0);
}

class PatientClient : public ClientTest {
 protected:
  PatientClient() : ClientTest(60s) {}
};

TEST_F(PatientClient, RequestsEndWithTheStationAndItIsFoundAgain) {
  std::optional<CommandOutcome> outcome;
  station_->execute("take r9", [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return !owner_->all().commands.empty(); })) << "it waits for the robot";
  end_station();
  ASSERT_TRUE(owner_->until([&] { return outcome && !station_->link().connected; }));
  EXPECT_NE(outcome->exit_code, kExitDone);
  EXPECT_NE(station_->link().why, "");

  // What is asked of no station ends at once.
  outcome.reset();
  station_->execute("list", [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
  EXPECT_EQ(outcome->exit_code, kExitNoAnswer);
  EXPECT_THAT(outcome->error, HasSubstr("no station is running"));

  start_station();
  ASSERT_TRUE(owner_->until([&] { return station_->link().connected; }));
  outcome.reset();
  station_->execute("list", [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
  EXPECT_EQ(outcome->exit_code, kExitDone);
}

TEST_F(PatientClient, ACancelledRequestEnds) {
  std::optional<CommandOutcome> outcome;
  const auto id = station_->drive("r9", [&](const CommandOutcome& ended) { outcome = ended; });
  for (int i = 0; i < 1000; ++i) station_->stick(id, {0.1 * i, 0.0, 0.0});
  station_->cancel(id);
  ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
  EXPECT_NE(outcome->exit_code, kExitDone);
}

TEST_F(ClientTest, AStopGoesThroughTheStationWhileThatAnswers) {
  std::optional<CommandOutcome> outcome;
  station_->stop({}, [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
  EXPECT_THAT(outcome->text + outcome->error, testing::Not(HasSubstr("--name")));
}

TEST_F(ClientTest, AStopDoesNotNeedTheStationAndGoesToItsDomain) {
  ASSERT_TRUE(owner_->until([&] { return owner_->all().world; }));
  end_station();
  std::optional<CommandOutcome> outcome;
  station_->stop({"r1", "r2"}, [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
  EXPECT_EQ(outcome->text, "--name op1 --domain 78 --alone stop r1 r2\n")
      << "the program of the options says its words";
}

TEST_F(ClientTest, AStopDoesNotWaitForAHungStation) {
  ASSERT_TRUE(owner_->until([&] { return owner_->all().world; }));
  std::promise<void> free;
  strand_->post([go = free.get_future().share()] { go.wait(); });
  std::optional<CommandOutcome> outcome;
  const auto asked = std::chrono::steady_clock::now();
  station_->stop({}, [&](const CommandOutcome& ended) { outcome = ended; });
  ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
  EXPECT_THAT(outcome->text, HasSubstr("stop all"));
  EXPECT_LT(std::chrono::steady_clock::now() - asked, 5s);
  free.set_value();
}

/// Made in a thread, it holds the end of that thread up until its station is gone, or for a moment.
struct EndsLate {
  std::future<void> gone;
  std::promise<bool>& first;  ///< Whether the thread ended first.
  ~EndsLate() { first.set_value(gone.wait_for(200ms) == std::future_status::timeout); }
};

TEST_F(ClientTest, TheThreadOfAStopEndsBeforeItsStation) {
  end_station();
  ASSERT_TRUE(owner_->until([&] { return !station_->link().connected; }));
  owner_.reset();
  std::promise<void> gone, ends;
  std::promise<bool> first;
  // From here on the thread of the stop alone has something to take.
  station_->on_change([&] {
    thread_local std::unique_ptr<EndsLate> late;
    late.reset(new EndsLate{gone.get_future(), first});
    ends.set_value();
  });
  station_->stop({"r1"}, {});
  ends.get_future().wait();
  station_.reset();
  gone.set_value();
  EXPECT_TRUE(first.get_future().get());
}

TEST_F(ClientTest, AFunctionThatWasReplacedIsNotRunningAnyMore) {
  ASSERT_TRUE(owner_->until([&] { return owner_->all().world; }));
  std::promise<void> entered, replaced;
  std::atomic<bool> called{false}, returned{false};
  station_->on_change([&] {
    if (called.exchange(true)) return;
    entered.set_value();
    replaced.get_future().wait_for(100ms);
    returned = true;
  });
  station_->take();
  station_->execute("list", {});
  entered.get_future().wait();
  station_->on_change({});
  EXPECT_TRUE(returned);
  replaced.set_value();
}

TEST_F(ClientTest, ManyStopsAtOnceAreSentButNotWithoutLimit) {
  end_station();
  ASSERT_TRUE(owner_->until([&] { return !station_->link().connected; }));
  const std::string gate = folder() + "/gate", program = folder() + "/program";
  const File closed(::open(gate.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600));
  ASSERT_EQ(::flock(closed.get(), LOCK_EX), 0);
  std::ofstream(program) << "#!/bin/sh\nexec flock --shared " << gate << " echo sent\n";
  ASSERT_EQ(::chmod(program.c_str(), 0700), 0);
  owner_.reset();
  StationOptions options = options_;
  options.program = program;
  start_station();
  auto other = client::Station::open(options, "other").value();
  end_station();
  Owner others(*other);
  std::size_t sent = 0, refused = 0;
  const auto count = [&](const CommandOutcome& outcome) {
    sent += outcome.text == "sent\n";
    refused += outcome.error.find("not sent") != std::string::npos;
  };
  for (std::size_t n = 0; n < client::Station::kMaxStops + 2; ++n) other->stop({"r1"}, count);
  EXPECT_TRUE(others.until([&] { return refused == 2; }));
  EXPECT_EQ(sent, 0U);
  ASSERT_EQ(::flock(closed.get(), LOCK_UN), 0);
  ASSERT_TRUE(others.until([&] { return sent == client::Station::kMaxStops; }));
  other->stop({"r1"}, count);
  ASSERT_TRUE(others.until([&] { return sent + refused == client::Station::kMaxStops + 3; }));
  EXPECT_EQ(refused, 2U) << "those that ended make room";
}

TEST_F(ClientTest, TheMapComesWhenItIsWantedAndAgainFromANewStation) {
  const auto load = [&](int x) {
    perception::VoxelImage image(0.2);
    image.set({x, 0, 0}, perception::Voxel::free);
    image.set({x, 1, 0}, perception::Voxel::occupied);
    const std::string file = folder() + "/site.bt";
    ASSERT_TRUE(perception::save_map(image, file, {}));
    std::optional<CommandOutcome> outcome;
    station_->execute("map load " + file, [&](const CommandOutcome& ended) { outcome = ended; });
    ASSERT_TRUE(owner_->until([&] { return outcome.has_value(); }));
    ASSERT_EQ(outcome->exit_code, kExitDone) << outcome->error;
  };
  load(3);
  station_->want_map(true);
  const auto shows = [&](int tile_x, int x) {
    const auto map = station_->map();
    const auto found = map->tiles.find({tile_x, 0});
    return found != map->tiles.end() && found->second->cells[static_cast<std::size_t>(x)] == MapTile::kGround;
  };
  ASSERT_TRUE(owner_->until([&] { return shows(0, 3); }));
  EXPECT_TRUE(owner_->all().map);
  end_station();
  ASSERT_TRUE(owner_->until([&] { return !station_->link().connected; }));
  start_station();
  ASSERT_TRUE(owner_->until([&] { return station_->link().connected; }));
  load(MapTile::kSide + 7);
  ASSERT_TRUE(owner_->until([&] { return shows(1, 7); }));
  EXPECT_FALSE(shows(0, 3)) << "the map of the station that ended is not mixed with this one";
}

}  // namespace
}  // namespace adit::station::client
