// SPDX-License-Identifier: Apache-2.0
// The accessors by key: each finds the key's node and reads it as the requested type.
#include "core/config/node.hpp"

namespace adit::config {

double Node::number(std::string_view key, Range range) const { return child(key).as_number(range); }
double Node::number(std::string_view key, Range range, double fallback) const {
  const Node node = child_if(key);
  return node.present() ? node.as_number(range) : fallback;
}

std::int64_t Node::integer(std::string_view key, std::int64_t min, std::int64_t max) const {
  return child(key).as_integer(min, max);
}
std::int64_t Node::integer(std::string_view key, std::int64_t min, std::int64_t max,
                           std::int64_t fallback) const {
  const Node node = child_if(key);
  return node.present() ? node.as_integer(min, max) : fallback;
}

bool Node::flag(std::string_view key) const { return child(key).as_flag(); }
bool Node::flag(std::string_view key, bool fallback) const {
  const Node node = child_if(key);
  return node.present() ? node.as_flag() : fallback;
}

std::string Node::text(std::string_view key) const {
  const Node node = child(key);
  return node.present() ? node.as_text() : std::string{};
}
std::string Node::text(std::string_view key, std::string fallback) const {
  const Node node = child_if(key);
  return node.present() ? node.as_text() : std::move(fallback);
}

std::size_t Node::choice(std::string_view key, const std::vector<std::string>& words) const {
  return child(key).as_choice(words);
}
std::size_t Node::choice(std::string_view key, const std::vector<std::string>& words,
                         std::size_t fallback) const {
  const Node node = child_if(key);
  return node.present() ? node.as_choice(words) : fallback;
}

std::vector<double> Node::numbers(std::string_view key, std::size_t min_count, std::size_t max_count,
                                  Range range) const {
  return child(key).as_numbers(min_count, max_count, range);
}
std::vector<double> Node::numbers(std::string_view key, std::size_t min_count, std::size_t max_count,
                                  Range range, std::vector<double> fallback) const {
  const Node node = child_if(key);
  return node.present() ? node.as_numbers(min_count, max_count, range) : std::move(fallback);
}

std::vector<std::string> Node::texts(std::string_view key) const {
  std::vector<std::string> out;
  for (const Node& node : child(key).as_list()) out.push_back(node.as_text());
  return out;
}
std::vector<std::string> Node::texts(std::string_view key, std::vector<std::string> fallback) const {
  return child_if(key).present() ? texts(key) : std::move(fallback);
}

std::vector<Node> Node::list(std::string_view key) const { return child(key).as_list(); }
std::vector<Node> Node::list_if(std::string_view key) const { return child_if(key).as_list(); }

}  // namespace adit::config
