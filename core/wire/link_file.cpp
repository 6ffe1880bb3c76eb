// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link_file.hpp"

#include "core/config/node.hpp"
#include "core/config/search.hpp"

namespace adit::wire {

void read_link_keys(const config::Node& node, LinkProfile& link) {
  link.bandwidth = node.number("bandwidth", config::positive_up_to(1e10), link.bandwidth);
  link.latency = node.number("latency", config::within(0, 10), link.latency);
  link.loss = node.number("loss", config::within(0, 1), link.loss);
  link.range = node.number("range", config::within(0, 1e6), link.range);
  link.queue = node.number("queue", config::positive_up_to(10), link.queue);
  link.jitter = node.number("jitter", config::within(0, 10), link.jitter);
  link.burst = node.number("burst", config::within(1, 1000), link.burst);
  link.window = node.number("window", config::within(0, 10), link.window);
  link.frame = static_cast<std::uint32_t>(node.integer("frame", 200, 65000, link.frame));
  link.fading = node.number("fading", config::within(0, 10), link.fading);
  link.path_loss = node.number("path_loss", config::within(0, 200), link.path_loss);
  link.shadowing = node.number("shadowing", config::within(0, 40), link.shadowing);
  link.power = node.number("power", config::within(-50, 60), link.power);
  link.noise = node.number("noise", config::within(-150, 0), link.noise);
  link.wall = node.number("wall", config::within(0, 1000), link.wall);
}

Result<LinkProfile> load_link_file(const std::string& path) {
  auto file = config::load(path);
  if (!file) return file.error();
  const config::Node& root = *file;
  LinkProfile link;
  link.name = root.text("name");
  for (const char* key : {"bandwidth", "latency", "loss"}) (void)root.number(key, config::within(0, 1e10));
  read_link_keys(root, link);
  if (auto done = root.finish(); !done) return done.error();
  return link;
}

Result<LinkProfile> load_link(const std::string& name, const std::string& beside) {
  const auto path = config::find_named("links", name, beside);
  if (!path) return path.error();
  return load_link_file(*path);
}

}  // namespace adit::wire
