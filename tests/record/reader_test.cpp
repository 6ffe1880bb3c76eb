// SPDX-License-Identifier: Apache-2.0
// Recordings of a live run and of a rehearsal, read by somebody else's code (tests/record/reader): every
// message decodes.
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/folders/folders.hpp"
#include "tests/live/programs.hpp"

namespace adit::live {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::HasSubstr;

class Reader : public Programs {
 protected:
  /// True when the reader is there; it is fetched into the build folder once.
  bool ready() {
    const auto installed =
        run({source_folder() + "/tests/record/reader/install.sh", reader_}, {}, Seconds(150));
    why_not_ = installed.out + installed.err;
    EXPECT_TRUE(installed.exit_code == 0 || installed.exit_code == 77) << why_not_;
    return installed.exit_code == 0;
  }
  Json read(const fs::path& file, bool torn = false) {
    std::vector<std::string> words{"/usr/bin/env", "node", reader_ + "/read.mjs", file.string()};
    if (torn) words.emplace_back("--torn");
    const auto got = run(words, {}, Seconds(60));
    const Json result = Json::parse(got.out, nullptr, false);
    EXPECT_TRUE(result.is_object()) << got.out << got.err;
    EXPECT_EQ(got.exit_code, 0) << result.value("errors", Json{}).dump() << got.err;
    EXPECT_EQ(result.value("failed", 1), 0);
    EXPECT_GT(result.value("messages", 0), 0);
    return result;
  }
  std::vector<fs::path> recordings(const std::string& name) {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder_.path() + "/adit/recordings"))
      if (entry.path().filename().string().starts_with(name + "-")) out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
  }

  std::string reader_{program_folder() + "/../recording_reader"};
  std::string why_not_{};
};

TEST_F(Reader, ALiveRunDecodes) {
  if (!ready()) GTEST_SKIP() << "the reader cannot be had here: " << why_not_;
  {
    PlainDriver driver(*net_);
    Process robot = agent();
    const auto done = [&](std::vector<std::string> words) {
      const Finished got = op("op1", std::move(words));
      return got.exit_code == 0 ? std::string{} : got.out + got.err;
    };
    ASSERT_EQ(done({"take", "r1"}), "");
    // The agent may not have heard its lidar yet.
    ASSERT_TRUE(eventually([&] {
      return done({"goto", "r1", "1", "0"}).empty();
    })) << done({"goto", "r1", "1", "0"});
    EXPECT_EQ(done({"drive", "r1", "0.2", "0", "0", "--for", "0.5"}), "");
    EXPECT_EQ(done({"stop", "r1"}), "");
    EXPECT_EQ(done({"down"}), "");
    robot.signal(SIGTERM);
    EXPECT_EQ(robot.wait(Seconds(20)).exit_code, 0);
  }
  ASSERT_EQ(recordings("r1").size(), 1U);
  const Json robot = read(recordings("r1")[0]);
  for (const char* topic : {"in/adit/command", "in/adit/joystick", "in/adit/presence",
                            "out/adit/acknowledgement", "out/adit/authority", "out/adit/behaviour",
                            "out/adit/capabilities", "out/adit/health", "out/adit/notification",
                            "out/adit/robot_state", "in/rt/odom", "in/rt/points", "out/rt/cmd_vel", "log"})
    EXPECT_TRUE(robot["topics"].contains(topic)) << topic << " is not in " << robot["topics"].dump();
  EXPECT_EQ(robot["samples"]["out/adit/robot_state"]["message"].value("robot", ""), "r1");
  EXPECT_EQ(robot["samples"]["in/adit/command"]["message"].value("station", ""), "op1");
  EXPECT_EQ(robot["samples"]["in/rt/points"]["message"].value("point_step", 0), 12);
  EXPECT_THAT(robot["samples"]["log"]["message"].value("message", ""), HasSubstr("up on radio domain"));
  EXPECT_EQ(robot["metadata"]["adit"].value("name", ""), "r1");

  ASSERT_EQ(recordings("op1").size(), 1U);
  const Json station = read(recordings("op1")[0]);
  for (const char* topic : {"out/adit/command", "out/adit/joystick", "in/adit/acknowledgement",
                            "in/adit/robot_state", "in/adit/behaviour"})
    EXPECT_TRUE(station["topics"].contains(topic)) << topic << " is not in " << station["topics"].dump();
}

TEST_F(Reader, DecodesTheRecordingOfAKilledAgent) {
  if (!ready()) GTEST_SKIP() << "the reader cannot be had here: " << why_not_;
  const fs::path file = folder_.path() + "/adit/recordings/r1-000001.mcap";
  {
    Process robot = agent();
    // What is older than a second survives: the file has grown twice.
    std::uintmax_t size = 0;
    for (int grown = 0; grown < 2; ++grown)
      ASSERT_TRUE(eventually([&] {
        std::error_code none;  // the file may not be there yet
        const auto now = fs::file_size(file, none);
        return !none && now > std::exchange(size, now) && now > 1000;
      }));
    robot.signal(SIGKILL);
    robot.wait(Seconds(5));
  }
  EXPECT_TRUE(read(file, true)["topics"].contains("out/adit/robot_state"));
  const std::string saved = folder_.path() + "/saved.mcap";
  EXPECT_EQ(run({"recording", "recover", file.string(), saved}).exit_code, 0);
  EXPECT_TRUE(read(saved)["topics"].contains("out/adit/robot_state")) << "and as a whole file";
}

TEST_F(Reader, ARehearsalDecodes) {
  if (!ready()) GTEST_SKIP() << "the reader cannot be had here: " << why_not_;
  const std::string file = folder_.path() + "/run.mcap";
  const auto rehearsed =
      run({"rehearse", source_folder() + "/config/scenarios/grant.yaml", "--record", file}, {}, Seconds(60));
  ASSERT_EQ(rehearsed.exit_code, 0) << rehearsed.err;
  const Json heard = read(file);
  for (const char* topic : {"op1/adit/command", "op1/adit/command>r1", "r1/adit/robot_state",
                            "r1/adit/robot_state>op1", "r1/adit/acknowledgement>op1", "r1/rt/cmd_vel"})
    EXPECT_TRUE(heard["topics"].contains(topic)) << topic << " is not in " << heard["topics"].dump();
  const Json& command = heard["samples"]["op1/adit/command>r1"];
  EXPECT_EQ(command["metadata"].value("from", ""), "op1");
  EXPECT_EQ(command["metadata"].value("to", ""), "r1");
  EXPECT_EQ(command["message"].value("robot", ""), "r1");
}

TEST_F(Reader, RecordingDoesNotChangeARehearsal) {
  const std::string scenario = source_folder() + "/config/scenarios/grant.yaml";
  const auto digest = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"rehearse", scenario};
    words.insert(words.end(), more.begin(), more.end());
    const std::string out = run(words, {}, Seconds(60)).out;
    const std::size_t at = out.find("digest ");
    return at == std::string::npos ? out : out.substr(at, 30);
  };
  EXPECT_EQ(digest({"--record", folder_.path() + "/run.mcap"}), digest({}));
}

}  // namespace
}  // namespace adit::live
