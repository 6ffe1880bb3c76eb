// SPDX-License-Identifier: Apache-2.0
// Example 6: reading a recording.
//
//   example_read_recording FILE.mcap [PATH.csv]
//
// Prints each topic with its number of messages and its rate. With PATH.csv, also writes the paths of all
// robots in the recording, one line per RobotState: time (s), robot, x (m), y (m), yaw (rad), in the map
// frame.
//
// A message is stored as it passed the wire, in CDR, beside the IDL of its type: a program that knows the
// type decodes it as below, and other programs (Foxglove, the libraries of mcap.dev) decode it by the IDL.
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <map>

#include "adit/robot.h"
#include "core/record/mcap_reader.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"

namespace {

using namespace adit;

struct TopicRate {
  std::uint64_t messages{}, first{}, last{};  ///< ns
  void add(std::uint64_t time) {
    if (messages++ == 0) first = time;
    last = time;
  }
  /// Messages per second; 0 for a single message.
  double rate() const {
    return last > first ? static_cast<double>(messages - 1) * 1e9 / static_cast<double>(last - first) : 0.0;
  }
};

/// Whether a channel has what a robot said of itself. An agent records it as out/adit/robot_state, a
/// rehearsal as ROBOT/adit/robot_state (and, not wanted here, each delivery as
/// ROBOT/adit/robot_state>STATION).
bool is_robot_state(const record::Channel& channel) {
  return channel.topic.ends_with(std::string("/") + wire::topics::kRobotState.name) &&
         !channel.topic.starts_with("in/");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: example_read_recording FILE.mcap [PATH.csv]\n");
    return 2;
  }
  std::ifstream in(argv[1], std::ios::binary);
  if (!in) {
    std::fprintf(stderr, "cannot read %s\n", argv[1]);
    return 2;
  }
  std::ofstream csv;
  if (argc == 3) {
    csv.open(argv[2]);
    csv << std::fixed << std::setprecision(3) << "time,robot,x,y,yaw\n";
  }

  std::map<std::string, TopicRate> topics;
  std::uint64_t malformed = 0;
  record::Visitor visitor;
  visitor.message = [&](const record::Channel& channel, const record::Message& message) {
    topics[channel.topic].add(message.time);
    if (!csv.is_open() || !is_robot_state(channel)) return;
    radio::RobotState state;
    if (!wire::decode(message.data, state)) {
      ++malformed;
      return;
    }
    csv << static_cast<double>(message.time) * 1e-9 << ',' << state.robot() << ',' << state.x() << ','
        << state.y() << ',' << state.yaw() << '\n';
  };
  const auto report = record::read_mcap(in, visitor);
  if (!report) {
    std::fprintf(stderr, "%s: %s\n", argv[1], report.error().text.c_str());
    return 2;
  }

  std::printf("%10s %8s  %s\n", "messages", "rate/Hz", "topic");
  for (const auto& [topic, rate] : topics)
    std::printf("%10llu %8.2f  %s\n", static_cast<unsigned long long>(rate.messages), rate.rate(),
                topic.c_str());
  if (malformed > 0)
    std::printf("%llu messages do not fit their type\n", static_cast<unsigned long long>(malformed));
  if (csv.is_open() && !csv.flush()) {
    std::fprintf(stderr, "cannot write %s\n", argv[2]);
    return 2;
  }
  if (report->complete) return 0;
  // A recording that was torn off, by a crash for example, is read up to its last complete chunk.
  std::fprintf(stderr, "%s: %s\n", argv[1],
               report->trouble.empty() ? "it has no end" : report->trouble.c_str());
  return 1;
}
