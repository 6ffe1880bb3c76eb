// SPDX-License-Identifier: Apache-2.0
// What passes a wire, on a record sink; and a rehearsal's simulated network, in a file.
#include "adit/command.h"
#include "adit/discovery.h"
#include "core/exec/virtual_runtime.hpp"
#include "core/record/frame_recorder.hpp"
#include "core/record/idl_schema.hpp"
#include "core/record/recording_log.hpp"
#include "core/record/recording_participant.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "tests/live/process.hpp"
#include "tests/record/small.hpp"

#include <fstream>

namespace adit::record {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class MemorySink final : public RecordSink {
 public:
  ChannelId channel(const ChannelInfo& info) override {
    for (std::size_t i = 0; i < channels.size(); ++i)
      if (channels[i] == info) return static_cast<ChannelId>(i);
    channels.push_back(info);
    return static_cast<ChannelId>(channels.size() - 1);
  }
  void record(ChannelId channel, ByteSpan cdr) override {
    topics.push_back(channels.at(channel).topic);
    samples.emplace_back(cdr.begin(), cdr.end());
  }
  void release(ChannelId) override { ++released; }
  int released{};
  std::vector<ChannelInfo> channels{};
  std::vector<std::string> topics{};
  std::vector<std::vector<std::uint8_t>> samples{};
};

TEST(IdlSchema, EveryTopicHasOne) {
  namespace t = wire::topics;
  const wire::TopicInfo* all[] = {
      &t::kCapabilities, &t::kPresence,  &t::kCommand, &t::kJoystick,   &t::kAcknowledgement, &t::kAuthority,
      &t::kRobotState,   &t::kBehaviour, &t::kHealth,  &t::kLinkReport, &t::kNotification,    &t::kCmdVel,
      &t::kOdom,         &t::kPoints,    &t::kBattery, &t::kRoute};
  for (const wire::TopicInfo* topic : all) {
    const auto schema = idl_schema(topic->type);
    ASSERT_TRUE(schema.has_value()) << topic->type;
    EXPECT_THAT(schema->text, HasSubstr("struct " + schema->name.substr(schema->name.rfind(':') + 1)));
    EXPECT_THAT(schema->text, testing::Not(HasSubstr("#include")));
  }
}

TEST(IdlSchema, GuardsOfFilesThatAreIncludedTwiceAreLeftOut) {
  const auto schema = idl_schema("vision_msgs::msg::dds_::Detection3DArray_");
  ASSERT_TRUE(schema);
  EXPECT_EQ(schema->text.find('#'), std::string::npos);
  EXPECT_EQ(schema->text.find("struct Pose "), schema->text.rfind("struct Pose "));
}

TEST(IdlSchema, IncludesComeOnceAndFirst) {
  const auto schema = idl_schema("nav_msgs::msg::dds_::Odometry_");
  ASSERT_TRUE(schema.has_value());
  EXPECT_EQ(schema->name, "nav_msgs::msg::Odometry");
  const std::size_t vector = schema->text.find("struct Vector3");
  EXPECT_LT(vector, schema->text.find("struct Twist "));
  EXPECT_EQ(schema->text.find("struct Vector3", vector + 1), std::string::npos);
}

TEST(IdlSchema, UnknownTypesHaveNone) {
  for (const char* type : {"", "adit::radio::Nothing", "Command", "adit::radio::CommandKind"})
    EXPECT_FALSE(idl_schema(type).has_value()) << type;
}

class Air : public testing::Test {
 protected:
  Air() : op_(network_.join(77, "op1")), r1_(network_.join(77, "r1")) {}
  void pass(Duration time) { scheduler_.run_until(scheduler_.elapsed() + time); }
  std::shared_ptr<Executor> strand(const std::string& name) {
    machines_.push_back(scheduler_.machine(name, 0ms));
    return machines_.back()->strand(name);
  }

  VirtualScheduler scheduler_{1};
  wire::SimulatedNetwork network_{scheduler_, {.link = {.latency = 0.0001}}};
  std::vector<std::unique_ptr<Runtime>> machines_{};
  std::unique_ptr<wire::Participant> op_, r1_;
  MemorySink sink_{};
};

TEST_F(Air, BothDirectionsAreRecorded) {
  RecordingParticipant op(*op_, sink_, "radio"), r1(*r1_, sink_, "radio");
  const auto own = strand("r1");
  int heard = 0;
  const auto reader = wire::make_reader(
      r1, wire::topics::kCommand, *own, [&](const radio::Command&, const wire::SampleInfo&) { ++heard; },
      "r1");
  auto writer = wire::Writer<radio::Command>::make(op, wire::topics::kCommand, "r1");
  pass(2s);
  EXPECT_EQ(writer->matched(), 1U);
  radio::Command command;
  command.robot("r1");
  ASSERT_TRUE(writer->write(command));
  pass(1s);
  EXPECT_EQ(heard, 1);
  EXPECT_THAT(sink_.topics, ElementsAre("out/adit/command", "in/adit/command"));
  EXPECT_EQ(sink_.samples.at(0), sink_.samples.at(1));
  EXPECT_EQ(sink_.channels.at(0).metadata.at("partition"), "r1");
  EXPECT_EQ(sink_.channels.at(1).metadata.at("from"), wire::to_string(op_->id()));
  EXPECT_EQ(sink_.channels.at(1).metadata.at("net"), "radio");
}

TEST_F(Air, ListsUndecodableFramesApart) {
  RecordingParticipant r1(*r1_, sink_, "radio");
  const auto own = strand("r1");
  const auto reader = wire::make_reader(r1, wire::topics::kPresence, *own,
                                        [](const radio::Presence&, const wire::SampleInfo&) {});
  auto writer = op_->make_writer(wire::topics::kPresence, "");
  pass(2s);
  // Its key can be read, its id is cut off.
  ASSERT_TRUE((*writer)->write(std::vector<std::uint8_t>{0, 1, 0, 0, 2, 0, 0, 0, 'a', 0}));
  pass(1s);
  EXPECT_THAT(sink_.topics, ElementsAre("in/adit/presence/malformed"));
  EXPECT_TRUE(sink_.channels.back().metadata.contains(kMalformedKey));
}

TEST_F(Air, APeerThatSendsRubbishDoesNotWashTheRingAway) {
  RecordingParticipant r1(*r1_, sink_, "radio");
  const auto own = strand("r1");
  auto reader = wire::make_reader(r1, wire::topics::kPresence, *own,
                                  [](const radio::Presence&, const wire::SampleInfo&) {});
  auto writer = op_->make_writer(wire::topics::kPresence, "");
  pass(2s);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE((*writer)->write(std::vector<std::uint8_t>{0, 1, 0, 0, 2, 0, 0, 0, 'a', 0}));
    pass(1ms);
  }
  EXPECT_GE(sink_.topics.size(), 32U);
  EXPECT_LE(sink_.topics.size(), 40U);
  EXPECT_EQ(sink_.channels.size(), 1U);
  EXPECT_EQ(sink_.released, 0) << "one channel, not one a sample";
  const auto before = sink_.topics.size();
  pass(10s);
  ASSERT_TRUE((*writer)->write(std::vector<std::uint8_t>{0, 1, 0, 0, 2, 0, 0, 0, 'a', 0}));
  pass(1s);
  EXPECT_EQ(sink_.topics.size(), before + 1);
  reader = Error{Reason::none, {}};
  EXPECT_EQ(sink_.released, 1);
}

TEST_F(Air, ASampleThatBreaksItsReceiverIsThere) {
  RecordingParticipant r1(*r1_, sink_, "radio");
  const auto own = strand("r1");
  const auto reader = wire::make_reader(
      r1, wire::topics::kPresence, *own,
      [](const radio::Presence&, const wire::SampleInfo&) { throw std::runtime_error("x"); });
  auto writer = wire::Writer<radio::Presence>::make(*op_, wire::topics::kPresence);
  pass(2s);
  ASSERT_TRUE(writer->write(radio::Presence{}));
  pass(1s);
  EXPECT_THAT(sink_.topics, ElementsAre("in/adit/presence"));
}

TEST_F(Air, EachSenderHasItsChannel) {
  RecordingParticipant r1(*r1_, sink_, "radio");
  const auto own = strand("r1");
  const auto reader = wire::make_reader(r1, wire::topics::kPresence, *own,
                                        [](const radio::Presence&, const wire::SampleInfo&) {});
  for (int i = 0; i < 34; ++i) {
    const auto other = network_.join(77, "other" + std::to_string(i));
    auto writer = wire::Writer<radio::Presence>::make(*other, wire::topics::kPresence);
    pass(2s);
    ASSERT_TRUE(writer->write(radio::Presence{}));
    pass(1s);
  }
  EXPECT_EQ(sink_.channels.size(), 34U);
  EXPECT_EQ(sink_.released, 2) << "32 are kept; of more, those that were silent longest are given up";
}

TEST_F(Air, RehearsalIsOneFileWithSendersAndReceivers) {
  const live::Folder folder;
  const std::string file = folder.path() + "/run.mcap";
  auto recorder = FrameRecorder::open({.file = file, .about = {{"seed", "1"}}});
  ASSERT_TRUE(recorder);
  network_.set_tap([&](const wire::SampleEvent& frame) { (*recorder)->see(frame); });
  const auto own = strand("r1");
  const auto reader = wire::make_reader(*r1_, wire::topics::kPresence, *own,
                                        [](const radio::Presence&, const wire::SampleInfo&) {});
  auto writer = wire::Writer<radio::Presence>::make(*op_, wire::topics::kPresence);
  pass(2s);
  ASSERT_TRUE(writer->write(radio::Presence{}));
  pass(1s);
  network_.cut("op1", "r1", true);
  ASSERT_TRUE(writer->write(radio::Presence{}));
  pass(1s);
  ASSERT_TRUE((*recorder)->close());
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const Heard heard = hear(bytes_of(bytes)).value();
  EXPECT_TRUE(heard.report.complete) << heard.report.trouble;
  std::vector<std::string> topics;
  for (const Channel& channel : heard.channels) topics.push_back(channel.topic);
  EXPECT_THAT(topics, ElementsAre("op1/adit/presence", "op1/adit/presence>r1", "op1/adit/presence>r1/lost"));
  EXPECT_EQ(heard.channels.at(1).metadata.at("from"), "op1");
  EXPECT_EQ(heard.channels.at(1).metadata.at("to"), "r1");
  EXPECT_EQ(heard.schemas.at(1).name, "adit::radio::Presence");
  EXPECT_EQ(heard.metadata.at("adit").at("seed"), "1");
}

TEST(RecordingLog, LinesGoBothWays) {
  MemorySink record_sink;
  const auto inner = std::make_shared<MemoryLog>();
  const auto sink = std::make_shared<RecordingLog>(inner, record_sink);
  Log(sink, "r1/mux").warn("odd");
  ASSERT_EQ(record_sink.samples.size(), 1U);
  EXPECT_THAT(inner->lines(), ElementsAre(HasSubstr("odd")));
  const std::string bytes(record_sink.samples[0].begin(), record_sink.samples[0].end());
  EXPECT_THAT(bytes, HasSubstr(std::string("odd\0", 4)));
  EXPECT_THAT(bytes, HasSubstr("r1/mux"));
}

TEST(FrameRecorder, AFileThatCannotBeWrittenIsAnError) {
  EXPECT_EQ(FrameRecorder::open({.file = "/proc/nowhere/run.mcap"}).reason(), Reason::cannot_write);
}

}  // namespace
}  // namespace adit::record
