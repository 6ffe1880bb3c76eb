// SPDX-License-Identifier: Apache-2.0
// The station's socket: what its clients get, whether they read or not.
#include "basestation/host/server.hpp"

#include <gmock/gmock.h>
#include <poll.h>
#include <unistd.h>

#include <fstream>
#include <future>

#include "basestation/host/outbox.hpp"
#include "basestation/model/json.hpp"
#include "basestation/model/photo_bytes.hpp"
#include "core/command/words.hpp"
#include "core/time/random.hpp"
#include "tests/client/server_bench.hpp"
#include "tests/findings/drawn_photo.hpp"

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
    const Notice notice{{.text = std::string(2000, 'x')}};
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
    for (int i = 0; i < sent; ++i) server_->notify({{.text = std::string(200, 'x')}});
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

TEST_F(ServerTest, AClientThatSleptReadsOneDelta) {
  Talk sleeper(path()), reader(path());
  sleeper.say({{"follow", true}});
  ASSERT_FALSE(sleeper.next("world").is_null());
  reader.say({{"follow", true}});
  for (int i = 0; i < 4; ++i) ASSERT_FALSE(reader.next("delta").is_null());
  EXPECT_LE(sleeper.arrived("delta"), 1) << "4 were sent to the client that read them";
  ASSERT_FALSE(sleeper.next("delta").is_null()) << "it then gets what is new";
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

TEST_F(ServerTest, GivesThePartsOfAPhotoThatAreHere) {
  const store::Bytes jpeg = findings::draw({});
  const std::string file = folder() + "/gas.jpg";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
  Talk talk(path());
  talk.say({{"id", 1}, {"do", "finding add gas 1 2 --photo " + file}});
  ASSERT_EQ(talk.next("outcome")["outcome"]["exit"], 0);
  const std::string id = findings::id_text(findings::photo_hash(jpeg));
  const auto ask = [&](const json& photo, const json& part) {
    talk.say({{"id", 2}, {"photo", photo}, {"part", part}});
    for (json got = talk.next(""); !got.is_null(); got = talk.next(""))
      if (got.contains("wrong") || got.contains("outcome")) return got;
    return json();
  };
  const auto bytes_of = [&](const json& got) { return photo_of(outcome_from(got["outcome"]).value()); };
  EXPECT_EQ(*bytes_of(ask(id, "picture")), jpeg);
  const auto thumbnail = bytes_of(ask(id, "thumbnail"));
  ASSERT_TRUE(thumbnail.ok()) << thumbnail.error().text;
  EXPECT_LE(thumbnail->size(), findings::Photo::kMaxThumbnail);
  EXPECT_TRUE(findings::decode_photo(*thumbnail).ok());
  EXPECT_EQ(ask("00000000000000ff", "picture")["outcome"]["json"]["reason"], "cannot_read");
  for (const json& bad : {json(5), json(), json(""), json("ff"), json(id + "0")})
    EXPECT_TRUE(ask(bad, "picture").contains("wrong")) << bad;
  for (const json& bad : {json(5), json(), json("whole")}) EXPECT_TRUE(ask(id, bad).contains("wrong")) << bad;
}

TEST_F(ServerTest, FilesAreRelativeToTheFolderOfTheFrontEnd) {
  Talk talk(path());
  const auto error = [&](const std::string& file) {
    talk.say({{"id", 1}, {"do", "map picture " + file}});
    return talk.next("outcome")["outcome"]["error"];
  };
  EXPECT_EQ(error("site"), "map: site: a picture is a .png\n") << "without a folder: the station's";
  talk.say({{"front_end", "shell"}, {"folder", "/home/op"}});
  EXPECT_EQ(error("site"), "map: /home/op/site: a picture is a .png\n");
  EXPECT_EQ(error("'../a site'"), "map: /home/a site: a picture is a .png\n");
  EXPECT_EQ(error("/srv/site"), "map: /srv/site: a picture is a .png\n");
  EXPECT_EQ(error("picture"), "map: /home/op/picture: a picture is a .png\n") << "a name like the keyword's";
}

TEST_F(ServerTest, AFolderThatDoesNotFitIsRefused) {
  Talk talk(path());
  for (const json& bad : {json(5), json(), json::array(), json("home"), json("")}) {
    talk.say({{"front_end", "shell"}, {"folder", bad}});
    EXPECT_TRUE(talk.next("").contains("wrong")) << bad;
  }
  for (const std::string& bad : {std::string("/a\x1b[31m"), "/" + std::string(5000, 'a')}) {
    talk.say({{"front_end", "shell"}, {"folder", bad}});
    talk.say({{"id", 1}, {"do", "map picture site.png"}});
    EXPECT_EQ(talk.next("outcome")["outcome"]["exit"], 2);
    talk.say({{"id", 1}, {"do", "up"}});
    EXPECT_EQ(talk.next("outcome")["outcome"]["exit"], 0) << "commands without a file need no folder";
  }
}

TEST_F(ServerTest, SpoiledRequestsAreAnsweredAndDisturbNoOther) {
  const std::vector<std::string> good{
      line_of({{"front_end", "shell"}, {"folder", "/home/op"}}),
      line_of({{"id", 1}, {"do", "take r1 r2"}}),
      line_of({{"id", 2}, {"teleop", "r1"}}),
      line_of({{"id", 2}, {"stick", {0.5, 0.0, -1.0}}}),
      line_of({{"id", 3}, {"photo", "00000000000000ff"}, {"part", "picture"}}),
      line_of({{"cancel", 2}}),
      line_of({{"map", {{"run", 0}, {"revision", 0}, {"look", {1, 2, 3}}}}})};
  Random random(5);
  const auto drawn = [&](std::size_t count) { return static_cast<std::size_t>(random.below(count)); };
  Talk spoiler(path()), other(path());
  for (int i = 0; i < 2000; ++i) {
    std::string line = good[drawn(good.size())];
    for (std::size_t spoils = 1 + drawn(3); spoils > 0; --spoils) {
      char byte = static_cast<char>(drawn(256));
      if (byte == '\n') byte = ' ';
      line[drawn(line.size())] = byte;
    }
    line.resize(line.size() - drawn(4));
    ASSERT_TRUE(spoiler.socket().send_line(line));
    do (void)spoiler.arrived("");
    while (spoiler.socket().flush() && spoiler.socket().has_backlog());
  }
  spoiler.say({{"hello", true}});
  EXPECT_FALSE(spoiler.next("hello").is_null());
  other.say({{"id", 1}, {"do", "up"}});
  EXPECT_EQ(other.next("outcome")["outcome"]["exit"], 0);
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
  EXPECT_EQ(box.next(), "{\"missed\":3}");
  EXPECT_EQ(box.next(), "r1");
  for (std::size_t i = 3; i < Outbox::kMaxEvents + 3; ++i) EXPECT_EQ(box.next(), "e" + std::to_string(i));
  EXPECT_EQ(box.next(), "r2");
  EXPECT_EQ(box.next(), std::nullopt);
  EXPECT_TRUE(box.empty());
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
