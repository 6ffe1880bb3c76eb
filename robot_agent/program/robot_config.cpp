// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/robot_config.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>

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

/// Whether the interfaces exist is checked when the robot domain is opened, because a robot's file is also
/// read on other computers.
void read_interfaces(const config::Node& root, RobotInterfaces& interfaces) {
  if (!root.has("robot_interfaces")) return;
  const config::Node node = root.child("robot_interfaces");
  interfaces.where = node.where();
  for (const config::Node& entry : node.as_list()) {
    interfaces.names.push_back(entry.as_text());
    const std::string& name = interfaces.names.back();
    const bool is_name = !name.empty() && name.size() < IFNAMSIZ && name.find_first_of("/ \t") == name.npos;
    if (!is_name)
      entry.fail(Reason::out_of_range, "robot_interfaces: expected names of network interfaces, as eth1");
  }
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

void read_battery(const config::Node& node, SafeguardParams& c) {
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

bool is_topic(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
  };
  return !name.empty() && name.size() <= 128 && name.front() != '/' && std::ranges::all_of(name, plain);
}

/// Up to four different names of topics.
std::vector<std::string> read_topics(const config::Node& node, const std::vector<std::string>& usual) {
  constexpr std::size_t kMaxTopics = 4;
  std::vector<std::string> topics = node.texts("topics", usual), sorted = topics;
  std::ranges::sort(sorted);
  if (topics.size() > kMaxTopics || !std::ranges::all_of(topics, is_topic) ||
      std::ranges::adjacent_find(sorted) != sorted.end())
    node.child("topics").fail(Reason::out_of_range,
                              "topics: expected at most 4 different names without a slash in front");
  return topics;
}

/// @param other  The importance of other kinds; null: the key `default` is unknown.
void read_importance(const config::Node& node, std::map<std::string, std::uint8_t>& of_kinds,
                     std::uint8_t* other) {
  const auto importance = node.child_if("importance");
  if (!importance.present()) return;
  for (const auto& [kind, value] : importance.entries()) {
    const auto number = static_cast<std::uint8_t>(value.as_integer(0, 255));
    if (other != nullptr && kind == "default")
      *other = number;
    else
      of_kinds[kind_of(kind)] = number;
  }
}

void read_detections(const config::Node& node, DetectionParams& c) {
  const auto detections = node.child_if("detections");
  if (!detections.present()) return;
  c.topics = read_topics(detections, c.topics);
  c.min_score = detections.number("min_score", config::within(0.0, 1.0), c.min_score);
  c.sightings = static_cast<int>(detections.integer("sightings", 1, 100, c.sightings));
  read_importance(detections, c.importance, &c.default_importance);
}

void read_objects(const config::Node& node, const std::string& beside, RobotConfig& c) {
  const auto objects = node.child_if("objects");
  if (!objects.present()) return;
  ObjectsParams out;
  perception::DetectorParams& detector = out.detector;
  // A missing file stays as it was written: the agent starts and reports it.
  const auto path = [&](const char* key) {
    const std::string given = objects.text(key, "");
    const auto found = config::find_file(given, beside);
    return given.empty() || !found ? given : std::filesystem::absolute(*found).lexically_normal().string();
  };
  detector.model = path("model");
  detector.labels = path("labels");
  if (detector.model.empty() != detector.labels.empty())
    objects.fail(Reason::missing_key,
                 "a model needs labels, a file with one class a line, and labels a model");
  detector.min_score = objects.number("min_score", config::within(0.0, 1.0), detector.min_score);
  detector.mean = objects.number("mean", config::within(0.0, 255.0), detector.mean);
  detector.scale = objects.number("scale", config::within(1e-6, 10.0), detector.scale);
  out.period = from_seconds(objects.number("period", config::within(1.0, 60.0), seconds(out.period)));
  out.report.sightings = static_cast<int>(objects.integer("sightings", 1, 100, out.report.sightings));
  read_importance(objects, out.report.importance, &out.report.default_importance);
  c.objects = std::move(out);
}

void read_reports(const config::Node& node, ReportParams& c) {
  const auto reports = node.child_if("reports");
  if (!reports.present()) return;
  c.topics = read_topics(reports, c.topics);
  read_importance(reports, c.importance, nullptr);
}

/// The path of a missing tree stays as it was written: the agent starts, holds and reports the error.
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

Result<std::vector<std::string>> addresses_of(const RobotInterfaces& interfaces) {
  std::vector<std::string> addresses{"127.0.0.1"};
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) first = nullptr;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(first, &::freeifaddrs);
  for (const std::string& name : interfaces.names) {
    bool known = false, usable = false;
    for (const ifaddrs* at = all.get(); at != nullptr; at = at->ifa_next) {
      if (name != at->ifa_name) continue;
      known = true;
      if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
      if ((at->ifa_flags & IFF_RUNNING) == 0) continue;
      char text[INET_ADDRSTRLEN]{};
      const auto* address = reinterpret_cast<const sockaddr_in*>(at->ifa_addr);
      if (::inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) == nullptr) continue;
      usable = true;
      if (std::find(addresses.begin(), addresses.end(), text) == addresses.end())
        addresses.emplace_back(text);
    }
    if (usable) continue;
    return Error{Reason::bad_argument,
                 interfaces.where + ": robot_interfaces: " +
                     (known ? "'" + name + "' is down or has no IPv4 address"
                            : "this machine has no interface '" + name + "'; see ip link")};
  }
  return addresses;
}

void read_robot_keys(const config::Node& node, const std::string& file, RobotConfig& c) {
  if (node.has("cmd_vel")) {
    const std::string velocity = node.text("cmd_vel");
    c.velocity = velocity == "twist" ? VelocityType::twist : VelocityType::twist_stamped;
    if (velocity != "twist" && velocity != "twist_stamped")
      node.child("cmd_vel").fail(Reason::out_of_range, "expected twist or twist_stamped");
  }
  if (node.has("perception"))
    c.perception = static_cast<PerceptionLevel>(node.choice("perception", kPerceptionWords));
  if (const auto map = node.child_if("map"); map.present()) c.carry_maps = map.flag("carry", false);
  read_detections(node, c.detections);
  read_objects(node, file, c);
  read_reports(node, c.reports);
  if (node.has("start_height")) c.start_height = node.number("start_height", config::within(-1e5, 1e5));
  c.lock_lease = from_seconds(node.number("lock_lease", config::within(0.0, 1e6), seconds(c.lock_lease)));
  if (node.has("tree")) c.tree = find_tree(node.text("tree"), file);
  read_link_loss(node, c.safeguards.link_loss);
  read_battery(node, c.safeguards);
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
  params.start_height = config.start_height.value_or(0.0);
  params.lock_lease = config.lock_lease;
  params.tree = config.tree;
  params.safeguards = config.safeguards;
  params.velocity = config.velocity;
  params.perception = config.perception;
  params.carry_maps = config.carry_maps;
  params.detections = config.detections;
  params.objects = config.objects;
  params.reports = config.reports;
  params.resume_after_restart = config.resume_after_restart;
  return params;
}

Result<RobotConfig> load_robot_config(const std::string& file) {
  auto root = config::load(file);
  if (!root) return root.error();
  RobotConfig c;
  c.name = root->text("name");
  if (!c.name.empty() && !command::valid_robot_name(c.name))
    root->child("name").fail(Reason::out_of_range, std::string("expected ") + command::kRobotName);
  const std::string platform = root->text("platform");
  const std::vector<double> pose = root->numbers("pose", 3, 3, config::within(-1e6, 1e6), {0.0, 0.0, 0.0});
  c.start = {pose[0], pose[1], wrap_angle(pose[2])};
  if (const auto radio = root->child_if("radio"); radio.present()) read_radio(radio, file, c.radio);
  c.robot_domain = static_cast<std::uint32_t>(root->integer("robot_domain", 0, 232, 0));
  read_interfaces(*root, c.robot_interfaces);
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
  if (c.objects && c.platform.cameras.empty())
    return Error{Reason::bad_argument,
                 file + ": objects: the platform " + platform + " has no camera in `sensors`"};
  c.radio.name = c.name;
  return c;
}

}  // namespace adit::agent
