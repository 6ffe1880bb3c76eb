// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/settings_file.hpp"

#include <yaml-cpp/yaml.h>

#include <cstdio>

#include "core/command/words.hpp"

namespace adit::gui {
namespace {

constexpr std::size_t kMaxProblems = 20;
constexpr std::size_t kMaxShown = 40;

std::string line_of(const YAML::Mark& mark) { return "line " + std::to_string(mark.line + 1) + ": "; }

/// Takes one entry; returns what is wrong with it, or nothing.
std::string take(const std::string& key, const YAML::Node& value, SettingsValues& out) {
  const std::string text = value.IsScalar() ? command::clean(value.Scalar(), kMaxShown) : "a list";
  if (key == "theme") {
    if (!value.IsScalar() || (value.Scalar() != "dark" && value.Scalar() != "light"))
      return "theme is dark or light, not " + text;
    out.light = value.Scalar() == "light";
    return {};
  }
  if (key == "glove_mode") {
    if (!YAML::convert<bool>::decode(value, out.glove)) return "glove_mode is true or false, not " + text;
    return {};
  }
  if (key == "scale") {
    double scale = 0.0;
    const bool good = value.IsScalar() && YAML::convert<double>::decode(value, scale) &&
                      scale >= SettingsValues::kMinScale && scale <= SettingsValues::kMaxScale;
    if (!good) return "scale is a number from 0.6 to 2.5, not " + text;
    out.scale = scale;
    return {};
  }
  const std::string shown = command::clean(key, kMaxShown);
  const std::string meant = command::nearest(key, {"theme", "glove_mode", "scale"});
  return "unknown setting '" + shown + "'" + (meant.empty() ? "" : ", did you mean " + meant + "?");
}

}  // namespace

SettingsRead read_settings(const std::string& text) {
  SettingsRead read;
  try {
    const YAML::Node root = YAML::Load(text);
    if (root.IsNull()) return read;
    if (!root.IsMap()) {
      read.problems.push_back(line_of(root.Mark()) + "settings are lines 'name: value'");
      return read;
    }
    for (const auto& entry : root) {
      const std::string wrong = entry.first.IsScalar() ? take(entry.first.Scalar(), entry.second, read.values)
                                                       : "a name was expected";
      if (!wrong.empty() && read.problems.size() < kMaxProblems)
        read.problems.push_back(line_of(entry.first.Mark()) + wrong);
    }
  } catch (const YAML::Exception& error) {
    read.problems.push_back(line_of(error.mark) + command::clean(error.msg, 80));
  }
  return read;
}

std::string settings_text(const SettingsValues& values) {
  char scale[16] = {};
  std::snprintf(scale, sizeof scale, "%.2f", values.scale);
  return std::string("# The operator's window, see docs/gui.md. The window writes this file.\n") +
         "theme: " + (values.light ? "light" : "dark") +
         "\nglove_mode: " + (values.glove ? "true" : "false") + "\nscale: " + scale + "\n";
}

}  // namespace adit::gui
