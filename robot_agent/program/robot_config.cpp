#include "robot_agent/program/robot_config.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "core/config/node.hpp"
#include "core/config/platform_file.hpp"
#include "core/config/search.hpp"
#include "core/wire/link_file.hpp"
#include "robot_agent/agent.hpp"

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

void read_link_loss(const config::Node& node, LinkLossParams& loss) {
  static const std::array<std::pair<const char*, OnLoss>, 3> actions{
      {{"continue", OnLoss::go_on}, {"hold", OnLoss::hold}, {"return", OnLoss::back}}};
  if (node.has("on_link_loss")) {
    const std::string name = node.text("on_link_loss");
    const auto* action =
        std::find_if(actions.begin(), actions.end(), [&](const auto& a) { return a.first == name; });
    if (action == actions.end())
      node.child("on_link_loss").fail(Reason::out_of_range, "expected continue, hold or return");
    else
      loss.action = action->second;
  }
  loss.after = from_seconds(node.number("link_loss_after", config::within(1.0, 3600.0), seconds(loss.after)));
}

void read_battery(const config::Node& node, RobotConfig& c) {
  const auto battery = node.child_if("battery");
  if (!battery.present()) return;
  c.battery.warning = battery.number("warning", config::within(0.0, 1.0), c.battery.warning);
  c.battery.low = battery.number("low", config::within(0.0, 1.0), c.battery.low);
  c.battery.last = battery.number("last", config::within(0.0, 1.0), c.battery.last);
  if (c.battery.warning < c.battery.low || c.battery.low < c.battery.last)
    battery.fail(Reason::out_of_range, "expected warning >= low >= last");
  if (!battery.has("at_last")) return;
  const std::string last = battery.text("at_last");
  c.return_at_last_battery = last == "return";
  if (last != "hold" && last != "return")
    battery.child("at_last").fail(Reason::out_of_range, "expected hold or return");
}

/// A tree that is missing stays as it was written: the agent starts, holds and reports it.
std::string find_tree(const std::string& tree, const std::string& beside) {
  const auto found = config::find_file(tree, beside);
  return found ? std::filesystem::absolute(*found).lexically_normal().string() : tree;
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

void read_robot_keys(const config::Node& node, const std::string& file, RobotConfig& c) {
  if (node.has("cmd_vel")) {
    const std::string velocity = node.text("cmd_vel");
    c.velocity = velocity == "twist" ? VelocityType::twist : VelocityType::twist_stamped;
    if (velocity != "twist" && velocity != "twist_stamped")
      node.child("cmd_vel").fail(Reason::out_of_range, "expected twist or twist_stamped");
  }
  c.lock_lease = from_seconds(node.number("lock_lease", config::within(0.0, 1e6), seconds(c.lock_lease)));
  if (node.has("tree")) c.tree = find_tree(node.text("tree"), file);
  read_link_loss(node, c.link_loss);
  read_battery(node, c);
  if (node.has("after_restart")) {
    const std::string after = node.text("after_restart");
    c.resume_after_restart = after == "resume";
    if (after != "resume" && after != "hold")
      node.child("after_restart").fail(Reason::out_of_range, "expected resume or hold");
  }
}

AgentParams agent_params(const RobotConfig& config) {
  AgentParams params{};
  params.name = config.name;
  params.platform = config.platform;
  params.start = config.start;
  params.lock_lease = config.lock_lease;
  params.tree = config.tree;
  params.link_loss = config.link_loss;
  params.battery = config.battery;
  params.velocity = config.velocity;
  params.return_at_last_battery = config.return_at_last_battery;
  params.resume_after_restart = config.resume_after_restart;
  return params;
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
  c.memory_limit = root->number("memory_limit", config::within(0.0, 1e6), c.memory_limit);
  read_robot_keys(*root, file, c);
  if (!root->has("tree")) c.tree = find_tree(c.tree, file);
  c.state = root->text("state", "");
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
