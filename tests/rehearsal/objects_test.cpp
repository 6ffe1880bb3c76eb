// SPDX-License-Identifier: Apache-2.0
// Objects that a robot detects in pictures of its simulated camera, as findings of the station.
#include <gmock/gmock.h>

#include <fstream>

#include "basestation/station/station.hpp"
#include "perception/vision/vision_detector.hpp"
#include "robot_agent/agent.hpp"
#include "tests/perception/objects/tiny_onnx.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

using testing::HasSubstr;

class Objects : public testing::Test {
 protected:
  Objects() {
    std::ofstream(folder_ + "/tiny.onnx", std::ios::binary) << tiny_onnx::model();
    std::ofstream(folder_ + "/labels.txt") << "person\n";
  }
  /// A person stands in a room before the robots. `robots`: more lines.
  std::string room(const std::string& objects, const std::string& robots = "") const {
    return "world:\n  boxes:\n    - [-0.5, 12.5, -4.5, -4, 0, 3]\n    - [-0.5, 12.5, 4, 4.5, 0, 3]\n"
           "    - [-0.5, 0, -4, 4, 0, 3]\n    - [12, 12.5, -4, 4, 0, 3]\n  floor: 0\n  ceiling: 3\n"
           "duration: 20\nlink: mesh_100k\nlidar: full\nperception: odometry\n"
           "people:\n  - {path: [[5.5, 0.6], [5.5, 0.7]], speed: 0.01}\n"
           "basestations:\n  - {id: op1, pose: [0.5, 3]}\n"
           "robots:\n" +
           robot("r1", "[1, 0, 0]", objects) + robots;
  }
  std::string robot(const std::string& name, const std::string& pose, const std::string& objects) const {
    return "  - {id: " + name + ", platform: wheeled, pose: " + pose +
           ", camera: {name: front, topic: front, rate: 10, width: 320, height: 240, sends: jpeg}, "
           "objects: " +
           objects + "}\n";
  }
  std::string tiny() const {
    return "{model: " + folder_ + "/tiny.onnx, labels: " + folder_ + "/labels.txt, min_score: 0.3}";
  }
  struct Seen {
    station::FoundReport found{};
    store::Bytes thumbnail{};
  };
  Seen play(const std::string& yaml) const {
    const auto scenario = parse_scenario(yaml, "objects.yaml");
    EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
    RunParams params;
    params.make_agent = *make_agent_factory(
        "", [](agent::AgentParams& agent) { agent.make_detector = perception::make_vision_detector; });
    Seen out;
    params.on_station = [&](Duration now, const station::Station& station) {
      if (now < scenario->duration - 1s || !out.found.at_robots.empty()) return;
      out.found = station.found();
      for (const station::FoundItem& item : out.found.findings)
        if (item.photo)
          if (const auto* bytes =
                  station.photo(std::stoull(item.photo->id, nullptr, 16), findings::PhotoPart::thumbnail))
            out.thumbnail = *bytes;
    };
    auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
    EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
    if (outcome) expect_ok(outcome->report);
    return out;
  }
  std::string folder_{scratch_folder()};
};

TEST_F(Objects, APersonIsFoundOnceWithPlaceAndThumbnailOverAThinLink) {
  const Seen seen = play(room(tiny()));
  ASSERT_EQ(seen.found.findings.size(), 1U);
  const station::FoundItem& item = seen.found.findings[0];
  EXPECT_EQ(item.kind, "person");
  EXPECT_LT(std::hypot(item.position[0] - 5.5, item.position[1] - 0.65), 0.5);
  EXPECT_THAT(item.text, HasSubstr("sigma"));
  ASSERT_TRUE(item.photo);
  ASSERT_FALSE(seen.thumbnail.empty());
  const auto picture = perception::decode_jpeg(seen.thumbnail, 128, 128);
  ASSERT_TRUE(picture) << picture.error().text;
  // The jacket is in the middle of the thumbnail.
  const std::uint8_t* middle =
      &picture->bytes[3 * (std::size_t{picture->height / 2} * picture->width + picture->width / 2)];
  EXPECT_GT(middle[2], middle[0] + 40);
}

TEST_F(Objects, TwoRobotsThatSeeOnePersonListItOnce) {
  const Seen seen = play(room(tiny(), robot("r2", "[1, 2, 0]", tiny())));
  ASSERT_EQ(seen.found.findings.size(), 1U);
  EXPECT_EQ(seen.found.findings[0].also.size(), 1U);
  EXPECT_THAT(seen.found.findings[0].text, HasSubstr("also by"));
}

TEST_F(Objects, AModelThatIsNoneIsReportedAndTheRobotDrives) {
  std::ofstream(folder_ + "/bad.onnx") << "no network";
  const std::string yaml =
      room("{model: " + folder_ + "/bad.onnx, labels: " + folder_ + "/labels.txt}") +
      "script:\n  - {at: 2, by: op1, do: take r1}\n  - {at: 4, by: op1, do: goto r1 3 0}\n"
      "expect:\n  - {by: 19, robot: r1, near: [3, 0, 0.5]}\n"
      "  - {by: 19, by_operator: op1, robot: r1, notified: detector_refused}\n";
  const Seen seen = play(yaml);
  EXPECT_TRUE(seen.found.findings.empty());
}

TEST_F(Objects, WithoutAnythingToFindNothingIsFound) {
  std::string yaml = room(tiny());
  yaml.erase(yaml.find("people:"), yaml.find("basestations:") - yaml.find("people:"));
  EXPECT_TRUE(play(yaml).found.findings.empty());
}

}  // namespace
}  // namespace adit::sim
