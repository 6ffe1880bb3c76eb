// SPDX-License-Identifier: Apache-2.0
// The station's socket: what its clients get, whether they read or not.
#include "basestation/host/server.hpp"

#include <gmock/gmock.h>
#include <poll.h>
#include <unistd.h>

#include <future>

#include "basestation/host/outbox.hpp"
#include "basestation/model/json.hpp"
#include "core/command/words.hpp"
#include "tests/client/server_bench.hpp"

namespace adit::station::host {
namespace {

using namespace std::chrono_literals;
using client::LineSocket;
using nlohmann::json;
using testing::HasSubstr;

/// A client that reads when the test says so.
class Talk {
 public:
  explicit Talk(const std::string& path) : socket_(LineSocket::connect(path).value()) {}

  void say(const json& object) { EXPECT_TRUE(socket_.send_line(line_of(object))); }
  /// The next object with the key `wanted` ("": any); reads on until it comes. Null after 20 s or at the end.
  json next(const std::string& wanted) {
    const auto until = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < until) {
      while (const auto line = socket_.line()) {
        bytes_ += line->size();
        const json object = json::parse(*line, nullptr, false);
        EXPECT_TRUE(object.is_object()) << *line;
        if (wanted.empty() || object.contains(wanted)) return object;
      }
      if (ended_) return {};
      pollfd readable{socket_.fd(), POLLIN, 0};
      ::poll(&readable, 1, 100);
      if (!socket_.pump()) ended_ = true;
    }
    return {};
  }
  /// How many objects of that kind are there to be read now.
  int arrived(const std::string& wanted) {
    ended_ = ended_ || !socket_.pump();
    int count = 0;
    while (const auto line = socket_.line()) count += json::parse(*line).contains(wanted) ? 1 : 0;
    return count;
  }
  bool ended() const { return ended_; }
  std::size_t bytes() const { return bytes_; }
  LineSocket& socket() { return socket_; }

 private:
  LineSocket socket_;
  bool ended_{false};
  std::size_t bytes_{};
};

class ServerTest : public ServerBench {
 protected:
  using ServerBench::ServerBench;
};

TEST_F(ServerTest, AnOutcomeIsNotLostInAFloodOfNotices) {
  Talk reader(path());
  reader.say({{"notices", true}});
  std::promise<void> asked;
  strand_->post([this, go = asked.get_future().share()] {
    go.wait();
    const Notice notice{.text = std::string(2000, 'x')};
    for (int i = 0; i < 20000; ++i) server_->notify(notice);  // faster than anybody reads
  });
  reader.say({{"id", 1}, {"do", "up"}});
  reader.say({{"hello", true}});
  ASSERT_FALSE(reader.next("hello").is_null());  // the request is behind the flood now
  asked.set_value();
  const json outcome = reader.next("outcome");
  ASSERT_FALSE(outcome.is_null());
  EXPECT_EQ(outcome["outcome"]["exit"], 0);
}

TEST_F(ServerTest, AClientReadsHowManyNoticesItMissed) {
  Talk reader(path());
  reader.say({{"notices", true}});
  reader.say({{"hello", true}});
  ASSERT_FALSE(reader.next("hello").is_null());
  static constexpr int sent = 20000;
  on_strand([this] {
    for (int i = 0; i < sent; ++i) server_->notify({.text = std::string(200, 'x')});
  });
  reader.say({{"hello", true}});
  int seen = 0;
  std::size_t missed = 0;
  for (json object = reader.next(""); !object.contains("hello"); object = reader.next("")) {
    ASSERT_FALSE(object.is_null());
    seen += object.contains("notice") ? 1 : 0;
    missed += object.value("missed", std::size_t{0});
  }
  EXPECT_GT(seen, 0);
  EXPECT_EQ(seen + static_cast<int>(missed), sent);
}

TEST_F(ServerTest, AClientThatReadsNothingIsCutOffAndReadsWhy) {
  Talk sleeper(path());
  bool open = true;
  std::size_t said = 0;
  for (; open && said < 10000; ++said) {
    open = sleeper.socket().send_line(line_of({{"hello", said}}));
    pollfd writable{sleeper.socket().fd(), POLLOUT, 0};
    while (open && sleeper.socket().has_backlog()) {
      ::poll(&writable, 1, 1000);
      open = sleeper.socket().flush();
    }
  }
  EXPECT_FALSE(open) << "it cannot ask any more";
  const json last = sleeper.next("cut_off");
  ASSERT_FALSE(last.is_null());
  EXPECT_THAT(last["cut_off"], HasSubstr("did not read"));
  EXPECT_TRUE(sleeper.next("anything").is_null());
  EXPECT_TRUE(sleeper.ended());
  EXPECT_LT(sleeper.bytes(), Outbox::kMaxReplyBytes) << "what waited for it was dropped";
  Talk other(path());
  other.say({{"hello", true}});
  EXPECT_FALSE(other.next("hello").is_null()) << "nobody else is concerned";
}

TEST_F(ServerTest, OneClientTooManyReadsWhyItIsNotServed) {
  std::vector<std::unique_ptr<Talk>> all;
  for (std::size_t i = 0; i < Server::kMaxClients; ++i) {
    all.push_back(std::make_unique<Talk>(path()));
    all.back()->say({{"hello", true}});
    ASSERT_FALSE(all.back()->next("hello").is_null());
  }
  Talk late(path());
  EXPECT_THAT(late.next("cut_off").dump(), HasSubstr("32 programs are connected"));
}

TEST_F(ServerTest, AClientThatSleptReadsTheNewestSnapshotAlone) {
  Talk sleeper(path()), reader(path());
  sleeper.say({{"watch", true}});
  sleeper.say({{"hello", true}});
  ASSERT_FALSE(sleeper.next("hello").is_null());
  reader.say({{"watch", true}});
  for (int i = 0; i < 7; ++i) ASSERT_FALSE(reader.next("snapshot").is_null());
  EXPECT_LE(sleeper.arrived("snapshot"), 1) << "7 went out to who read them";
  ASSERT_FALSE(sleeper.next("snapshot").is_null()) << "then it gets what is new";
}

TEST_F(ServerTest, APlaceToLookAtThatDoesNotFitIsRefused) {
  Talk talk(path());
  const auto ask = [&](const json& look) {
    talk.say({{"map", {{"run", 0}, {"revision", 0}, {"look", look}}}});
    return talk.next("");
  };
  for (const json& bad : {json(5), json::array(), json{1, 2}, json{1, 2, 3, 4}, json{1, 2, "3"},
                          json{1, 2, 0}, json{1, 2, 1e9}, json{1, json(), 3}})
    EXPECT_TRUE(ask(bad).contains("wrong")) << bad;
  EXPECT_TRUE(ask({1.5, -2, 20}).contains("map"));
}

TEST_F(ServerTest, EveryFrontEndSeesTheCommandsOfTheOthers) {
  Talk script(path()), dashboard(path());
  dashboard.say({{"front_end", "watch"}});
  dashboard.say({{"hello", true}});
  ASSERT_FALSE(dashboard.next("hello").is_null());
  script.say({{"front_end", "script"}});
  script.say({{"id", 5}, {"do", "take r9"}});
  const json begun = dashboard.next("event"), ended = dashboard.next("event");
  EXPECT_EQ(begun["phase"], "begun");
  EXPECT_EQ(begun["line"], "take r9");
  EXPECT_EQ(begun["by"]["front_end"], "script");
  EXPECT_EQ(begun["by"]["pid"], ::getpid());
  EXPECT_EQ(begun["mine"], false);
  EXPECT_EQ(begun["query"], false);
  EXPECT_EQ(ended["phase"], "ended");
  EXPECT_EQ(ended["id"], begun["id"]);
  EXPECT_EQ(ended["by"], begun["by"]);
  EXPECT_EQ(ended["exit"], 1);
  EXPECT_THAT(ended["error"], HasSubstr("no robot of that name"));
  EXPECT_EQ(script.next("event")["mine"], true);
  dashboard.say({{"id", 1}, {"do", "list"}});
  const json query = script.next("event");  // the end of its own command comes first
  const json list = query["phase"] == "ended" ? script.next("event") : query;
  EXPECT_EQ(list["query"], true);
  EXPECT_GT(list["id"], begun["id"]);
  EXPECT_EQ(list["by"]["front_end"], "watch");
}

TEST_F(ServerTest, ACommandOfAClientThatLeftEndsForTheOthersToo) {
  auto leaver = std::make_unique<Talk>(path());
  Talk dashboard(path());
  dashboard.say({{"hello", true}});
  ASSERT_FALSE(dashboard.next("hello").is_null());
  leaver->say({{"id", 1}, {"teleop", "r9"}});
  EXPECT_EQ(dashboard.next("event")["line"], "teleop r9");
  leaver.reset();
  EXPECT_EQ(dashboard.next("event")["phase"], "ended");
}

class PatientServer : public ServerTest {
 protected:
  PatientServer() : ServerTest(60s) {}
};

TEST_F(PatientServer, WhatAClientBeganEndsWithItAlthoughTheQueueIsFull) {
  auto leaver = std::make_unique<Talk>(path());
  Talk dashboard(path());
  dashboard.say({{"hello", true}});
  ASSERT_FALSE(dashboard.next("hello").is_null());
  leaver->say({{"id", 1}, {"do", "take r9"}});
  EXPECT_EQ(dashboard.next("event")["phase"], "begun");
  std::promise<void> free;
  strand_->post([go = free.get_future().share()] { go.wait(); });
  while (strand_->post([] {})) continue;
  leaver.reset();
  dashboard.say({{"hello", true}});
  EXPECT_FALSE(dashboard.next("hello").is_null());  // the server has seen the other one go
  free.set_value();
  const json ended = dashboard.next("event");
  ASSERT_FALSE(ended.is_null());
  EXPECT_EQ(ended["phase"], "ended");
  EXPECT_EQ(ended["error"], "cancelled\n");
}

TEST(Outbox, KeepsRepliesInOrderAndDropsTheOldestEvents) {
  Outbox box;
  EXPECT_TRUE(box.reply("r1"));
  for (std::size_t i = 0; i < Outbox::kMaxEvents + 3; ++i) box.event("e" + std::to_string(i));
  EXPECT_TRUE(box.reply("r2"));
  EXPECT_EQ(box.next(true), "{\"missed\":3}");
  EXPECT_EQ(box.next(true), "r1");
  for (std::size_t i = 3; i < Outbox::kMaxEvents + 3; ++i) EXPECT_EQ(box.next(true), "e" + std::to_string(i));
  EXPECT_EQ(box.next(true), "r2");
  EXPECT_EQ(box.next(true), std::nullopt);
  EXPECT_TRUE(box.empty());
}

TEST(Outbox, OfSnapshotsTheNewestWaitsForAClientThatReads) {
  Outbox box;
  box.snapshot("s1");
  box.event("e1");
  box.snapshot("s2");
  EXPECT_EQ(box.next(false), "e1");
  EXPECT_EQ(box.next(false), std::nullopt);
  box.snapshot("s3");
  EXPECT_EQ(box.next(true), "s3");
  EXPECT_EQ(box.next(true), std::nullopt);
}

TEST(Outbox, SaysWhenRepliesAreTooMany) {
  Outbox box;
  const std::string megabyte(1 << 20, 'x');
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(box.reply(megabyte));
  EXPECT_FALSE(box.reply("x"));
  box.clear();
  EXPECT_TRUE(box.reply(megabyte));
}

}  // namespace
}  // namespace adit::station::host
