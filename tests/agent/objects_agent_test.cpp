// SPDX-License-Identifier: Apache-2.0
// The component that detects objects, with detectors, cameras and clocks that misbehave.
#include <gmock/gmock.h>

#include "basestation/station/station.hpp"
#include "robot_agent/objects/objects_part.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using perception::ObjectBox, perception::ObjectDetector, perception::Picture;
using sensor_msgs::msg::CompressedImage;
using testing::HasSubstr;

/// Finds what the test says in each picture.
struct FakeDetector final : ObjectDetector {
  std::uint32_t picture_side() const override { return 64; }
  Result<std::vector<ObjectBox>> detect(const Picture& picture) override {
    widths.push_back(picture.width);
    return next;
  }
  Result<std::vector<ObjectBox>> next{std::vector<ObjectBox>{
      {.kind = "rope", .score = 0.9, .left = 0.3, .top = 0.3, .width = 0.4, .height = 0.4}}};
  std::vector<std::uint32_t> widths{};  ///< Of the pictures that were searched.
};

Picture grey(std::uint32_t width, std::uint32_t height) {
  return {.width = width,
          .height = height,
          .channels = 1,
          .bytes = std::vector<std::uint8_t>(std::size_t{width} * height, 90)};
}

class Objects : public testing::Test {
 protected:
  void begin(std::vector<CameraConfig> cameras = {CameraConfig{}}) {
    AgentParams params;
    // As high as the points of the bench's lidar.
    for (CameraConfig& camera : cameras) camera.mounting.z = 0.0;
    params.platform.cameras = std::move(cameras);
    params.objects.emplace().report.importance = importance;
    params.make_detector =
        [this](const perception::DetectorParams&) -> Result<std::shared_ptr<ObjectDetector>> {
      ++loads;
      if (broken) return *broken;
      return std::shared_ptr<ObjectDetector>(detector);
    };
    bench = std::make_unique<AgentBench>(std::move(params));
    driver = bench->network().join(100, "driver");
    pictures = wire::Writer<CompressedImage>::make(*driver, wire::topics::kCompressedImage).value();
    timer = bench->strand().every(50ms, [this] { send(); });
    radio = bench->network().join(77, "op1");
    station::StationParams op;
    op.id[0] = 9;
    station = std::make_unique<station::Station>(op, bench->strand(), *radio);
    station->on_notice = [this](const station::StoredNotice& notice) { codes.push_back(notice.code); };
    ASSERT_TRUE(station->start().ok());
  }
  ~Objects() override {
    station.reset();
    radio.reset();
    pictures = {};
    driver.reset();
  }
  void send() {
    if (!sends) return;
    CompressedImage message;
    const auto ns = (bench->strand().now() + clock).time_since_epoch().count();
    if (stamps) {
      message.header().stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
      message.header().stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
    }
    message.data(jpeg);
    (void)pictures.write(message);
  }
  std::size_t searched() const { return detector->widths.size(); }
  bool notified(const std::string& code) const { return std::ranges::find(codes, code) != codes.end(); }

  std::map<std::string, std::uint8_t> importance{};
  std::shared_ptr<FakeDetector> detector{std::make_shared<FakeDetector>()};
  std::optional<Error> broken{};
  int loads{};
  std::unique_ptr<AgentBench> bench{};
  std::unique_ptr<wire::Participant> driver{}, radio{};
  wire::Writer<CompressedImage> pictures{};
  std::unique_ptr<station::Station> station{};
  Timer timer{};
  std::vector<std::uint8_t> jpeg{perception::encode_jpeg(grey(320, 240), 90)};
  bool sends{true}, stamps{true};
  Duration clock{};
  std::vector<std::string> codes{};
};

TEST_F(Objects, OnePictureASecondIsSearchedAndAnObjectIsAFinding) {
  begin();
  bench->run(12s);
  EXPECT_GE(searched(), 8U);
  EXPECT_LE(searched(), 12U);
  EXPECT_EQ(detector->widths.back(), 64U);
  ASSERT_EQ(station->findings(), 1U);
  const station::FoundItem item = station->found().findings.at(0);
  EXPECT_EQ(item.kind, "rope");
  EXPECT_NEAR(item.position[0], 1.0, 0.1) << "the nearest ring of the bench's lidar";
  EXPECT_NEAR(item.position[1], 0.0, 0.1);
  EXPECT_TRUE(item.photo);
}

TEST_F(Objects, KindsOfImportanceZeroAreIgnored) {
  importance = {{"rope", 0}};
  begin();
  bench->run(8s);
  EXPECT_GE(searched(), 4U);
  EXPECT_EQ(station->findings(), 0U);
}

TEST_F(Objects, ACameraThatSendsNothingHoldsUpNoOther) {
  begin({CameraConfig{.name = "back", .topic = "back"}, CameraConfig{}});
  bench->run(14s);
  EXPECT_GE(searched(), 4U);
}

TEST_F(Objects, ADetectorThatFailsIsReportedAndTriedAgain) {
  begin();
  detector->next = Error{Reason::internal, "no such layer"};
  bench->run(8s);
  EXPECT_GE(searched(), 4U);
  EXPECT_TRUE(notified("detector_refused"));
  EXPECT_FALSE(notified("sensor_refused"));
}

TEST_F(Objects, ADetectorThatCannotBeLoadedIsReportedAndOneWithoutTimeIsTriedAgain) {
  broken = Error{Reason::queue_full, "too many jobs"};
  begin();
  bench->run(5s);
  EXPECT_EQ(loads, 1);
  EXPECT_FALSE(notified("detector_refused"));
  broken = Error{Reason::malformed, "no ONNX"};
  bench->run(12s);
  EXPECT_EQ(loads, 2);
  EXPECT_TRUE(notified("detector_refused"));
  bench->run(20s);
  EXPECT_EQ(loads, 2);
}

TEST_F(Objects, ABrokenJpegIsTheCamerasFaultAndTheNextPictureIsSearched) {
  begin();
  bench->run(3s);
  const auto good = jpeg;
  jpeg.resize(jpeg.size() / 2);
  const std::size_t before = searched();
  bench->run(5s);
  EXPECT_LE(searched(), before + 1);
  EXPECT_TRUE(notified("sensor_refused"));
  jpeg = good;
  bench->run(3s);
  EXPECT_GT(searched(), before + 1);
}

TEST_F(Objects, StampsOfZeroAndAnotherClockUseTheArrival) {
  begin();
  stamps = false;
  bench->run(6s);
  const std::size_t before = searched();
  EXPECT_GE(before, 3U);
  stamps = true;
  clock = 3600s;
  bench->run(5s);
  EXPECT_GE(searched(), before + 3);
  EXPECT_EQ(station->findings(), 1U);
}

TEST_F(Objects, WithoutALidarNoPictureIsTakenAndNoFaultIsTheCameras) {
  begin();
  bench->run(4s);
  bench->lidar_alive = false;
  bench->run(2s);
  const std::size_t before = searched();
  bench->run(6s);
  EXPECT_EQ(searched(), before);
  bench->lidar_alive = true;
  bench->run(4s);
  EXPECT_GT(searched(), before);
  EXPECT_FALSE(notified("sensor_refused"));
}

TEST_F(Objects, GoOnAfterARestartOfTheComponent) {
  begin();
  bench->run(6s);
  EXPECT_TRUE(bench->agent().inject("objects", ComponentFault::crash).ok());
  bench->run(3s);
  const std::size_t before = searched();
  bench->run(4s);
  EXPECT_EQ(loads, 2);
  EXPECT_GT(searched(), before);
  EXPECT_EQ(station->findings(), 1U);
}

TEST(ObjectsPicture, ThePhotoIsTheBoxWithAMargin) {
  Picture picture = grey(200, 100);
  const auto jpeg = cut_out(picture, {.left = 0.5, .top = 0.5, .width = 0.1, .height = 0.2});
  const auto out = perception::decode_jpeg(jpeg, 1000, 1000);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->width, 36U);   // 20 pixels and 40 % of that on both sides.
  EXPECT_EQ(out->height, 36U);  // 20 pixels, too.
  EXPECT_TRUE(cut_out(picture, {.left = 1.0, .top = 0.5, .width = 0.0, .height = 0.2}).empty());
}

}  // namespace
}  // namespace adit::agent
