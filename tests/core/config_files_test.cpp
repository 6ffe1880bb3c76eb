// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/config/platform_file.hpp"
#include "core/config/search.hpp"
#include "core/wire/link_file.hpp"
#include "tests/folders/folders.hpp"

namespace adit {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder for files below it.
struct Folder {
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
  fs::path path{scratch_folder()};
};

TEST(Platforms, the_three_standard_ones_have_the_documented_values) {
  struct Row {
    const char* name;
    double length, width, speed, turn, acceleration, step, lidar;
    bool holonomic, stairs;
  };
  for (const Row& row : {Row{"wheeled", 0.60, 0.50, 2.0, 1.5, 1.5, 0.08, 0.50, false, false},
                         Row{"tracked", 0.80, 0.60, 1.0, 1.0, 1.0, 0.15, 0.55, false, false},
                         Row{"legged", 0.90, 0.45, 1.2, 1.2, 1.5, 0.22, 0.65, true, true}}) {
    const auto p = config::load_platform(row.name);
    ASSERT_TRUE(p) << p.error().text;
    EXPECT_EQ(p->name, row.name);
    EXPECT_EQ(p->length, row.length);
    EXPECT_EQ(p->width, row.width);
    EXPECT_EQ(p->max_speed, row.speed);
    EXPECT_EQ(p->max_turn, row.turn);
    EXPECT_EQ(p->max_acceleration, row.acceleration);
    EXPECT_EQ(p->step, row.step);
    EXPECT_EQ(p->lidar_height, row.lidar);
    EXPECT_EQ(p->drive == Drive::holonomic, row.holonomic);
    EXPECT_EQ(p->stairs, row.stairs);
    EXPECT_TRUE(p->footprint.empty());
    EXPECT_EQ(p->planner, "trajectories");
    EXPECT_EQ(p->controller, "ilqr");
    EXPECT_FALSE(p->manual_collision_stop);
  }
}

TEST(Links, the_standard_ones_have_the_documented_values) {
  struct Row {
    const char* name;
    double bandwidth, latency, loss;
  };
  for (const Row& row :
       {Row{"lan", 100e6, 0.001, 0}, Row{"wifi", 20e6, 0.005, 0.01}, Row{"mesh_500k", 500e3, 0.05, 0.05},
        Row{"mesh_100k", 100e3, 0.15, 0.1}, Row{"loopback", 1e10, 0, 0}}) {
    const auto link = wire::load_link(row.name);
    ASSERT_TRUE(link) << link.error().text;
    EXPECT_EQ(link->name, row.name);
    EXPECT_EQ(link->bandwidth, row.bandwidth);
    EXPECT_EQ(link->latency, row.latency);
    EXPECT_EQ(link->loss, row.loss);
    EXPECT_EQ(link->range, 0);
  }
}

TEST(Platforms, wrong_files_name_file_line_and_expected_value) {
  const Folder folder;
  const std::string good =
      "name: x\ndrive: holonomic\nlength: 1\nwidth: 1\nmax_speed: 1\nmax_turn: 1\n"
      "max_acceleration: 1\nstep: 0\nlidar_height: 1\n";
  EXPECT_TRUE(config::load_platform_file(folder.write("good.yaml", good)));
  const std::string path = folder.write("r1.yaml", good + "max_sped: 2\n");
  const auto unknown = config::load_platform_file(path);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().text, path + ":10: unknown key 'max_sped', did you mean 'max_speed'?");
  const auto drive = config::load_platform_file(folder.write("d.yaml", "drive: hover\n"));
  ASSERT_FALSE(drive);
  EXPECT_THAT(
      drive.error().text,
      HasSubstr(
          "d.yaml:1: drive: expected one of differential, tracked, car, holonomic, aerial; got 'hover'"));
}

/// A platform file of nine lines and `more`.
Result<Platform> load(const std::string& drive, const std::string& more) {
  const Folder folder;
  return config::load_platform_file(folder.write(
      "p.yaml", "name: x\ndrive: " + drive + "\nlength: 1\nwidth: 1\nmax_speed: 1\nmax_turn: 1\n" +
                    "max_acceleration: 1\nstep: 0\nlidar_height: 1\n" + more));
}

TEST(Platforms, say_what_their_lidar_sees) {
  const auto usual = load("differential", "");
  EXPECT_EQ(usual->lidar_rings, 16);
  EXPECT_EQ(usual->lidar_lowest, -15.0);
  EXPECT_EQ(usual->lidar_highest, 15.0);
  const auto dome = load("differential", "lidar_rings: 32\nlidar_lowest: -50\nlidar_highest: 10\n");
  ASSERT_TRUE(dome) << dome.error().text;
  EXPECT_EQ(dome->lidar_rings, 32);
  EXPECT_EQ(dome->lidar_lowest, -50.0);
  EXPECT_EQ(dome->lidar_highest, 10.0);
  for (const char* bad :
       {"lidar_rings: 1\n", "lidar_rings: 1.5\n", "lidar_lowest: 5\n", "lidar_highest: 95\n"})
    EXPECT_THAT(load("differential", bad).error().text, HasSubstr("p.yaml:10: lidar_")) << bad;
}

TEST(Platforms, slip_is_a_matter_of_tracks) {
  const auto tracked = load("tracked", "turn_slip: 0.3\nturn_error: 0.02\n");
  ASSERT_TRUE(tracked) << tracked.error().text;
  EXPECT_EQ(tracked->drive, Drive::tracked);
  EXPECT_EQ(tracked->turn_slip, 0.3);
  EXPECT_EQ(tracked->turn_error, 0.02);
  EXPECT_EQ(load("tracked", "")->turn_slip, 0.0);
  EXPECT_THAT(load("tracked", "turn_slip: 0.9\n").error().text, HasSubstr("p.yaml:10: turn_slip: expected"));
  EXPECT_THAT(load("differential", "turn_slip: 0.1\n").error().text,
              HasSubstr("p.yaml:10: unknown key 'turn_slip'"));
}

TEST(Platforms, each_drive_has_its_own_keys) {
  const auto car = load("car", "wheelbase: 0.5\nmax_steering: 0.4\nsteering_rate: 2\n");
  ASSERT_TRUE(car) << car.error().text;
  EXPECT_FALSE(car->turns_on_spot());
  EXPECT_NEAR(car->least_radius(), 0.5 / std::tan(0.4), 1e-12);
  EXPECT_EQ(car->rear_axle(), 0.25);
  EXPECT_EQ(car->steering_rate, 2.0);
  EXPECT_THAT(load("car", "max_steering: 0.4\n").error().text, HasSubstr("wheelbase"));
  EXPECT_THAT(load("car", "wheelbase: 0.5\nmax_steering: 1.5\n").error().text,
              HasSubstr("p.yaml:11: max_steering: expected"));
  EXPECT_THAT(load("differential", "wheelbase: 1\n").error().text, HasSubstr("unknown key 'wheelbase'"));
  const auto aerial = load("aerial", "hover_height: 2\nmax_climb: 0.7\n");
  ASSERT_TRUE(aerial) << aerial.error().text;
  EXPECT_TRUE(aerial->flies() && aerial->sideways());
  EXPECT_EQ(aerial->hover_height, 2.0);
  EXPECT_EQ(aerial->max_climb, 0.7);
  EXPECT_THAT(load("aerial", "hover_height: -1\n").error().text,
              HasSubstr("p.yaml:10: hover_height: expected"));
  EXPECT_THAT(load("holonomic", "max_climb: 1\n").error().text, HasSubstr("unknown key 'max_climb'"));
  EXPECT_THAT(load("differential", "path_curvature: 9\n").error().text,
              HasSubstr("p.yaml:10: path_curvature: expected"));
}

TEST(Platforms, those_that_come_along_can_be_read) {
  for (const auto& [name, drive] : {std::pair{"car", Drive::car}, {"aerial", Drive::aerial}}) {
    const auto p = config::load_platform(name);
    ASSERT_TRUE(p) << p.error().text;
    EXPECT_EQ(p->name, name);
    EXPECT_EQ(p->drive, drive);
  }
}

TEST(Platforms, a_footprint_is_a_convex_polygon_around_base_link) {
  const Folder folder;
  const std::string good =
      "name: x\ndrive: holonomic\nlength: 1\nwidth: 1\nmax_speed: 1\nmax_turn: 1\n"
      "max_acceleration: 1\nstep: 0\nlidar_height: 1\nfootprint: ";
  const auto p =
      config::load_platform_file(folder.write("p.yaml", good + "[[0.5, 0], [-0.5, 0.4], [-0.5, -0.4]]\n"));
  ASSERT_TRUE(p) << p.error().text;
  ASSERT_EQ(p->footprint.size(), 3U);
  EXPECT_EQ(p->footprint[1], Eigen::Vector2d(-0.5, 0.4));
  for (const char* bad : {"[]", "[[0.5, 0], [-0.5, 0.4]]", "[[0.5, 0], [-0.5, -0.4], [-0.5, 0.4]]",
                          "[[0.6, 0], [-0.5, 0.4], [-0.5, -0.4]]", "[[0.5, 0], [0.4, 0.4], [0.4, -0.4]]",
                          "[[0.5, 0], [0, 0.1], [-0.5, 0.4], [-0.5, -0.4]]", "[[0.5], [0, 1], [0, 0]]",
                          "[[.nan, 0], [-0.5, 0.4], [-0.5, -0.4]]", "7", "[a, b, c]"}) {
    const auto wrong = config::load_platform_file(folder.write("bad.yaml", good + bad + "\n"));
    ASSERT_FALSE(wrong) << bad;
    EXPECT_THAT(wrong.error().text, HasSubstr("bad.yaml:10: ")) << bad;
  }
}

TEST(Links, wrong_files_are_errors) {
  const Folder folder;
  const auto link =
      wire::load_link_file(folder.write("l.yaml", "name: l\nbandwidth: 1e6\nlatency: 0.1\nloss: 5\n"));
  ASSERT_FALSE(link);
  EXPECT_THAT(link.error().text, HasSubstr("l.yaml:4: loss: expected a number in [0, 1], got '5'"));
  const std::string good = "name: l\nbandwidth: 1e6\nlatency: 0.1\nloss: 0\n";
  ASSERT_TRUE(wire::load_link_file(folder.write("good.yaml", good)));
  for (const char* bad :
       {"jitter: -1", "burst: 0.5", "window: 11", "frame: 100", "frame: 1.5", "frame: 70000", "fading: 11",
        "path_loss: -1", "shadowing: 41", "power: 61", "noise: 1", "wall: -1", "queue: 0", "range: far",
        "burst: [1]", "bursts: 2", "jitter: .nan"}) {
    const auto wrong = wire::load_link_file(folder.write("bad.yaml", good + bad + "\n"));
    ASSERT_FALSE(wrong) << bad;
    EXPECT_THAT(wrong.error().text, HasSubstr("bad.yaml:5: ")) << bad;
  }
  for (const char* missing :
       {"name: l\nlatency: 0\nloss: 0\n", "name: l\nbandwidth: 1\nloss: 0\n", "name: l\n"})
    EXPECT_FALSE(wire::load_link_file(folder.write("less.yaml", missing))) << missing;
}

TEST(Links, a_mines_radio_has_the_public_simulators_numbers) {
  const auto link = wire::load_link("subt");
  ASSERT_TRUE(link) << link.error().text;
  EXPECT_EQ(link->window, 1.0);
  EXPECT_EQ(link->frame_bytes(), 1500U);
  EXPECT_EQ(link->fading, 2.5);
  EXPECT_EQ(link->range, 50.0);
}

TEST(Search, looks_beside_the_file_first_and_names_the_searched_folders) {
  const Folder folder;
  const std::string own = folder.write("platforms/wheeled.yaml", "name: own\n");
  const std::string beside = folder.write("scenario.yaml", "");
  EXPECT_EQ(config::find_file("platforms/wheeled.yaml", beside).value(), own);
  const auto elsewhere = config::find_file("platforms/tracked.yaml", beside);
  ASSERT_TRUE(elsewhere);
  EXPECT_THAT(*elsewhere, HasSubstr("config/platforms/tracked.yaml"));
  const auto none = config::load_platform("flying", beside);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().reason, Reason::cannot_read);
  EXPECT_THAT(none.error().text, HasSubstr("no 'flying' in config/platforms; there are: "));
  EXPECT_THAT(none.error().text, HasSubstr("legged, "));
}

TEST(Search, the_environment_comes_before_the_source_tree) {
  const Folder folder;
  const std::string own = folder.write("links/wifi.yaml", "");
  ::setenv("ADIT_CONFIG", ("/nonexistent:" + folder.path.string()).c_str(), 1);
  const auto found = config::find_file("links/wifi.yaml");
  ::unsetenv("ADIT_CONFIG");
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, own);
}

}  // namespace
}  // namespace adit
