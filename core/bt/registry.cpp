// SPDX-License-Identifier: Apache-2.0
#include "core/bt/registry.hpp"

#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

Registry::Registry() {
  add_sequences(*this);
  add_reactive(*this);
  add_parallel(*this);
  add_branches(*this);
  add_switches(*this);
  add_try_catch(*this);
  add_decorators(*this);
  add_loops(*this);
  add_timed(*this);
  add_actions(*this);
  add_scripted(*this);
}

const Manifest* Registry::find(std::string_view id) const {
  const auto it = manifests_.find(id);
  return it == manifests_.end() ? nullptr : &it->second;
}

Result<void> Registry::add(Manifest manifest) {
  const std::string id = manifest.id;
  if (!manifests_.emplace(id, std::move(manifest)).second) {
    return Error{Reason::in_use, "node '" + id + "' is registered already"};
  }
  return {};
}

Result<void> Registry::add_action(std::string id, LeafFunction function, Ports ports) {
  return add({std::move(id), NodeKind::action, std::move(ports), 0, 0,
              [function](NodeConfig config) { return make_function_leaf(std::move(config), function); }});
}

Result<void> Registry::add_condition(std::string id, LeafFunction function, Ports ports) {
  return add({std::move(id), NodeKind::condition, std::move(ports), 0, 0,
              [function](NodeConfig config) { return make_function_leaf(std::move(config), function); }});
}

Result<void> Registry::add_stateful(std::string id, StatefulFactory factory, Ports ports) {
  return add({std::move(id), NodeKind::action, std::move(ports), 0, 0, [factory](NodeConfig config) {
                auto code = factory(config);
                return make_stateful_leaf(std::move(config), std::move(code));
              }});
}

}  // namespace adit::bt
