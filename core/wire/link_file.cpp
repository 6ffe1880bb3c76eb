#include "core/wire/link_file.hpp"

#include "core/config/node.hpp"
#include "core/config/search.hpp"

namespace adit::wire {

Result<LinkProfile> load_link_file(const std::string& path) {
  auto file = config::load(path);
  if (!file) return file.error();
  const config::Node& root = *file;
  LinkProfile link;
  link.name = root.text("name");
  link.bandwidth = root.number("bandwidth", config::above(0, 1e10));
  link.latency = root.number("latency", config::within(0, 10));
  link.loss = root.number("loss", config::within(0, 1));
  link.range = root.number("range", config::within(0, 1e6), link.range);
  link.queue = root.number("queue", config::above(0, 10), link.queue);
  if (auto done = root.finish(); !done) return done.error();
  return link;
}

Result<LinkProfile> load_link(const std::string& name, const std::string& beside) {
  const auto path = config::find_named("links", name, beside);
  if (!path) return path.error();
  return load_link_file(*path);
}

}  // namespace adit::wire
