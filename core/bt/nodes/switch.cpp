// SPDX-License-Identifier: Apache-2.0
// Switch2 to Switch6: run the child whose case equals a variable, else the last one.
#include <charconv>
#include <cmath>
#include <limits>

#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

template <class T>
std::optional<T> leading_number(const std::string& text) {
  T out{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc()) return std::nullopt;
  return out;
}

std::optional<std::int64_t> integer(const std::string& text, const Enums& enums) {
  if (const auto it = enums.find(text); it != enums.end()) return it->second;
  const auto number = leading_number<int>(text);
  return number ? std::optional<std::int64_t>(*number) : std::nullopt;
}

/// Whether two texts are equal: as texts, else as integers or enums, else as numbers.
bool same(const std::string& a, const std::string& b, const Enums& enums) {
  if (a == b) return true;
  const auto int_a = integer(a, enums), int_b = integer(b, enums);
  if (int_a && int_b && *int_a == *int_b) return true;
  const auto real_a = leading_number<double>(a), real_b = leading_number<double>(b);
  return real_a && real_b &&
         std::abs(*real_a - *real_b) <= static_cast<double>(std::numeric_limits<float>::epsilon());
}

class Switch : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    const std::size_t chosen = choose();
    if (running_ && *running_ != chosen) reset_child(*running_);
    const NodeStatus answer = tick_child(child(chosen));
    if (answer == NodeStatus::running) {
      running_ = chosen;
      return answer;
    }
    running_.reset();
    if (answer != NodeStatus::skipped) reset_children();
    return answer;
  }

  void halt() override {
    running_.reset();
    TreeNode::halt();
  }

 private:
  /// Text of a port; nothing when the port is not given or its entry does not exist yet.
  std::optional<std::string> text_of(const std::string& port_name) const {
    try {
      return port<std::string>(port_name);
    } catch (const NodeError&) {
      return std::nullopt;  // Without a variable no case matches: the node then runs the default child.
    }
  }
  std::size_t choose() const {
    const std::size_t otherwise = children().size() - 1;
    const auto variable = text_of("variable");
    for (std::size_t i = 0; variable && i < otherwise; ++i) {
      const auto value = text_of("case_" + std::to_string(i + 1));
      if (value && same(*variable, *value, context().enums)) return i;
    }
    return otherwise;
  }
  std::optional<std::size_t> running_{};
};

}  // namespace

void add_switches(Registry& registry) {
  for (std::size_t cases = 2; cases <= 6; ++cases) {
    Ports ports{input("variable", PortType::text)};
    for (std::size_t i = 1; i <= cases; ++i)
      ports.push_back(input("case_" + std::to_string(i), PortType::text));
    (void)registry.add(control<Switch>("Switch" + std::to_string(cases), ports, cases + 1, cases + 1));
  }
}

}  // namespace adit::bt
