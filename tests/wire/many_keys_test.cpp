// SPDX-License-Identifier: Apache-2.0
// Keys of topics over a long mission: peers come under new names for days, and the newest is heard.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/wire/topics.hpp"
#include "tests/wire/keyed_sample.hpp"
#include "tests/wire/nets.hpp"

namespace adit::wire {
namespace {

TEST(ManyKeys, AStationIsHeardAfter300OthersCameAndLeft) {
  LiveNet net;
  const auto strand = net.strand("test");
  const auto robot = net.join("r1");
  Seen<std::string> status, state;
  const auto hear = [&](const TopicInfo& topic, Seen<std::string>& seen) {
    return std::move(robot->make_reader(topic, "", *strand,
                                        [&seen](auto bytes, const SampleInfo&) {
                                          seen.add(reinterpret_cast<const char*>(bytes.data()) + 8);
                                          return true;
                                        }))
        .value();
  };
  const auto a = hear(topics::kCapabilities, status), b = hear(topics::kPresence, state);
  const auto last_is = [](const Seen<std::string>& seen, const std::string& name) {
    const auto all = seen.all();
    return std::find(all.rbegin(), all.rend(), name) != all.rend();
  };
  for (int i = 1; i <= 301; ++i) {
    const std::string name = "station" + std::to_string(i);
    const auto station = net.join(name);
    const auto capabilities = std::move(station->make_writer(topics::kCapabilities, "")).value();
    const auto presence = std::move(station->make_writer(topics::kPresence, "")).value();
    ASSERT_TRUE(capabilities->write(keyed(name)).ok());
    ASSERT_TRUE(net.until([&] { return presence->write(keyed(name)).ok() && last_is(state, name); })) << name;
    ASSERT_TRUE(net.until([&] { return last_is(status, name); })) << name;
  }
}

}  // namespace
}  // namespace adit::wire
