// SPDX-License-Identifier: Apache-2.0
// Pictures of a driver reach a station over a link: live ones in stripes, single ones whole.
#include <gmock/gmock.h>

#include <fstream>

#include "adit/camera.h"
#include "adit/robot.h"
#include "basestation/model/camera_bytes.hpp"
#include "basestation/station/station.hpp"
#include "perception/camera/picture.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;
using testing::HasSubstr;

const wire::LinkProfile kMesh{.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15, .loss = 0.1};
const wire::LinkProfile kWifi{.name = "wifi", .bandwidth = 20e6, .latency = 0.005, .loss = 0.01};

/// A scene that changes with `step`: fine texture, with a bright square.
perception::Picture drawn(std::uint32_t width, std::uint32_t height, std::uint32_t step) {
  perception::Picture out{.width = width, .height = height, .channels = 3};
  out.bytes.resize(std::size_t{3} * width * height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::uint32_t wave = ((x + 3 * step) / 8 + y / 8) % 4 * 20 + 60;
      std::uint8_t* pixel = &out.bytes[3 * (std::size_t{y} * width + x)];
      pixel[0] = static_cast<std::uint8_t>(wave);
      pixel[1] = static_cast<std::uint8_t>(wave + x * 80 / width);
      pixel[2] = static_cast<std::uint8_t>(wave + y * 80 / height);
    }
  return out;
}

/// One of a few pictures of the scene, as a JPEG: drawing each one again would take most of a test's time.
const std::vector<std::uint8_t>& scene(std::uint32_t step) {
  static const std::vector<std::vector<std::uint8_t>> all = [] {
    std::vector<std::vector<std::uint8_t>> out;
    for (std::uint32_t i = 0; i < 6; ++i) out.push_back(perception::encode_jpeg(drawn(640, 480, i), 90));
    return out;
  }();
  return all[step % all.size()];
}

class Cameras : public testing::Test {
 protected:
  void begin(const wire::LinkProfile& link, std::vector<CameraConfig> cameras = {CameraConfig{}}) {
    AgentParams params;
    params.start = {10.0, 0.0, M_PI / 2};
    params.platform.cameras = std::move(cameras);
    bench = std::make_unique<AgentBench>(std::move(params), 1, source_folder() + "/config/trees/robot.xml",
                                         AgentBench::Wrap{}, link);
    driver = bench->network().join(100, "driver");
    compressed = wire::Writer<CompressedImage>::make(*driver, wire::topics::kCompressedImage).value();
    pictures = bench->strand().every(50ms, [this] { send(); });
    radio = bench->network().join(77, "op1");
    station::StationParams op;
    op.id[0] = 9;
    station = std::make_unique<station::Station>(op, bench->strand(), *radio);
    ASSERT_TRUE(station->start().ok());
    bench->run(6s);
  }
  ~Cameras() override {
    station.reset();
    radio.reset();
    compressed = {};
    driver.reset();
  }
  void stamp(std_msgs::msg::Header& header) const {
    const auto ns = (bench->strand().now() + clock).time_since_epoch().count();
    if (!stamps) return;
    header.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  void send() {
    if (!sends) return;
    CompressedImage message;
    stamp(message.header());
    message.format("rgb8; jpeg compressed bgr8");
    if (moves || step == 0) ++step;
    message.data(scene(step));
    if (spoil) spoil(message);
    (void)compressed.write(message);
  }
  station::Outcome execute(const std::string& line) {
    auto ended = std::make_shared<std::optional<station::Outcome>>();
    station->execute(line, [ended](const station::Outcome& outcome) { *ended = outcome; });
    for (int i = 0; i < 3000 && !*ended; ++i) bench->run(20ms);
    return ended->value_or(station::Outcome{.exit_code = -1, .error = "it did not end"});
  }
  /// Takes each picture that comes within the time.
  std::vector<station::CameraPicture> watch(Duration time, std::uint16_t width = 640) {
    std::vector<station::CameraPicture> out;
    const Duration end = bench->elapsed() + time;
    auto waits = std::make_shared<bool>(false);
    while (bench->elapsed() < end) {
      if (!*waits) {
        *waits = true;
        (void)station->cameras().look("r1", "front", width, 15.0F);
        station->cameras().next("r1", "front", out.empty() ? 0 : out.back().number,
                                [&out, waits](const station::CameraPicture& picture) {
                                  *waits = false;
                                  if (picture.number != 0) out.push_back(picture);
                                });
      }
      bench->run(10ms);
    }
    while (*waits) bench->run(10ms);
    return out;
  }
  /// What the robot has sent so far on the radio's topic of live pictures.
  std::uint64_t sent(std::uint64_t wire::TopicCount::*what) const {
    std::uint64_t sum = 0;
    for (const auto& count : bench->radio().counters().topics)
      if (count.topic == wire::topics::kCamera.name) sum += count.*what;
    return sum;
  }
  std::uint64_t pieces() const { return sent(&wire::TopicCount::samples_out); }
  std::uint64_t bytes() const { return sent(&wire::TopicCount::bytes_out); }

  std::unique_ptr<AgentBench> bench{};
  std::unique_ptr<wire::Participant> driver{}, radio{};
  wire::Writer<CompressedImage> compressed{};
  std::unique_ptr<station::Station> station{};
  Timer pictures{};
  bool sends{true}, stamps{true}, moves{true};
  Duration clock{};
  std::uint32_t step{};
  std::function<void(CompressedImage&)> spoil{};
};

TEST_F(Cameras, FifteenPicturesASecondOverWifi) {
  begin(kWifi);
  (void)watch(6s);
  const auto shown = watch(2s);
  EXPECT_GE(shown.size(), 28U) << "of 640x480";
  EXPECT_EQ(shown.back().width, 640U);
  EXPECT_EQ(shown.back().height, 480U);
  EXPECT_LT(shown.back().age, 0.25);
  ASSERT_EQ(shown.back().pose.size(), 7U);
  EXPECT_NEAR(shown.back().pose[0], 10.0F, 0.01F);
  const auto pixels = perception::decode_jpeg_tolerant(shown.back().jpeg, 640, 480);
  ASSERT_TRUE(pixels.ok());
  EXPECT_EQ(pixels->channels, 3);
}

TEST_F(Cameras, OnePictureASecondOverAThinLinkThatLoses) {
  begin(kMesh);
  (void)watch(5s);
  const auto shown = watch(20s);
  EXPECT_GE(shown.size(), 20U);
  EXPECT_GE(shown.back().width, 160U);
  EXPECT_LT(shown.back().age, 2.5);
}

TEST_F(Cameras, NothingIsSentWhereNoOneLooks) {
  begin(kWifi);
  EXPECT_EQ(pieces(), 0U);
  EXPECT_EQ(compressed.matched(), 0U) << "the driver's topic is not read";
  EXPECT_FALSE(watch(2s).empty());
  EXPECT_GT(pieces(), 0U);
  bench->run(5s);
  const auto sent = pieces();
  EXPECT_EQ(compressed.matched(), 0U);
  bench->run(5s);
  EXPECT_EQ(pieces(), sent);
}

TEST_F(Cameras, AStillSceneCostsLittle) {
  begin(kWifi);
  (void)watch(8s);
  const auto moving = pieces();
  (void)watch(4s);
  const auto moved = pieces() - moving;
  moves = false;
  (void)watch(2s);
  const auto still = pieces();
  (void)watch(4s);
  EXPECT_LT((pieces() - still) * 5, moved);
}

TEST_F(Cameras, ASinglePictureComesWholeWithItsPlace) {
  begin(kMesh);
  moves = false;
  const std::string file = scratch_folder() + "/shot.jpg";
  spoil = [](CompressedImage& message) { message.data(perception::encode_jpeg(drawn(320, 240, 1), 60)); };
  const auto outcome = execute("camera r1 shot " + file);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(outcome.text, HasSubstr("robot at 10.0 0.0"));
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(bytes, perception::encode_jpeg(drawn(320, 240, 1), 60)) << "the driver's own bytes";
}

TEST_F(Cameras, CommandsSwitchThemOnAndOff) {
  begin(kWifi);
  EXPECT_THAT(execute("cameras").text, HasSubstr("off"));
  const auto on = execute("camera r1 on");
  EXPECT_EQ(on.exit_code, 0) << on.error;
  EXPECT_THAT(on.text, HasSubstr("camera front is on"));
  bench->run(10s);
  EXPECT_THAT(execute("cameras r1").text, HasSubstr("640x480")) << "it stays on without a front end";
  EXPECT_EQ(execute("camera r1 off").exit_code, 0);
  bench->run(4s);
  const auto sent = pieces();
  bench->run(3s);
  EXPECT_EQ(pieces(), sent);
  EXPECT_THAT(execute("camera r1 on back").error, HasSubstr("its cameras are front"));
  EXPECT_THAT(execute("camera r9 on").error, HasSubstr("r9"));
}

TEST_F(Cameras, WhatAFrontEndShowsLessOfIsAskedForLess) {
  begin(kWifi);
  ASSERT_EQ(execute("camera r1 on").exit_code, 0);
  (void)watch(4s);
  EXPECT_EQ(watch(1s).back().width, 640U);
  (void)watch(4s, 160);
  const auto small = watch(1s, 160);
  ASSERT_FALSE(small.empty());
  EXPECT_EQ(small.back().width, 160U) << "the large one is not shown any more";
  bench->run(8s);
  EXPECT_THAT(execute("cameras r1").text, HasSubstr("640x480")) << "it is on, and no front end shows it";
}

TEST_F(Cameras, ACameraWithoutPicturesIsReported) {
  begin(kWifi);
  sends = false;
  const auto on = execute("camera r1 on");
  EXPECT_EQ(on.exit_code, 1);
  EXPECT_THAT(on.error, HasSubstr("no picture came yet"));
  bench->run(2s);
  EXPECT_THAT(execute("health r1").text, HasSubstr("its driver sends no pictures"));
}

TEST_F(Cameras, ABrokenPictureIsRefusedAndTheNextOneShown) {
  begin(kWifi);
  spoil = [](CompressedImage& message) { message.data().resize(message.data().size() / 3); };
  EXPECT_TRUE(watch(3s).empty());
  EXPECT_THAT(execute("health r1").text, HasSubstr("camera front"));
  spoil = {};
  EXPECT_FALSE(watch(2s).empty());
}

TEST_F(Cameras, StampsOfZeroAndAForeignClockCostOnlyTheExactPose) {
  begin(kWifi);
  stamps = false;
  EXPECT_LT(watch(4s).back().age, 0.3);
  stamps = true;
  clock = 3600s;
  const auto shown = watch(3s);
  ASSERT_FALSE(shown.empty());
  EXPECT_LT(shown.back().age, 0.3);
  EXPECT_EQ(shown.back().pose.size(), 7U);
  EXPECT_THAT(execute("health r1").text, HasSubstr("far from those of the odometry"));
}

TEST_F(Cameras, RawPicturesAreReadWhereThereIsNoCompressedTopic) {
  begin(kWifi);
  compressed = {};
  sends = false;
  auto raw = wire::Writer<Image>::make(*driver, wire::topics::kImage).value();
  const Timer timer = bench->strand().every(100ms, [&] {
    Image message;
    stamp(message.header());
    static const perception::Picture picture = drawn(320, 240, 1);
    message.width(320);
    message.height(240);
    message.step(960);
    message.encoding("rgb8");
    message.data(picture.bytes);
    (void)raw.write(message);
  });
  const auto shown = watch(6s);
  ASSERT_FALSE(shown.empty());
  EXPECT_EQ(shown.back().width, 320U);
}

TEST_F(Cameras, OfTwoCamerasEachSendsInItsTurn) {
  CameraConfig back;
  back.name = "back";
  back.topic = "rear";
  begin(kWifi, {CameraConfig{}, back});
  wire::Topic<CompressedImage> topic = wire::topics::kCompressedImage;
  topic.name = "rt/rear/image_raw/compressed";
  auto rear = wire::Writer<CompressedImage>::make(*driver, topic).value();
  const Timer timer = bench->strand().every(50ms, [&] {
    CompressedImage message;
    stamp(message.header());
    message.data(scene(++step));
    (void)rear.write(message);
  });
  EXPECT_EQ(execute("camera r1 on front").exit_code, 0);
  EXPECT_EQ(execute("camera r1 on back").exit_code, 0);
  bench->run(8s);
  const auto robot = station->world().robot("r1");
  ASSERT_EQ(robot->cameras.size(), 2U);
  for (const auto& camera : robot->cameras) EXPECT_GT(camera.rate, 5.0F) << camera.name;
}

TEST_F(Cameras, TenThatAreLookedAtShareAThinLink) {
  std::vector<CameraConfig> ten(10);
  for (std::size_t i = 0; i < ten.size(); ++i) ten[i].name = "c" + std::to_string(i);
  begin(kMesh, ten);
  std::map<std::string, int> shown;
  std::map<std::string, std::uint64_t> newest;
  double oldest = 0.0;
  std::uint64_t bytes_before = 0;
  for (int second = 0; second < 120; ++second) {
    if (second == 20) bytes_before = bytes(), shown.clear();
    for (const CameraConfig& camera : ten) {
      const bool sharp = &camera == &ten.front();
      (void)station->cameras().look("r1", camera.name, sharp ? 640 : 80, sharp ? 15.0F : 0.1F);
      station->cameras().next("r1", camera.name, newest[camera.name], [&](const station::CameraPicture& got) {
        if (got.number == 0 || newest[got.camera] == got.number) return;
        newest[got.camera] = got.number;
        ++shown[got.camera];
      });
    }
    bench->run(1s);
    if (second > 20) oldest = std::max(oldest, station->world().robot("r1")->age);
  }
  EXPECT_LE(8.0 * static_cast<double>(bytes() - bytes_before) / 100.0, 0.3 * 100e3);
  EXPECT_GE(shown["c0"], 20) << "the large one";
  for (const CameraConfig& camera : ten) EXPECT_GE(shown[camera.name], 4) << camera.name;
  EXPECT_LT(oldest, 3.0) << "of the robot's state, s";
}

TEST_F(Cameras, TwentyMegapixelsSixtyTimesASecondAreShown) {
  begin(kWifi);
  sends = false;
  std::vector<std::vector<std::uint8_t>> large;
  for (std::uint32_t i = 0; i < 2; ++i) {
    perception::Picture picture{.width = 5184, .height = 3888, .channels = 1};
    picture.bytes.assign(std::size_t{5184} * 3888, static_cast<std::uint8_t>(60 + 90 * i));
    large.push_back(perception::encode_jpeg(picture, 60));
  }
  int sent = 0;
  const Timer timer = bench->strand().every(17ms, [&] {
    CompressedImage message;
    stamp(message.header());
    message.data(large[static_cast<std::size_t>(++sent / 8 % 2)]);
    (void)compressed.write(message);
  });
  const auto shown = watch(4s, 320);
  EXPECT_GT(sent, 200);
  ASSERT_GE(shown.size(), 3U);
  EXPECT_LE(shown.size(), 61U) << "what is asked for, not what is sent";
  EXPECT_EQ(shown.back().width, 320U);
  EXPECT_LT(shown.back().age, 1.0);
}

TEST_F(Cameras, GoOnAfterARestartOfTheComponent) {
  begin(kWifi);
  EXPECT_FALSE(watch(2s).empty());
  EXPECT_TRUE(bench->agent().inject("cameras", ComponentFault::crash).ok());
  bench->run(3s);
  EXPECT_FALSE(watch(4s).empty());
  EXPECT_THAT(execute("health r1").text, testing::ContainsRegex("cameras +up +auto"));
}

TEST_F(Cameras, ARobotThatHasNotDescribedItselfIsNotSaidToHaveNone) {
  begin(kWifi);
  radio::RobotState state;
  state.robot("r7");
  auto other = bench->network().join(77, "r7");
  auto states = wire::Writer<radio::RobotState>::make(*other, wire::topics::kRobotState).value();
  bench->run(1s);  // Until writer and reader match.
  ASSERT_TRUE(states.write(state).ok());
  bench->run(500ms);
  EXPECT_THAT(execute("camera r7 on").error, HasSubstr("has not described itself yet"));
}

}  // namespace
}  // namespace adit::agent
