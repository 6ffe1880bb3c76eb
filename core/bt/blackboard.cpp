// SPDX-License-Identifier: Apache-2.0
#include "core/bt/blackboard.hpp"

namespace adit::bt {

Blackboard& Blackboard::outermost() {
  Blackboard* board = this;
  while (board->parent_) board = board->parent_;
  return *board;
}

Blackboard::Entry* Blackboard::find(std::string_view key) {
  if (key.starts_with('@')) return outermost().find(key.substr(1));
  if (const auto it = entries_.find(key); it != entries_.end()) return &it->second;
  if (!parent_) return nullptr;
  if (const auto it = outside_.find(key); it != outside_.end()) return parent_->find(it->second);
  if (autoremap_ && !key.starts_with('_')) return parent_->find(key);
  return nullptr;
}

Blackboard::Entry& Blackboard::declare(std::string_view key, PortType type) {
  if (key.starts_with('@')) return outermost().declare(key.substr(1), type);
  if (const auto it = entries_.find(key); it != entries_.end()) return it->second;
  if (parent_) {
    if (const auto it = outside_.find(key); it != outside_.end()) return parent_->declare(it->second, type);
    if (autoremap_ && !key.starts_with('_')) return parent_->declare(key, type);
  }
  return entries_.emplace(std::string(key), Entry{{}, type}).first->second;
}

void Blackboard::unset(std::string_view key) {
  if (const auto it = entries_.find(key); it != entries_.end()) entries_.erase(it);
}

void Blackboard::set(std::string_view key, BlackboardValue value) {
  Entry& entry = declare(key);
  if (is_text(value)) {
    switch (entry.type) {
      case PortType::integer:
      case PortType::natural:
        value = to_integer(value);
        break;
      case PortType::real:
        value = to_real(value);
        break;
      case PortType::boolean:
        value = static_cast<std::int64_t>(to_boolean(value));
        break;
      case PortType::status:
        to_status(value);
        break;
      case PortType::any:
      case PortType::text:
        break;
    }
  }
  entry.value = std::move(value);
}

}  // namespace adit::bt
