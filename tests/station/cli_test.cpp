// SPDX-License-Identifier: Apache-2.0
// The real program, where no robot is present.
#include <gmock/gmock.h>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "basestation/host/server.hpp"
#include "core/command/vocabulary.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "tests/folders/folders.hpp"
#include "tests/live/process.hpp"

namespace adit::station {
namespace {

using live::Finished;
using live::Seconds;
using nlohmann::json;
using testing::HasSubstr;

class Cli : public testing::Test {
 protected:
  ~Cli() override {
    for (const char* name : {"op1", "op2"}) run({"--name", name, "down", "--leave"});
  }
  Finished run(std::vector<std::string> words) {
    words.insert(words.begin(), {"basestation", "--domain", std::to_string(live::domain())});
    return live::run(words, folder_.environment(), Seconds(20));
  }
  std::string path(const std::string& name) const {
    const auto environment = folder_.environment();
    return environment.at("XDG_RUNTIME_DIR") + "/adit/" + name;
  }
  /// What the station answers to raw bytes, until `expected` is in it; without one, until it says nothing
  /// more for a while.
  std::string talk(const std::string& bytes, const std::string& expected = {}) {
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path("op1.sock").c_str(), sizeof address.sun_path - 1);
    const timeval limit = expected.empty() ? timeval{0, 400000} : timeval{20, 0};
    ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    std::string out;
    if (::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
      for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t sent = ::send(fd, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
        if (sent <= 0) break;
        at += static_cast<std::size_t>(sent);
      }
      char buffer[4096];
      const auto answered = [&] { return !expected.empty() && out.find(expected) != std::string::npos; };
      for (ssize_t size; !answered() && (size = ::recv(fd, buffer, sizeof buffer, 0)) > 0;)
        out.append(buffer, static_cast<std::size_t>(size));
    }
    ::close(fd);
    return out;
  }

  live::Folder folder_{};
};

TEST_F(Cli, HelpOfTheProgramAndOfEachCommand) {
  const Finished all = run({"--help"});
  EXPECT_EQ(all.exit_code, 0);
  for (const command::CommandInfo& command : command::table()) {
    if (command.runs == command::Runs::nobody) continue;
    EXPECT_THAT(all.out, HasSubstr("  " + std::string(command.first_word())));
    std::vector<std::string> words;  // A name may be two of them, as in "convoy start".
    std::istringstream name{std::string(command.name)};
    for (std::string word; name >> word;) words.push_back(word);
    words.push_back("--help");
    const Finished one = run(words);
    EXPECT_EQ(one.exit_code, 0);
    EXPECT_THAT(one.out, HasSubstr("example: basestation " + std::string(command.example)));
  }
  EXPECT_THAT(all.out, HasSubstr("Examples:"));
  EXPECT_EQ(all.out.find("relay"), std::string::npos);
}

TEST_F(Cli, WrongUsageIsOneLineAndExitTwo) {
  const std::vector<std::vector<std::string>> wrong{
      {"tkae", "r1"},         {"goto", "r1", "north", "1"}, {"--domain", "999", "list"},
      {"--nmae", "x"},        {"--name", "a/b", "list"},    {"run", "/no/such/file.yaml"},
      {"completion", "tcsh"}, {"relay", "r1", "on"},        {"list", "--name", "op2"}};
  for (const auto& words : wrong) {
    const Finished end = run(words);
    EXPECT_EQ(end.exit_code, 2) << words[0];
    EXPECT_EQ(std::count(end.err.begin(), end.err.end(), '\n'), 1) << end.err;
  }
}

TEST_F(Cli, CompletionScriptsAndWords) {
  EXPECT_THAT(run({"completion", "bash"}).out, HasSubstr("complete -o default -F"));
  EXPECT_THAT(run({"completion", "zsh"}).out, HasSubstr("#compdef basestation"));
  EXPECT_THAT(run({"completion", "fish"}).out, HasSubstr("complete -c basestation"));
  EXPECT_THAT(run({"completion", "words", "mode", "r1", ""}).out, HasSubstr("smart_joystick"));
  EXPECT_THAT(run({"completion", "words", "stop", ""}).out, HasSubstr("all"));
}

TEST_F(Cli, ACommandStartsAStationAndSaysSo) {
  const Finished first = run({"--json", "list"});
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.err, HasSubstr("started one"));
  EXPECT_EQ(json::parse(first.out)["stations"][0]["station"], "op1");
  EXPECT_TRUE(run({"list"}).err.empty());
  struct stat status {};
  ASSERT_EQ(::stat(path("op1.sock").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  ASSERT_EQ(::stat(path("").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700U);
  EXPECT_THAT(run({"down"}).out, HasSubstr("is down"));
  EXPECT_TRUE(live::eventually([&] { return ::access(path("op1.sock").c_str(), F_OK) != 0; }));
}

TEST_F(Cli, UnknownRobotIsExitOneAndNobodyThereIsExitThree) {
  const Finished take = run({"take", "r9"});
  EXPECT_EQ(take.exit_code, 1);
  EXPECT_THAT(take.err, HasSubstr("known robots: none"));
  EXPECT_EQ(run({"stop", "all"}).exit_code, 3);
}

TEST_F(Cli, AStationSaysWhereItStandsIfThatIsGiven) {
  EXPECT_THAT(run({"list"}).out, testing::Not(HasSubstr(" at ")));
  EXPECT_THAT(run({"--name", "op2", "--at", "4", "5", "0.5", "list"}).out,
              HasSubstr("op2 (this one) at 4.0 5.0 0.5"));
  EXPECT_THAT(run({"list"}).out, HasSubstr("op2 at 4.0 5.0 0.5"));
}

TEST_F(Cli, OneStationPerName) {
  EXPECT_EQ(run({"up"}).exit_code, 0);
  const Finished second = run({"--serve", "-1"});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.err, HasSubstr("running already"));
  EXPECT_EQ(run({"--name", "op2", "up"}).exit_code, 0) << "another name is another station";
}

TEST_F(Cli, AStationOnAnotherDomainIsNotAskedByMistake) {
  ASSERT_EQ(run({"up"}).exit_code, 0);
  const std::string other = std::to_string(live::domain(1));
  const auto asked =
      live::run({"basestation", "--domain", other, "list"}, folder_.environment(), Seconds(20));
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_THAT(asked.err, HasSubstr("runs on domain " + std::to_string(live::domain())));
}

TEST_F(Cli, ALinkForAStationThatRunsWithoutOneIsReported) {
  ASSERT_EQ(run({"up"}).exit_code, 0);
  const Finished asked = run({"--link", "wifi", "list"});
  EXPECT_EQ(asked.exit_code, 0);
  EXPECT_THAT(asked.err, HasSubstr("runs without a link profile; --link counts only when a station starts"));
}

TEST_F(Cli, NetworkOptionsForAStationThatRunsAreReported) {
  ASSERT_EQ(run({"up"}).exit_code, 0);
  const Finished interface = run({"--interface", "10.255.255.1", "list"});
  EXPECT_EQ(interface.exit_code, 2) << "the command would reach other robots";
  EXPECT_THAT(interface.err, HasSubstr("the station of op1 runs on loopback; leave --interface out"));
  EXPECT_EQ(run({"--interface", "127.0.0.1", "list"}).err, "");
  const Finished others = run({"--peer", "127.0.0.1", "--at", "1", "2", "3", "--record", "none", "list"});
  EXPECT_EQ(others.exit_code, 0);
  for (const char* option : {"--peer", "--at", "--record"})
    EXPECT_THAT(others.err, HasSubstr(std::string(option) + " counts only when a station starts")) << option;
}

TEST_F(Cli, APipedPromptPrintsTextAlone) {
  ASSERT_EQ(run({"up"}).exit_code, 0);
  const Finished piped =
      live::run({"/bin/sh", "-c",
                 "printf 'list\\nstop r9\\nlist\\n' | \"$0\" --domain " + std::to_string(live::domain()),
                 program_folder() + "/basestation"},
                folder_.environment(), Seconds(20));
  EXPECT_THAT(piped.out, HasSubstr("stations: op1"));
  EXPECT_EQ(piped.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(piped.out.find("in another"), std::string::npos) << "its own stop is nobody else's";
}

TEST_F(Cli, AnAddressDoesNotSwallowTheCommand) {
  const auto asked = run({"--interface", "127.0.0.1", "--peer", "127.0.0.1", "--peer", "127.0.0.1:7", "--at",
                          "1", "-2", "0.5", "status"});
  EXPECT_EQ(asked.exit_code, 0) << asked.err;
  EXPECT_THAT(asked.out, HasSubstr("station op1"));
}

TEST_F(Cli, AnUnknownLinkIsWrongUsageAndNamesTheKnownOnes) {
  const auto asked = run({"--link", "warp", "list"});
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_THAT(asked.err, HasSubstr("there are: lan, loopback, mesh_100k, mesh_500k, subt, tunnel, wifi"));
}

TEST_F(Cli, AKilledStationIsReplacedAndKeepsItsIdentity) {
  run({"up"});
  const std::string identity_path = folder_.environment().at("XDG_STATE_HOME") + "/adit/op1.id";
  std::string before, after;
  std::ifstream(identity_path) >> before;
  EXPECT_EQ(before.size(), 32U);
  const json hello = json::parse(talk("{\"hello\":true}\n", "\n"));
  ASSERT_EQ(::kill(hello["hello"]["pid"].get<int>(), SIGKILL), 0);
  EXPECT_EQ(::access(path("op1.sock").c_str(), F_OK), 0) << "its socket is left behind";
  EXPECT_TRUE(live::eventually([&] { return talk("{\"hello\":true}\n").empty(); }));
  const Finished next = run({"list"});
  EXPECT_EQ(next.exit_code, 0);
  EXPECT_THAT(next.err, HasSubstr("started one"));
  std::ifstream(identity_path) >> after;
  EXPECT_EQ(before, after);
}

TEST_F(Cli, ADamagedIdentityIsReportedAndNotReplaced) {
  run({"up"});
  run({"down"});
  std::ofstream(folder_.environment().at("XDG_STATE_HOME") + "/adit/op1.id") << "no identity\n";
  const Finished up = run({"up"});
  EXPECT_EQ(up.exit_code, 1);
  EXPECT_THAT(up.err, HasSubstr("is damaged; remove it"));
}

TEST_F(Cli, TheSocketSurvivesGarbage) {
  run({"up"});
  EXPECT_THAT(talk("garbage\n[1,2]\n{\"id\":\"x\"}\n{\"id\":1}\n", "wrong"), HasSubstr("wrong"));
  EXPECT_THAT(talk("{\"id\":1,\"stick\":[1,2]}\n", "wrong"), HasSubstr("'stick'"));
  EXPECT_THAT(talk("{\"id\":1,\"do\":5}\n{\"cancel\":\"x\"}\n", "wrong"), HasSubstr("wrong"));
  EXPECT_THAT(talk(std::string("\0\xff\xfe{}\n", 6), "wrong"), HasSubstr("wrong"));
  EXPECT_THAT(talk("{\"id\":7,\"teleop\":\"a b\"}\n", "robot's name"), HasSubstr("robot's name"));
  EXPECT_THAT(talk("{\"id\":8,\"teleop\":\"r1\",\"do\":5}\n", "wrong"), HasSubstr("'do'"));
  EXPECT_THAT(talk("{\"id\":8,\"teleop\":\"r1\"}\n", "begun"), HasSubstr("begun"));
  talk(std::string(1 << 20, 'x'));  // an endless line
  talk("{\"id\":1,\"do\":\"" + std::string(100000, '[') + "\"}\n");
  talk(std::string(100000, '[') + "\n");
  EXPECT_THAT(talk("{\"id\":3,\"do\":\"list\"}\n", "\"outcome\""), HasSubstr("\"outcome\""));
  EXPECT_EQ(run({"list"}).exit_code, 0);
}

TEST_F(Cli, AStopWithoutAStationGoesOutByItself) {
  const Finished end = run({"stop", "r1"});
  EXPECT_THAT(end.err, HasSubstr("goes out by itself"));
  EXPECT_NE(end.exit_code, 0);
}

TEST_F(Cli, AStopThatTheStationHasNoRoomForGoesOutByItself) {
  std::filesystem::create_directory(std::filesystem::path(path("op1.sock")).parent_path());
  ASSERT_EQ(::chmod(path("").c_str(), 0700), 0);
  VirtualScheduler scheduler{1};
  wire::SimulatedNetwork network{scheduler, {}};
  const auto wire = network.join(77, "op1");
  LiveRuntime runtime;
  const auto strand = runtime.strand("station");
  auto server = host::Server::open(path(""), "op1").value();
  std::unique_ptr<Station> station;
  std::promise<void> made, free;
  strand->post([&, go = free.get_future().share()] {
    station = std::make_unique<Station>(StationParams{.name = "op1", .id = {1}}, *strand, *wire);
    made.set_value();
    go.wait();  // busy from now on
  });
  made.get_future().wait();
  while (strand->post([] {})) continue;  // and its queue is full
  std::thread serving([&] { server->serve(*station, *strand, {{"station", "op1"}}, -1); });
  const Finished end = run({"stop", "r1"});
  EXPECT_THAT(end.err, HasSubstr("the stop goes out by itself"));
  EXPECT_THAT(end.err, testing::Not(HasSubstr("too much to do")));
  server->end();
  serving.join();
  std::promise<void> ended;
  free.set_value();
  strand->post_control([&] {
    station.reset();
    ended.set_value();
  });
  ended.get_future().wait();
}

TEST_F(Cli, TerminalCommandsSayThatTheyWantATerminal) {
  EXPECT_EQ(run({"watch"}).exit_code, 2);
  EXPECT_EQ(run({"teleop", "r1"}).exit_code, 2);
}

TEST_F(Cli, AScriptPlaysTheOperatorsLines) {
  const std::string file = folder_.write("s.yaml",
                                         "duration: 3\n"
                                         "script:\n"
                                         "  - {at: 0.2, by: op1, do: list}\n"
                                         "  - {at: 0.1, by: op2, do: list}\n");
  const Finished end = run({"run", file});
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_THAT(end.out, HasSubstr("op1> list"));
  EXPECT_EQ(end.out.find("op2>"), std::string::npos);
  const Finished none = run({"--name", "op3", "run", file});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("no lines by op3"));
  const std::string unknown = folder_.write("unknown.yaml",
                                            "script:\n"
                                            "  - {at: 0.1, by: op1, do: take r2}\n"
                                            "  - {at: 0.2, by: op1, do: list}\n");
  const Finished some = run({"run", unknown});
  EXPECT_EQ(some.exit_code, 1) << "every command for r2 was refused";
  EXPECT_THAT(some.out, HasSubstr("r2: "));
  EXPECT_THAT(some.out, HasSubstr("op1> list"));
  EXPECT_THAT(some.err, HasSubstr("commands: 2, refused: 1, without an answer: 0"));
  const std::string bad = folder_.write("bad.yaml", "script:\n  - {at: 1, by: op1, do: tkae r1}\n");
  const Finished refused = run({"run", bad});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("bad.yaml:2"));
  EXPECT_THAT(refused.err, HasSubstr("did you mean take?"));
}

}  // namespace
}  // namespace adit::station
