// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "sim/world/pgm.hpp"
#include "sim/world/read_file.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {
namespace {

struct FloorPlan {
  std::string image{};
  double resolution{};
  double origin_x{};
  double origin_y{};
  bool negate{};
  double occupied_thresh{};
  double free_thresh{};
};

Error at(const YAML::Node& node, const std::string& name, Reason reason, const std::string& text) {
  return {reason, fmt::format("{}:{}: {}", name, node.Mark().line + 1, text)};
}

Result<double> number(const YAML::Node& root, const std::string& name, const char* key, double low,
                      double high) {
  const YAML::Node node = root[key];
  if (!node) return Error{Reason::missing_key, fmt::format("{}: missing key `{}`", name, key)};
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value))
    return at(node, name, Reason::wrong_type, fmt::format("{}: expected a number", key));
  if (!(value >= low && value <= high))
    return at(node, name, Reason::out_of_range, fmt::format("{}: expected {} to {}", key, low, high));
  return value;
}

Result<FloorPlan> parse(const YAML::Node& root, const std::string& name) {
  if (!root.IsMap())
    return at(root, name, Reason::wrong_type, "expected the keys of a map_server floor plan");
  for (const auto& entry : root) {
    const std::string key = entry.first.as<std::string>();
    bool known = false;
    for (const char* k :
         {"image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"})
      known = known || key == k;
    if (!known) return at(entry.first, name, Reason::unknown_key, "unknown key `" + key + "`");
  }
  FloorPlan plan;
  const YAML::Node image = root["image"], origin = root["origin"], mode = root["mode"];
  if (!image) return Error{Reason::missing_key, name + ": missing key `image`"};
  if (!image.IsScalar()) return at(image, name, Reason::wrong_type, "image: expected a file name");
  plan.image = image.Scalar();
  if (mode && (!mode.IsScalar() || mode.Scalar() != "trinary"))
    return at(mode, name, Reason::not_supported, "mode: expected trinary");
  if (!origin) return Error{Reason::missing_key, name + ": missing key `origin`"};
  double pose[3] = {};
  bool numbers = origin.IsSequence() && origin.size() == 3;
  for (int n = 0; numbers && n < 3; ++n)
    numbers =
        origin[n].IsScalar() && YAML::convert<double>::decode(origin[n], pose[n]) && std::abs(pose[n]) < 1e5;
  if (!numbers) return at(origin, name, Reason::wrong_type, "origin: expected [x, y, yaw]");
  if (pose[2] != 0.0)
    return at(origin, name, Reason::not_supported, "origin: a rotated plan is not supported");
  plan.origin_x = pose[0];
  plan.origin_y = pose[1];
  const struct {
    const char* key;
    double low, high;
    double* out;
  } numbers_of[] = {{"resolution", 0.005, 1.0, &plan.resolution},
                    {"occupied_thresh", 0.0, 1.0, &plan.occupied_thresh},
                    {"free_thresh", 0.0, 1.0, &plan.free_thresh}};
  for (const auto& row : numbers_of) {
    const Result<double> value = number(root, name, row.key, row.low, row.high);
    if (!value) return value.error();
    *row.out = *value;
  }
  const Result<double> negate = number(root, name, "negate", 0.0, 1.0);
  if (!negate) return negate.error();
  plan.negate = *negate != 0.0;
  return plan;
}

Result<FloorPlan> read_plan(const std::string& content, const std::string& name) {
  try {
    return parse(YAML::Load(content), name);
  } catch (const YAML::Exception& e) {
    return {Reason::syntax, fmt::format("{}:{}: {}", name, e.mark.line + 1, e.msg)};
  }
}

}  // namespace

Result<World> load_floor_plan(const std::filesystem::path& file, double ceiling) {
  const Result<std::string> content = read_file(file);
  if (!content) return content.error();
  const Result<FloorPlan> plan = read_plan(*content, file.string());
  if (!plan) return plan.error();
  const std::filesystem::path picture = file.parent_path() / plan->image;
  const Result<std::string> pixels = read_file(picture);
  if (!pixels) return pixels.error();
  const Result<GreyImage> image = parse_pgm(*pixels, picture.string());
  if (!image) return image.error();

  VoxelGrid grid({plan->origin_x, plan->origin_y}, plan->resolution, image->width, image->height,
                 {0.0, ceiling}, false);
  for (int row = 0; row < image->height; ++row)
    for (int i = 0; i < image->width; ++i) {
      const int value = image->pixels[static_cast<std::size_t>(row) * image->width + i];
      const double occupancy = (plan->negate ? value : 255 - value) / 255.0;
      const bool free = occupancy <= plan->occupied_thresh && occupancy < plan->free_thresh;
      grid.set(i, image->height - 1 - row, 0, !free);
    }
  grid.build();
  return World(file.filename().string(), std::move(grid));
}

}  // namespace adit::sim
