// SPDX-License-Identifier: Apache-2.0
// The program navtool: what it prints, and how it ends.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tests/folders/folders.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::sim {
namespace {

struct Ended {
  int status;
  std::string out;
};

Ended run(const std::string& arguments) {
  Ended ended{};
  FILE* pipe = popen((program_folder() + "/navtool " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    ended.out.append(buffer.data(), n);
  ended.status = WEXITSTATUS(pclose(pipe));
  return ended;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// The commands that read clouds need the Point Cloud Library.
class Clouds : public testing::Test {
 protected:
  std::filesystem::path folder_{scratch_folder()};
  void SetUp() override {
    if (!ADIT_PCL) GTEST_SKIP() << "built without the Point Cloud Library";
  }

  /// Six clouds on a corridor along x, the sensor's frame or the map's.
  void write(bool in_map, bool wall) {
    nav::test::BoxWorld world{{{-5, 30, 1.5, 1.7}, {-5, 30, -1.7, -1.5}}};
    if (wall) world.boxes.push_back({4, 4.2, -1.5, 1.5});
    std::mt19937 random(1);
    for (int i = 0; i < 6; ++i) {
      const Pose2 body{0.1 * i, 0, 0};
      std::ofstream file(folder_ / ("cloud_" + std::to_string(i) + ".pcd"));
      std::ostringstream points;
      std::size_t count = 0;
      for (const Eigen::Vector3f& p : world.scan(body, 0.5, 16, 360, 0.01, random)) {
        points << p.x() + (in_map ? body.x : 0) << ' ' << p.y() << ' ' << p.z() - (in_map ? 0 : 0.5) << '\n';
        ++count;
      }
      file << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << count
           << "\nHEIGHT 1\nVIEWPOINT " << body.x << " 0 0.5 1 0 0 0\nPOINTS " << count << "\nDATA ascii\n"
           << points.str();
    }
  }
};

TEST_F(Clouds, OneJsonLineACycle) {
  for (const bool in_map : {false, true}) {
    write(in_map, false);
    const Ended ended = run("plan --clouds " + folder_.string() + " --goal 8 0 --json");
    ASSERT_EQ(ended.status, 0) << ended.out;
    std::istringstream out(ended.out);
    std::string line;
    int cycle = 0;
    for (; std::getline(out, line); ++cycle) {
      const auto json = nlohmann::json::parse(line);
      EXPECT_EQ(json["cycle"], cycle);
      EXPECT_GT(json["terrain_ms"], 0.0);
      EXPECT_GT(json["plan_ms"], 0.0);
      EXPECT_EQ(json["blocked"], false) << line;
      ASSERT_GT(json["path"].size(), 5u);
      EXPECT_GT(json["path"].back()[0].get<double>(), 2.0);
      EXPECT_NEAR(json["path"].back()[1].get<double>(), 0.0, 0.6);
    }
    EXPECT_EQ(cycle, 6);
  }
}

TEST_F(Clouds, WallAhead) {
  write(false, true);
  const Ended ended = run("plan --clouds " + folder_.string() + " --goal 8 0 --json");
  ASSERT_EQ(ended.status, 0) << ended.out;
  const auto last = nlohmann::json::parse(ended.out.substr(ended.out.rfind('\n', ended.out.size() - 2) + 1));
  for (const auto& p : last["path"]) EXPECT_LT(p[0].get<double>(), 4.0);
}

TEST_F(Clouds, ErrorsAreOneLine) {
  for (const std::string& arguments :
       {std::string("plan --clouds /nowhere --goal 1 2"),
        std::string("route --map nosuch.bt --from 0 0 0 --to 1 1 0"),
        std::string("plan --clouds ") + folder_.string() + " --goal 1", std::string("fly"),
        std::string("track --path /nowhere"), std::string("track --platform nosuch")}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2) << arguments;
    EXPECT_EQ(lines(ended.out), 1u) << ended.out;
  }
  std::ofstream(folder_ / "a.pcd") << "FIELDS x\n";
  const Ended broken = run("plan --clouds " + folder_.string() + " --goal 1 2");
  EXPECT_EQ(broken.status, 2);
  EXPECT_NE(broken.out.find("a.pcd:1:"), std::string::npos) << broken.out;
}

TEST_F(Clouds, TerrainCountsKnownCellsWithinRange) {
  write(false, true);
  const Ended one = run("terrain --cloud " + (folder_ / "cloud_0.pcd").string() + " --range 4 --json");
  ASSERT_EQ(one.status, 0) << one.out;
  const auto json = nlohmann::json::parse(one.out);
  double all = 0;
  for (const char* name : {"ground", "step", "slope", "obstacle", "drop", "unknown"}) {
    EXPECT_NEAR(json["m2"][name].get<double>(), 0.01 * json["cells"][name].get<double>(), 1e-9) << name;
    all += json["m2"][name].get<double>();
  }
  EXPECT_NEAR(all, M_PI * 16, 1.0);
  EXPECT_GT(json["cells"]["ground"], 100);
  EXPECT_EQ(json["cells"]["drop"], 0);
  // A folder is accumulated: an obstacle counts from its second scan on.
  const auto picture = folder_ / "terrain.png";
  const Ended folder =
      run("terrain --cloud " + folder_.string() + " --range 4 --json --picture " + picture.string());
  ASSERT_EQ(folder.status, 0) << folder.out;
  EXPECT_GT(nlohmann::json::parse(folder.out)["cells"]["obstacle"], 20);
  EXPECT_GT(std::filesystem::file_size(picture), 1000u);
}

TEST_F(Clouds, TerrainTakesOnePoseForEachCloud) {
  write(false, false);
  const auto tum = folder_ / "poses.tum", sensor = folder_ / "sensor.yaml";
  std::ofstream(sensor) << "lidar: {x: 0.1, y: 0, z: 0.5}\n";
  std::ofstream(tum) << "0 0 0 0 0 0 0 1\n";
  const std::string command = "terrain --json --range 4 --cloud " + folder_.string() + " --poses " +
                              tum.string() + " --sensor " + sensor.string();
  EXPECT_EQ(run(command).status, 2) << "six clouds, one pose";
  std::ofstream(tum) << "0 0 0 0 0 0 0 1\n.1 1 0 0 0 0 0 1\n.2 2 0 0 0 0 0 1\n.3 3 0 0 0 0 0 1\n"
                        ".4 4 0 0 0 0 0 1\n.5 5 0 0 0 0 0 1\n";
  const Ended ended = run(command);
  ASSERT_EQ(ended.status, 0) << ended.out;
  double all = 0;
  const auto json = nlohmann::json::parse(ended.out);
  for (const auto& part : json["m2"]) all += part.get<double>();
  EXPECT_GT(all, M_PI * 16 + 5 * 7) << "a disc that moves by five metres";
}

TEST(Navtool, RouteThroughTheBuilding) {
  const std::string picture = scratch_folder() + "/route.png";
  const Ended ended =
      run("route --map geb079.bt --from -5 -0.1 0 --to 20 -0.2 0 --json --picture " + picture);
  if (ended.status == 2 && ended.out.find("geb079") != std::string::npos) GTEST_SKIP() << ended.out;
  ASSERT_EQ(ended.status, 0) << ended.out;
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["status"], "found");
  EXPECT_NEAR(json["length"], 25.0, 1.0);
  EXPECT_LT(json["memory_bytes"], 100e6);
  EXPECT_GT(std::filesystem::file_size(picture), 1000u);
  // Beside the building.
  const Ended outside = run("route --map geb079.bt --from -5 -0.1 0 --to 10 30 0");
  EXPECT_EQ(outside.status, 1) << outside.out;
}

TEST(Navtool, TracksWithEveryController) {
  const Ended ended = run("track --json");
  ASSERT_EQ(ended.status, 0) << ended.out;
  EXPECT_GE(lines(ended.out), 2u);
  EXPECT_NE(ended.out.find("pure_pursuit"), std::string::npos);
  EXPECT_NE(ended.out.find("ilqr"), std::string::npos);
}

TEST(Navtool, TracksWithACarWhoseRearAxleFollows) {
  const Ended ended = run("track --json --platform car");
  ASSERT_EQ(ended.status, 0) << ended.out;
  std::istringstream stream(ended.out);
  for (std::string line; std::getline(stream, line);) {
    const auto result = nlohmann::json::parse(line);
    EXPECT_LT(result["seconds"].get<double>(), 15.0) << line;
    EXPECT_LT(result["max_m"].get<double>(), 0.25) << line;
  }
}

TEST(Navtool, HelpHasExamples) {
  for (const char* command : {"", "route", "plan", "terrain", "track"}) {
    const Ended ended = run(std::string(command) + " --help");
    EXPECT_EQ(ended.status, 0);
    EXPECT_NE(ended.out.find("Example"), std::string::npos) << command;
  }
}

}  // namespace
}  // namespace adit::sim
