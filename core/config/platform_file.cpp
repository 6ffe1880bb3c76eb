#include "core/config/platform_file.hpp"

#include "core/config/node.hpp"
#include "core/config/search.hpp"

namespace adit::config {

Result<Platform> load_platform_file(const std::string& path) {
  auto file = load(path);
  if (!file) return file.error();
  const Node& root = *file;
  Platform p;
  p.name = root.text("name");
  p.drive = root.choice("drive", {"differential", "holonomic"}) == 0 ? Drive::differential : Drive::holonomic;
  p.length = root.number("length", above(0, 5));
  p.width = root.number("width", above(0, 5));
  p.height = root.number("height", above(0, 5), p.height);
  p.max_speed = root.number("max_speed", above(0, 10));
  p.max_turn = root.number("max_turn", above(0, 10));
  p.max_acceleration = root.number("max_acceleration", above(0, 20));
  p.max_turn_acceleration = root.number("max_turn_acceleration", above(0, 50), p.max_turn_acceleration);
  p.step = root.number("step", within(0, 1));
  p.lidar_height = root.number("lidar_height", above(0, 5));
  p.stairs = root.flag("stairs", false);
  p.controller = root.text("controller", p.controller);
  if (auto done = root.finish(); !done) return done.error();
  return p;
}

Result<Platform> load_platform(const std::string& name, const std::string& beside) {
  const auto path = find_named("platforms", name, beside);
  if (!path) return path.error();
  return load_platform_file(*path);
}

}  // namespace adit::config
