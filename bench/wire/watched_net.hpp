// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/wire/participant.hpp"
#include "tests/live/net.hpp"

namespace adit::bench {

/// From the first time that a sample was written to the first time that it was handed to a reader, by topic.
/// A repeated command is one sample.
class Passages {
 public:
  /// What a sample is called beside its topic; empty: the topic's name alone.
  using Naming = std::function<std::string(const std::string& topic, std::span<const std::uint8_t>)>;
  explicit Passages(Naming naming) : naming_(std::move(naming)) {}

  struct Row {
    std::uint64_t written{}, arrived{};
    std::vector<double> took{};  ///< s
  };
  void written(const std::string& topic, std::span<const std::uint8_t> cdr, Duration at);
  void arrived(const std::string& topic, std::span<const std::uint8_t> cdr, Duration at);
  /// By name; samples count from when `counting` is set.
  std::map<std::string, Row> rows() const;
  void count(bool counting);

 private:
  struct Sample {
    std::string name{};
    Duration at{};
    bool arrived{};
  };
  Naming naming_;
  mutable std::mutex mutex_{};
  bool counting_{};
  std::map<std::pair<std::string, std::uint64_t>, Sample> samples_{};  // by topic and content
  std::map<std::string, Row> rows_{};
};

/// A net whose radio participants report every message.
class WatchedNet final : public live::Net {
 public:
  WatchedNet(std::unique_ptr<live::Net> inner, Passages& passages)
      : inner_(std::move(inner)), passages_(passages) {}
  Runtime& machine(const std::string& name) override { return inner_->machine(name); }
  std::unique_ptr<wire::Participant> join_radio(const std::string& machine) override;
  std::unique_ptr<wire::Participant> join_robot(const std::string& machine) override {
    return inner_->join_robot(machine);
  }
  void silence(const std::string& machine) override { inner_->silence(machine); }
  void on(Executor& strand, const std::function<void()>& work) override { inner_->on(strand, work); }
  Duration clock() const override { return inner_->clock(); }
  bool until(const std::function<bool()>& condition, Duration limit) override {
    return inner_->until(condition, limit);
  }
  void pass(Duration time) override { inner_->pass(time); }

 private:
  std::unique_ptr<live::Net> inner_;
  Passages& passages_;
};

}  // namespace adit::bench
