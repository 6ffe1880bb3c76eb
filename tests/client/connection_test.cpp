// SPDX-License-Identifier: Apache-2.0
// A front end's connection: what it reads of a station that ends, or of another version.
#include "basestation/client/connection.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include "basestation/cli/run_line.hpp"
#include "core/command/words.hpp"
#include "tests/folders/folders.hpp"

namespace adit::station::client {
namespace {

using testing::HasSubstr;

TEST(Connection, QuotesTheWordsThatNeedIt) {
  EXPECT_EQ(quoted({"goto", "r1", "-1.5", "0", "--wait"}), "goto r1 -1.5 0 --wait");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"a b", ""}, {"it's", "\"x\"", "back\\slash"}, {"", "#", "$x"}}) {
    EXPECT_EQ(command::split_words(quoted(words)).value(), words) << quoted(words);
  }
}

TEST(LineSocket, DoesNotWaitForAStationThatAcceptsNobody) {
  const std::string path = scratch_folder() + "/op1.sock";
  const File listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listener.get(), 2), 0);
  std::vector<LineSocket> accepted;
  std::optional<Error> refused;
  while (!refused && accepted.size() < 20) {
    auto socket = LineSocket::connect(path);
    if (socket)
      accepted.push_back(std::move(*socket));
    else
      refused = socket.error();
  }
  ASSERT_TRUE(refused) << "the queue was never full";
  EXPECT_EQ(refused->reason, Reason::cannot_read) << "no second station may be started beside it";
  EXPECT_THAT(refused->text, HasSubstr("hangs"));
}

/// A connection and the station's end of its socket.
class ConnectionTest : public testing::Test {
 protected:
  ConnectionTest() {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    connection_.emplace(LineSocket(File(ends[0])), "shell");
    station_.reset(ends[1]);
  }
  void station_writes(const std::string& text) {
    ASSERT_EQ(::write(station_.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  std::optional<Connection> connection_{};
  File station_{};
};

TEST_F(ConnectionTest, ReadsWhyItWasCutOffAlthoughItCannotSendAnyMore) {
  station_writes("{\"cut_off\":\"32 programs are connected\"}\n");
  station_.reset();
  connection_->execute("list");
  EXPECT_FALSE(connection_->wait(1000));
  EXPECT_THAT(connection_->gone(), HasSubstr("32 programs are connected"));
  EXPECT_FALSE(connection_->connected());
}

TEST_F(ConnectionTest, GetsAnOutcomeThatWasWrittenBeforeTheStationEnded) {
  std::optional<CommandOutcome> outcome;
  connection_->on_outcome = [&](std::int64_t, const CommandOutcome& ended) { outcome = ended; };
  connection_->execute("list");
  station_writes("{\"id\":1,\"outcome\":{\"exit\":0}}\n");
  station_.reset();
  connection_->follow();  // fails
  EXPECT_FALSE(connection_->wait(1000));
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->exit_code, 0);
}

TEST_F(ConnectionTest, SaysWhatItDoesNotUnderstandAndGoesOn) {
  int worlds = 0;
  connection_->on_world = [&](const World&) { ++worlds; };
  for (const char* odd : {"half a line of", "[1,2]", "{\"world\":5}", "{\"id\":\"x\"}", "{\"missed\":-3}",
                          "{\"world\":{\"robots\":[{\"robot\":5}]}}", "{\"map\":{\"resolution\":0}}"}) {
    station_writes(std::string(odd) + "\n");
    EXPECT_TRUE(connection_->wait(1000)) << odd;
    EXPECT_NE(connection_->not_understood(), "") << odd;
  }
  EXPECT_EQ(worlds, 0);
  station_writes("{\"world\":{\"robots\":[{\"robot\":\"r1\"}]},\"of_a_later_version\":1}\n");
  EXPECT_TRUE(connection_->wait(1000));
  EXPECT_EQ(worlds, 1);
}

TEST(CommandOfAnother, IsShownWhenItEnds) {
  const CommandEvent event{
      .ended = true, .line = "take r1", .front_end = "script", .pid = 1, .text = "r1: taken\n"};
  EXPECT_EQ(cli::command_of_another(event), "in another script: take r1 -> r1: taken");
  CommandEvent hidden = event;
  hidden.ended = false;
  EXPECT_EQ(cli::command_of_another(hidden), "");
  hidden = event;
  hidden.query = true;
  EXPECT_EQ(cli::command_of_another(hidden), "");
  hidden = event;
  hidden.mine = true;
  EXPECT_EQ(cli::command_of_another(hidden), "");
  hidden = event;
  hidden.pid = ::getpid();
  EXPECT_EQ(cli::command_of_another(hidden), "") << "another connection of this program";
}

}  // namespace
}  // namespace adit::station::client
