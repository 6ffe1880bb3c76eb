// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>

#include "core/transfer/source.hpp"

namespace adit::transfer {

/// Content for tests: numbered parts with a value that can change. A piece holds four bytes of each part: its
/// number and value.
class ToySource final : public Source {
 public:
  static constexpr std::size_t kPart = 4;

  void set(std::uint8_t part, std::uint8_t value) {
    values_[part] = value;
    for (auto& [id, lacks] : lacks_) lacks.insert(part);
  }
  std::size_t size() const { return values_.size(); }
  std::uint8_t value(std::uint8_t part) const { return values_.at(part); }
  std::size_t open_tokens() const { return flights_.size(); }

  Kind kind() const override { return Kind::map_blocks; }
  bool for_carriers() const override { return carried; }
  void join(const PeerId& peer) override {
    ++joins;
    lacks_[peer].clear();
    for (const auto& [part, value] : values_) lacks_[peer].insert(part);
  }
  void leave(const PeerId& peer) override { lacks_.erase(peer); }
  std::size_t missing(const PeerId& peer) const override {
    const auto found = lacks_.find(peer);
    return found == lacks_.end() ? 0 : found->second.size();
  }
  std::optional<Content> next(std::span<const PeerId> peers, std::size_t max_bytes, Time) override {
    Content out{++tokens_, {}};
    const std::set<std::uint8_t> wanted = lacks_.at(peers.front());
    for (const std::uint8_t part : wanted) {
      if (out.data.size() + kPart > max_bytes) break;
      out.data.insert(out.data.end(), {part, values_.at(part), 0, 0});
      flights_[tokens_][part] = values_.at(part);
      for (const PeerId& id : peers) lacks_.at(id).erase(part);
    }
    if (out.data.empty()) return std::nullopt;
    return out;
  }
  void acknowledged(const PeerId&, std::uint64_t) override {}
  void lost(const PeerId& peer, std::uint64_t token) override {
    ++losses;
    const auto found = lacks_.find(peer);
    if (found == lacks_.end()) return;
    for (const auto& [part, value] : flights_.at(token))
      if (values_.at(part) == value) found->second.insert(part);
  }
  void settled(std::uint64_t token) override { flights_.erase(token); }

  int joins{}, losses{};
  bool carried{true};

 private:
  std::map<std::uint8_t, std::uint8_t> values_{};
  std::map<PeerId, std::set<std::uint8_t>> lacks_{};
  std::map<std::uint64_t, std::map<std::uint8_t, std::uint8_t>> flights_{};
  std::uint64_t tokens_{};
};

}  // namespace adit::transfer
