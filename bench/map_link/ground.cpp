// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/ground.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "sim/world/generate.hpp"
#include "tests/folders/folders.hpp"

namespace adit::bench {
namespace {

constexpr double kBody = 0.5;     ///< Free around the robot, m.
constexpr double kLedge = 0.25;   ///< Between neighbouring ground, m.
constexpr double kCeiling = 3.0;  ///< Of generated worlds, m.

}  // namespace

double Ground::height(const Eigen::Vector2d& at) const {
  const auto found = world.ground_height(at.x(), at.y(), kHeadroom);
  return found ? *found : 0.0;
}

bool Ground::can_stand(const Eigen::Vector2d& at, double z) const {
  for (int i = 0; i < 8; ++i) {
    const double a = i * std::numbers::pi / 4;
    const auto ground =
        world.ground_height(at.x() + kBody * std::cos(a), at.y() + kBody * std::sin(a), kHeadroom);
    if (!ground || std::abs(*ground - z) > kLedge) return false;
  }
  return true;
}

Result<std::filesystem::path> building_file() {
  const std::array<std::filesystem::path, 3> folders{source_folder() + "/data/maps",
                                                     source_folder() + "/config",
                                                     "/usr/share/doc/liboctomap-dev/examples/data"};
  return sim::find_map("geb079.bt", folders);
}

Result<Ground> make_ground(std::string_view name, std::uint64_t seed) {
  if (name == "geb079") {
    const auto file = building_file();
    if (!file) return file.error();
    auto loaded = sim::load_octomap(*file);
    if (!loaded) return loaded.error();
    return Ground{std::move(*loaded), {4.0, -0.2}};
  }
  Result<sim::GeneratedWorld> made = name == "streets"
                                         ? Result<sim::GeneratedWorld>(sim::generate_blocks(9, seed))
                                         : sim::generate_world(name, seed);
  if (!made) return made.error();
  auto boxes = sim::make_box_world(made->boxes, 0.0, kCeiling);
  if (!boxes) return boxes.error();
  return Ground{std::move(*boxes), made->start};
}

}  // namespace adit::bench
