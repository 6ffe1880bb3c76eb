// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tests/wire/nets.hpp"
#include "tests/wire/samples.hpp"

namespace adit::bench {

using wire::Example;

/// Called on the member's strand with each capabilities sample.
using Heard = std::function<void(const radio::Capabilities&)>;

/// Writes what an idle robot or station writes, and reads what it reads.
struct Idle {
  Idle(std::unique_ptr<wire::Participant> w, std::shared_ptr<Executor> s)
      : wire(std::move(w)), strand(std::move(s)) {}

  void write(const wire::TopicInfo& topic, const std::string& partition, Duration period) {
    auto writer = std::shared_ptr<wire::RawWriter>(std::move(wire->make_writer(topic, partition)).value());
    (topic.qos == wire::QosClass::urgent && !partition.empty() ? commands : writers).push_back(writer);
    for (const Example& e : wire::examples()) {
      if (std::string(e.topic.name) != topic.name || period == 0ms) continue;
      (void)writer->write(e.bytes);
      strand->post([this, writer, bytes = e.bytes, period] {
        timers.push_back(strand->every(period, [writer, bytes] { (void)writer->write(bytes); }));
      });
    }
  }
  void read(const wire::TopicInfo& topic, const std::string& partition) {
    readers.push_back(
        std::move(wire->make_reader(topic, partition, *strand, [](auto, const wire::SampleInfo&) {
          return true;
        })).value());
  }
  void read_capabilities(Heard heard) {
    readers.push_back(
        std::move(wire::make_reader(
                      *wire, wire::topics::kCapabilities, *strand,
                      [heard = std::move(heard)](const radio::Capabilities& sample, const wire::SampleInfo&) {
                        if (heard) heard(sample);
                      }))
            .value());
  }
  /// Publishes identity and capabilities, stored for participants that join later.
  void write_capabilities(const std::string& name, const std::string& software) {
    radio::Capabilities sample;
    sample.name(name);
    sample.software(software);
    std::vector<std::uint8_t> bytes;
    wire::encode(sample, bytes);
    writers.emplace_back(std::move(wire->make_writer(wire::topics::kCapabilities, "")).value());
    (void)writers.back()->write(bytes);
  }

  std::unique_ptr<wire::Participant> wire;
  std::shared_ptr<Executor> strand;
  std::vector<std::shared_ptr<wire::RawWriter>> writers{}, commands{};
  std::vector<std::unique_ptr<wire::RawReader>> readers{};
  std::vector<Timer> timers{};
};

template <class Net>
std::unique_ptr<Idle> robot(Net& net, const std::string& name, Heard heard = {},
                            const std::string& software = "") {
  using namespace wire;
  auto idle = std::make_unique<Idle>(net.join(name), net.strand(name));
  idle->write_capabilities(name, software);
  idle->write(topics::kRobotState, "", 100ms);
  idle->write(topics::kAuthority, "", 1s);
  idle->write(topics::kBehaviour, "", 1s);
  idle->write(topics::kHealth, "", 5s);
  idle->write(topics::kLinkReport, "", 2s);
  idle->write(topics::kNotification, "", 1h);
  idle->write(topics::kAcknowledgement, "", 0ms);
  idle->read(topics::kCommand, name);
  idle->read(topics::kJoystick, name);
  idle->read(topics::kPresence, "");
  idle->read_capabilities(std::move(heard));
  return idle;
}

template <class Net>
std::unique_ptr<Idle> station(Net& net, const std::string& name, int robots, Heard heard = {},
                              const std::string& software = "") {
  using namespace wire;
  auto idle = std::make_unique<Idle>(net.join(name), net.strand(name));
  idle->write_capabilities(name, software);
  idle->write(topics::kPresence, "", 1s);
  idle->write(topics::kLinkReport, "", 2s);
  for (int i = 0; i < robots; ++i) {
    idle->write(topics::kCommand, "r" + std::to_string(i), 0ms);
    idle->write(topics::kJoystick, "r" + std::to_string(i), 0ms);
  }
  for (const TopicInfo& topic :
       {TopicInfo(topics::kRobotState), TopicInfo(topics::kAuthority), TopicInfo(topics::kBehaviour),
        TopicInfo(topics::kHealth), TopicInfo(topics::kLinkReport), TopicInfo(topics::kNotification),
        TopicInfo(topics::kAcknowledgement)}) {
    idle->read(topic, "");
  }
  idle->read_capabilities(std::move(heard));
  return idle;
}

}  // namespace adit::bench
