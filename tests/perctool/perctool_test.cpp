// SPDX-License-Identifier: Apache-2.0
// The program perctool: what it prints, and how it ends.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

struct PerctoolEnded {
  int status;
  std::string out;
};

PerctoolEnded perctool(const std::string& arguments) {
  PerctoolEnded ended{};
  FILE* pipe = popen((program_folder() + "/perctool " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    ended.out.append(buffer.data(), n);
  ended.status = WEXITSTATUS(pclose(pipe));
  return ended;
}

nlohmann::json last_line(const std::string& out) {
  const std::size_t end = out.find_last_not_of('\n');
  const std::size_t begin = out.rfind('\n', end);
  return nlohmann::json::parse(out.substr(begin == std::string::npos ? 0 : begin + 1));
}

TEST(Perctool, EvalPrintsTheSameAsEvo) {
  const Scratch scratch;
  scratch.write("truth.tum", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.2 2 1 0 0 0 0 1\n0.3 3 1 0 0 0 0 1\n");
  scratch.write("estimate.tum",
                "0 0 0 1 0 0 0 1\n0.1 1 0 1 0 0 0 1\n0.2 2 1 1 0 0 0 1\n0.301 3 1 1.4 0 0 0 1\n");
  const std::string files = scratch.path("truth.tum").string() + " " + scratch.path("estimate.tum").string();
  const PerctoolEnded ended = perctool("eval " + files + " --json");
  ASSERT_EQ(ended.status, 0) << ended.out;
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["poses"], 4);
  EXPECT_NEAR(json["ate"]["mean"].get<double>(), 1.1, 1e-9);
  EXPECT_NEAR(json["ate"]["max"].get<double>(), 1.4, 1e-9);
  EXPECT_NEAR(json["ate"]["sse"].get<double>(), 4.96, 1e-9);
  EXPECT_NEAR(json["rpe"]["max"].get<double>(), 0.4, 1e-9);
  EXPECT_EQ(json["pairs"], 3);
  const auto aligned = nlohmann::json::parse(perctool("eval " + files + " --align --json").out);
  EXPECT_LT(aligned["ate"]["rmse"].get<double>(), 0.3);
}

TEST(Perctool, RecordsARobotAndLocatesIt) {
  const Scratch scratch;
  scratch.write("drive.yaml",
                "world: {generate: rooms, seed: 1}\nduration: 12\nlink: lan\n"
                "robots:\n  - {id: r1, platform: wheeled, pose: [2, 7.5, 0]}\n"
                "basestations:\n  - {id: op1, pose: [0, 0]}\n"
                "script:\n  - {at: 2, by: op1, do: take r1}\n  - {at: 3, by: op1, do: goto r1 8 7.5}\n");
  const auto file = [&](const char* name) { return scratch.path(name).string(); };
  const PerctoolEnded recorded =
      perctool("record " + file("drive.yaml") + " --robot r1 --out " + file("r1.mcap"));
  ASSERT_EQ(recorded.status, 0) << recorded.out;
  const PerctoolEnded located = perctool("odometry --clouds " + file("r1.mcap") + " --out " + file("r1.tum") +
                                         " --truth " + file("truth.tum") + " --json");
  ASSERT_EQ(located.status, 0) << located.out;
  EXPECT_GT(last_line(located.out)["sweeps"], 100);
  EXPECT_EQ(last_line(located.out)["health"], "ok");
  const auto json = nlohmann::json::parse(
      perctool("eval " + file("truth.tum") + " " + file("r1.tum") + " --align --json").out);
  EXPECT_GT(json["length"], 4.0);
  EXPECT_LT(json["ate"]["rmse"], 0.05);
}

TEST(Perctool, LocatesMapsAndAlignsClouds) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch.path("clouds"));
  // A room of 8 x 6 x 3 m; the lidar drives off from rest.
  for (int cloud = 0; cloud < 6; ++cloud) {
    std::string bytes;
    const auto put = [&](float x, float y, float z) {
      for (const float v :
           {x + 0.13f - 0.01f * static_cast<float>(cloud * (cloud + 1)), y + 0.11f, z + 0.09f, 0.5f})
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    };
    std::mt19937 random(static_cast<unsigned>(cloud + 1));
    const auto between = [&random](float low, float high) {
      return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
    };
    for (int n = 0; n < 4000; ++n) {
      for (const float y : {-3.0f, 3.0f}) put(between(-4, 4), y, between(-1, 2));
      for (const float x : {-4.0f, 4.0f}) put(x, between(-3, 3), between(-1, 2));
      for (const float z : {-1.0f, 2.0f}) put(between(-4, 4), between(-3, 3), z);
    }
    scratch.write("clouds/" + std::to_string(cloud) + ".bin", bytes);
  }
  const auto file = [&](const char* name) { return scratch.path(name).string(); };
  const PerctoolEnded located =
      perctool("odometry --clouds " + file("clouds") + " --out " + file("room.tum") + " --json");
  ASSERT_EQ(located.status, 0) << located.out;
  std::ifstream tum(scratch.path("room.tum"));
  std::string first, line, last;
  std::getline(tum, first);
  while (std::getline(tum, line)) last = line;
  EXPECT_EQ(first.substr(0, 28), "0.000000000 0.000000 0.00000");
  std::istringstream words(last);
  double stamp = 0, x = 0, y = 0;
  words >> stamp >> x >> y;
  EXPECT_EQ(stamp, 0.5);
  EXPECT_NEAR(x, 0.3, 0.03) << last;
  EXPECT_NEAR(y, 0.0, 0.03) << last;

  const PerctoolEnded mapped = perctool("map --clouds " + file("clouds") + " --poses " + file("room.tum") +
                                        " --out " + file("room.bt") + " --json");
  ASSERT_EQ(mapped.status, 0) << mapped.out;
  EXPECT_GT(last_line(mapped.out)["occupied"], 5000);
  const PerctoolEnded same = perctool("diff " + file("room.bt") + " " + file("room.bt") + " --json");
  ASSERT_EQ(same.status, 0) << same.out;
  EXPECT_EQ(nlohmann::json::parse(same.out)["share"], 1.0);

  const PerctoolEnded aligned = perctool("align " + file("clouds/0.bin") + " " + file("clouds/5.bin") +
                                         " --guess \"0.1 0 0 0 0 0 1\" --json");
  ASSERT_EQ(aligned.status, 0) << aligned.out;
  const auto json = nlohmann::json::parse(aligned.out);
  EXPECT_NEAR(json["pose"][0].get<double>(), 0.3, 0.02);
  EXPECT_GT(json["overlap"], 0.7);
}

TEST(Perctool, ErrorsAreOneLine) {
  const Scratch scratch;
  scratch.write("bad.tum", "0 1 2\n");
  const std::string bad = scratch.path("bad.tum").string();
  for (const std::string& arguments :
       {"eval /nowhere " + bad, "eval " + bad + " " + bad, std::string("diff /nowhere.bt /nowhere.bt"),
        "odometry --clouds /nowhere --out " + scratch.path("out.tum").string(),
        "map --clouds /nowhere --poses " + bad + " --out a.bt",
        std::string("align /nowhere.pcd /nowhere.pcd"),
        std::string("record /nowhere.yaml --robot r1 --out a.mcap"), std::string("fly")}) {
    const PerctoolEnded ended = perctool(arguments);
    EXPECT_EQ(ended.status, 2) << arguments << ended.out;
    EXPECT_EQ(std::count(ended.out.begin(), ended.out.end(), '\n'), 1) << ended.out;
  }
}

TEST(Perctool, HelpHasExamples) {
  for (const char* command : {"", "odometry", "map", "align", "record", "eval", "diff"}) {
    const PerctoolEnded ended = perctool(std::string(command) + " --help");
    EXPECT_EQ(ended.status, 0);
    EXPECT_NE(ended.out.find("Example"), std::string::npos) << command;
  }
}

}  // namespace
}  // namespace adit::sim
