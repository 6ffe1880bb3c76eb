#include "robot_agent/program/robot_config.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "core/config/node.hpp"
#include "core/config/platform_file.hpp"
#include "core/config/search.hpp"
#include "core/wire/link_file.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {
namespace {

void read_radio(const config::Node& node, const std::string& file, wire::FastDdsParams& radio) {
  radio.domain = static_cast<std::uint32_t>(node.integer("domain", 0, 232, radio.domain));
  radio.interfaces = node.texts("interfaces", {});
  radio.peers = node.texts("peers", {});
  radio.multicast = node.flag("multicast", radio.multicast);
  if (!node.has("link")) return;
  auto link = wire::load_link(node.text("link"), file);
  if (link)
    radio.link = std::move(*link);
  else
    node.child("link").fail(link.error().reason, link.error().text);
}

void read_safeguards(const config::Node& root, RobotConfig& c) {
  const std::string loss = root.text("on_link_loss", "continue");
  c.link_loss.action = loss == "hold" ? OnLoss::hold : loss == "return" ? OnLoss::back : OnLoss::go_on;
  if (loss != "continue" && loss != "hold" && loss != "return")
    root.child("on_link_loss").fail(Reason::out_of_range, "expected continue, hold or return");
  c.link_loss.after = from_seconds(root.number("link_loss_after", config::within(1.0, 3600.0), 10.0));
  const auto battery = root.child_if("battery");
  if (!battery.present()) return;
  c.battery.warning = battery.number("warning", config::within(0.0, 1.0), c.battery.warning);
  c.battery.low = battery.number("low", config::within(0.0, 1.0), c.battery.low);
  c.battery.last = battery.number("last", config::within(0.0, 1.0), c.battery.last);
  if (c.battery.warning < c.battery.low || c.battery.low < c.battery.last)
    battery.fail(Reason::out_of_range, "expected warning >= low >= last");
  const std::string last = battery.text("at_last", "hold");
  c.return_at_last_battery = last == "return";
  if (last != "hold" && last != "return")
    battery.child("at_last").fail(Reason::out_of_range, "expected hold or return");
}

}  // namespace

std::string state_folder(const RobotConfig& config) {
  if (config.state == "none") return {};
  if (!config.state.empty()) return config.state;
  const auto below = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::string(value ? value : "");
  };
  std::string base = below("XDG_STATE_HOME");
  if (base.empty()) base = ::geteuid() == 0 ? "/var/lib" : below("HOME") + "/.local/state";
  return base + "/adit/robot-" + config.name;
}

Result<RobotConfig> load_robot_config(const std::string& file) {
  auto root = config::load(file);
  if (!root) return root.error();
  RobotConfig c;
  c.name = root->text("name");
  if (!c.name.empty() && !valid_name(c.name))
    root->child("name").fail(Reason::out_of_range, "expected 1 to 32 of [A-Za-z0-9_-]");
  const std::string platform = root->text("platform");
  const std::vector<double> pose = root->numbers("pose", 3, 3, config::within(-1e6, 1e6), {0.0, 0.0, 0.0});
  c.start = {pose[0], pose[1], wrap_angle(pose[2])};
  if (const auto radio = root->child_if("radio"); radio.present()) read_radio(radio, file, c.radio);
  c.robot_domain = static_cast<std::uint32_t>(root->integer("robot_domain", 0, 232, 0));
  const std::string velocity = root->text("cmd_vel", "twist");
  c.velocity = velocity == "twist" ? VelocityType::twist : VelocityType::twist_stamped;
  if (velocity != "twist" && velocity != "twist_stamped")
    root->child("cmd_vel").fail(Reason::out_of_range, "expected twist or twist_stamped");
  c.lock_lease = from_seconds(root->number("lock_lease", config::within(0.0, 1e6), 300.0));
  c.memory_limit = root->number("memory_limit", config::within(0.0, 1e6), c.memory_limit);
  c.tree = root->text("tree", c.tree);
  if (auto tree = config::find_file(c.tree, file))
    c.tree = std::filesystem::absolute(*tree).lexically_normal().string();
  else if (root->has("tree"))
    root->child("tree").fail(tree.error().reason, tree.error().text);
  else
    return tree.error();
  read_safeguards(*root, c);
  c.state = root->text("state", "");
  const std::string after = root->text("after_restart", "resume");
  c.resume_after_restart = after == "resume";
  if (after != "resume" && after != "hold")
    root->child("after_restart").fail(Reason::out_of_range, "expected resume or hold");
  c.record = root->text("record", "");
  if (!level_from_name(root->text("log", "info"), c.log))
    root->child("log").fail(Reason::out_of_range, "expected trace, debug, info, warn, error or off");
  if (const auto read = root->finish(); !read) return read.error();
  auto loaded = config::load_platform(platform, file);
  if (!loaded) return loaded.error();
  c.platform = *loaded;
  c.radio.name = c.name;
  return c;
}

}  // namespace adit::agent
