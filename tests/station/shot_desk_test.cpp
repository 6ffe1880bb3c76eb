// SPDX-License-Identifier: Apache-2.0
#include "basestation/camera/shot_desk.hpp"

#include <gmock/gmock.h>

#include "basestation/model/camera_bytes.hpp"
#include "basestation/model/json.hpp"
#include "core/store/crc32c.hpp"
#include "core/transfer/shot_piece.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using transfer::kShotBlock;

class ShotDeskTest : public testing::Test {
 protected:
  std::uint32_t await() {
    return desk.await("r1", "front", now,
                      [this](const Result<ShotPicture>& picture) { results.push_back(picture); });
  }
  std::vector<std::uint8_t> piece(std::uint32_t number, std::uint16_t block, std::uint8_t fill = 7) const {
    std::vector<std::uint8_t> jpeg(3 * kShotBlock, fill);
    transfer::ShotPiece out{.camera = "front",
                            .number = number,
                            .age = 300,
                            .place = {{1, 2, 3, 4}},
                            .bytes = static_cast<std::uint32_t>(jpeg.size()),
                            .crc = crc32c(jpeg),
                            .first = block};
    out.data.assign(kShotBlock, fill);
    return encode(out);
  }
  ShotDesk desk{};
  Time now{100s};
  std::vector<Result<ShotPicture>> results{};
};

TEST_F(ShotDeskTest, APictureIsDoneOnceAllItsBlocksAreHereInAnyOrder) {
  const std::uint32_t number = await();
  EXPECT_EQ(desk.awaited("r1", "front"), number);
  for (const std::uint16_t block : {2, 0, 2}) EXPECT_TRUE(desk.take("r1", piece(number, block), now).ok());
  EXPECT_NEAR(desk.progress(number), 2.0 / 3.0, 1e-9);
  EXPECT_TRUE(results.empty());
  EXPECT_TRUE(desk.take("r1", piece(number, 1), now).ok());
  ASSERT_EQ(results.size(), 1U);
  ASSERT_TRUE(results[0].ok());
  EXPECT_EQ(results[0]->jpeg.size(), 3 * kShotBlock);
  EXPECT_NEAR(results[0]->age, 0.3, 1e-9);
  EXPECT_EQ(desk.awaited("r1", "front"), 0U);
}

TEST_F(ShotDeskTest, PiecesOfOthersAreTakenAndLeftOut) {
  const std::uint32_t number = await();
  EXPECT_TRUE(desk.take("r2", piece(number, 0), now).ok());
  EXPECT_TRUE(desk.take("r1", piece(number + 1, 0), now).ok());
  EXPECT_EQ(desk.progress(number), 0.0);
  EXPECT_EQ(desk.take("r1", std::vector<std::uint8_t>{1, 2, 3}, now).reason(), Reason::malformed);
}

TEST_F(ShotDeskTest, AnotherPictureOfTheSameNumberBeginsAgain) {
  const std::uint32_t number = await();
  for (const std::uint16_t block : {0, 1}) EXPECT_TRUE(desk.take("r1", piece(number, block, 7), now).ok());
  for (const std::uint16_t block : {0, 1, 2}) EXPECT_TRUE(desk.take("r1", piece(number, block, 9), now).ok());
  ASSERT_EQ(results.size(), 1U) << "the robot was restarted and took another one";
  EXPECT_EQ(results[0]->jpeg[0], 9);
}

TEST_F(ShotDeskTest, OneThatIsLateIsGivenUpWithAReason) {
  const std::uint32_t number = await();
  desk.tick(now + 60s);
  EXPECT_TRUE(results.empty()) << "robots were not asked for it";
  desk.asked(number, now + 60s);
  EXPECT_TRUE(desk.take("r1", piece(number, 0), now + 75s).ok());
  desk.tick(now + 190s);
  EXPECT_TRUE(results.empty()) << "over a cut";
  desk.tick(now + 200s);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].reason(), Reason::no_answer);
  desk.asked(await(), now);
  desk.tick(now + 21s);
  EXPECT_EQ(results.size(), 2U) << "nothing came of it";
}

TEST_F(ShotDeskTest, IsBounded) {
  for (std::size_t i = 0; i < ShotDesk::kMost; ++i) EXPECT_NE(await(), 0U);
  EXPECT_EQ(await(), 0U);
  desk.cancel_all();
  EXPECT_EQ(results.size(), ShotDesk::kMost);
}

TEST(CameraBytesTest, APictureReturnsFromItsJson) {
  const CameraPicture picture{.robot = "r1",
                              .camera = "front",
                              .number = 4,
                              .jpeg = {1, 2, 3},
                              .width = 320,
                              .height = 240,
                              .colour = true,
                              .span = 10,
                              .missing = {5},
                              .absent = {1},
                              .age = 0.25,
                              .pose = {1, 2, 3, 0, 0, 0, 1}};
  const auto read = camera_picture_of({.json = line_of(camera_json(picture))});
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->jpeg, picture.jpeg);
  EXPECT_EQ(read->missing, picture.missing);
  EXPECT_EQ(read->absent, picture.absent);
  EXPECT_EQ(read->pose, picture.pose);
  EXPECT_EQ(read->number, 4U);
  for (const char* wrong : {R"({"number":1})", R"({"number":1,"width":99999,"height":9,"span":1,"jpeg":""})",
                            R"({"number":1,"width":9,"height":9,"span":1,"jpeg":"?"})", "[]", "x"})
    EXPECT_FALSE(camera_picture_of({.json = wrong}).ok()) << wrong;
  EXPECT_EQ(camera_picture_of({.json = R"({"robot":"r1","number":0})"})->number, 0U) << "there is none";
}

TEST(CameraBytesTest, ARequestIsCheckedAsAWhole) {
  const CameraRequest wanted{.robot = "r1", .camera = "front", .width = 320, .rate = 5, .after = 9};
  const auto read = camera_request_from(json_of(wanted));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->after, 9U);
  for (const char* wrong :
       {R"({"camera":"front"})", R"({"robot":"r1","camera":"front","width":0})",
        R"({"robot":"r1","camera":"front","rate":-1})", R"({"robot":"r1","camera":"a b"})"})
    EXPECT_FALSE(camera_request_from(nlohmann::json::parse(wrong)).ok()) << wrong;
}

}  // namespace
}  // namespace adit::station
