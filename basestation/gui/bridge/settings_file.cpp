// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/settings_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/command/words.hpp"

namespace adit::gui {
namespace {

constexpr std::size_t kMaxProblems = 20;
constexpr std::size_t kMaxShown = 40;

std::string line_of(const YAML::Mark& mark) { return "line " + std::to_string(mark.line + 1) + ": "; }

/// Takes the section `pad`: actions, and the buttons or axes for them.
void take_pad(const YAML::Node& section, SettingsRead& read) {
  using station::input::PadAction;
  const auto wrong = [&](const YAML::Node& at, const std::string& why) {
    if (read.problems.size() < kMaxProblems) read.problems.push_back(line_of(at.Mark()) + why);
  };
  if (!section.IsMap()) {
    if (!section.IsNull()) wrong(section, "pad has lines 'action: button'");
    return;
  }
  const auto names = station::input::pad_action_names();
  std::array<int, station::input::kPadActions> lines{};
  for (const auto& entry : section) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    const auto at = std::ranges::find(names, key);
    if (at == names.end()) {
      const std::string meant = command::nearest(key, {names.begin(), names.end()});
      wrong(entry.first, "unknown action of the pad '" + command::clean(key, kMaxShown) + "'" +
                             (meant.empty() ? "" : ", did you mean " + meant + "?"));
      continue;
    }
    const auto index = static_cast<std::size_t>(at - names.begin());
    lines[index] = entry.first.Mark().line + 1;
    const auto set =
        read.pad.set(PadAction(index), entry.second.IsScalar() ? entry.second.Scalar() : "a list");
    if (!set) wrong(entry.first, set.error().text);
  }
  for (const auto& clash : read.pad.resolve()) {
    const auto keeps = static_cast<std::size_t>(clash.keeps), loses = static_cast<std::size_t>(clash.loses);
    const int line = std::max(lines[keeps], lines[loses]);
    if (read.problems.size() < kMaxProblems)
      read.problems.push_back("line " + std::to_string(line) + ": " + clash.input + " is " +
                              std::string(names[keeps]) + " already: " + std::string(names[loses]) +
                              " is none");
  }
  if (const bool clashed = !read.problems.empty(); clashed && read.pad == station::input::PadMapping{})
    read.problems.push_back("the controller has its default mapping");
}

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
  const std::string meant = command::nearest(key, {"theme", "glove_mode", "scale", "pad"});
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
      if (entry.first.IsScalar() && entry.first.Scalar() == "pad") {
        take_pad(entry.second, read);
        continue;
      }
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

std::string settings_text(const SettingsValues& values, const station::input::PadMapping& pad) {
  char scale[16] = {};
  std::snprintf(scale, sizeof scale, "%.2f", values.scale);
  std::string text = std::string("# The operator's window, see docs/gui.md. The window writes this file.\n") +
                     "theme: " + (values.light ? "light" : "dark") +
                     "\nglove_mode: " + (values.glove ? "true" : "false") + "\nscale: " + scale + "\n";
  const station::input::PadMapping usual;
  const auto names = station::input::pad_action_names();
  if (pad != usual) text += "pad:\n";
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto& input = pad.of(station::input::PadAction(i));
        input != usual.of(station::input::PadAction(i)))
      text += "  " + std::string(names[i]) + ": " + name_of(input) + "\n";
  return text;
}

}  // namespace adit::gui
