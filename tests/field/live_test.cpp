// SPDX-License-Identifier: Apache-2.0
// An agent beside a driver of another make, on Cyclone DDS, that does what drivers of the field do wrong.
// Each row is a case of its own, so that they run side by side.
#include <gmock/gmock.h>

#include "tests/folders/folders.hpp"
#include "tests/live/programs.hpp"

namespace adit::live {
namespace {

using testing::HasSubstr;
using testing::Not;

class FieldDriver : public Programs {
 protected:
  Process driver(std::vector<std::string> more) {
    std::vector<std::string> words{"field_driver", "domain=" + std::to_string(domain(1))};
    words.insert(words.end(), more.begin(), more.end());
    Process process(words);
    EXPECT_TRUE(process.wait_for_output("drives", Seconds(10))) << process.err();
    return process;
  }
  Process robot(const std::string& file) {
    return agent({"--state", "none", "--record", "none"}, folder() + file + ".yaml");
  }
  static std::string folder() { return source_folder() + "/tests/field/live/"; }
  bool soon(std::vector<std::string> words) {
    return eventually([&] {
      const auto finished = op("op1", words);
      said_ = finished.out + finished.err;
      return finished.exit_code == 0;
    });
  }
  double x() {
    const auto pose = listed("op1", "h1").value("pose", nlohmann::json::array());
    return pose.empty() ? 0.0 : pose[0].get<double>();
  }
  /// What the operator reads of the row `inputs`.
  bool health_says(const std::string& text) {
    return eventually([&] { return op("op1", {"health", "h1"}).out.find(text) != std::string::npos; });
  }
  std::string check(const std::string& file) {
    const auto checked = run({"robot_agent", "check", "--config", folder() + file + ".yaml", "--robot-domain",
                              std::to_string(domain(1)), "--standing", "2", "--no-turn"},
                             folder_.environment());
    EXPECT_EQ(checked.exit_code, 1);
    return checked.out + checked.err;
  }
  std::string said_{};  ///< What the last command printed.
};

/// What a driver sends that is right: the robot drives by it, and nothing is reported.
struct GoodRow {
  const char* name;
  std::vector<std::string> driver;
  bool late;         ///< The agent starts after all of the driver's frames were sent.
  bool quiet{true};  ///< Not a word; otherwise the frame is unknown until it is sent.
};

void PrintTo(const GoodRow& row, std::ostream* out) { *out << row.name; }

class FieldGood : public FieldDriver, public testing::WithParamInterface<GoodRow> {};

TEST_P(FieldGood, IsDrivenByWithoutAWord) {
  const Process ros = driver(GetParam().driver);
  if (GetParam().late) pass(Seconds(1));
  Process h1 = robot("h1");
  ASSERT_TRUE(soon({"take", "h1"}));
  ASSERT_TRUE(soon({"goto", "h1", "2", "0"})) << said_ << op("op1", {"health", "h1"}).out << h1.err();
  EXPECT_TRUE(eventually([&] { return x() > 0.5; }, Seconds(20))) << x() << "\n" << h1.err();
  EXPECT_THAT(h1.err(), Not(HasSubstr("not_deskewed")));
  if (!GetParam().quiet) return;
  EXPECT_THAT(h1.err(), Not(HasSubstr("sensor_refused")));
  EXPECT_THAT(op("op1", {"health", "h1"}).out, Not(HasSubstr("inputs")));
}

INSTANTIATE_TEST_SUITE_P(
    Rows, FieldGood,
    testing::Values(GoodRow{"Plain", {}, false},
                    GoodRow{"FrameThatIsSentEarly", {"frame=os_lidar", "tf_at=0"}, true},
                    GoodRow{"FrameThatIsSentLate", {"frame=os_lidar", "tf_at=0.5"}, false, false},
                    GoodRow{"HesaiLost", {"layout=hesai", "lost=4", "lost_time=zero"}, false},
                    GoodRow{"OusterWrapped", {"lost=8", "lost_time=wrapped"}, false},
                    GoodRow{"LivoxLost", {"layout=livox", "lost=1", "lost_time=zero"}, false}),
    [](const auto& row) { return std::string(row.param.name); });

/// What a driver does wrong, and what operators read.
struct BadRow {
  const char* name;
  std::vector<std::string> driver;
  const char* file;
  const char* code;
  const char* text;
};

void PrintTo(const BadRow& row, std::ostream* out) { *out << row.name; }

class FieldBad : public FieldDriver, public testing::WithParamInterface<BadRow> {};

TEST_P(FieldBad, IsToldWithItsCause) {
  const BadRow& row = GetParam();
  const Process ros = driver(row.driver);
  Process h1 = robot(row.file);
  EXPECT_TRUE(h1.wait_for_output(row.text, Seconds(10))) << h1.err();
  EXPECT_THAT(h1.err(), HasSubstr(row.code));
  EXPECT_TRUE(health_says(row.text)) << op("op1", {"health", "h1"}).out;
}

INSTANTIATE_TEST_SUITE_P(
    Rows, FieldBad,
    testing::Values(
        BadRow{"NoQuaternion",
               {"quat=zero"},
               "h1",
               "sensor_refused",
               "its orientation 0 0 0 0 is no quaternion"},
        BadRow{"ImuWithoutStamps", {"imu=zero"}, "h1_imu", "sensor_refused", "'imu/data' have no stamp"},
        BadRow{"PlanarInNanoseconds",
               {"layout=none", "scan=ns", "spin=0.8"},
               "h1",
               "sensor_refused",
               "times its 720 rays is no sweep of 0.1 s"},
        BadRow{"ChargeInPercent", {"battery=12"}, "h1", "sensor_refused", "is 12, as if it were percent"},
        BadRow{"VelocitiesOfAnotherType",
               {"velocity=plain"},
               "h1_stamped",
               "type_differs",
               "reads geometry_msgs/msg/Twist, but the agent sends geometry_msgs/msg/TwistStamped"}),
    [](const auto& row) { return std::string(row.param.name); });

TEST_F(FieldDriver, AChargeInPercentIsShownAsUnknown) {
  const Process ros = driver({"battery=12"});
  const Process h1 = robot("h1");
  ASSERT_TRUE(soon({"take", "h1"}));
  ASSERT_TRUE(eventually([&] { return listed("op1", "h1").value("mode", "") == "hold"; }));
  ASSERT_TRUE(health_says("percent"));
  const auto row = listed("op1", "h1");
  EXPECT_TRUE(!row.contains("battery") || row["battery"].is_null() || row["battery"] == -1) << row.dump();
}

TEST_F(FieldDriver, AProgramMayStampItsVelocities) {
  const Process ros = driver({"external=stamped"});
  Process h1 = robot("h1");
  ASSERT_TRUE(soon({"take", "h1"}));
  ASSERT_TRUE(soon({"mode", "h1", "external"})) << h1.err();
  EXPECT_TRUE(eventually([&] { return x() > 0.3; }, Seconds(20))) << x();
}

TEST_F(FieldDriver, ASecondDriverIsToldAndLeftOut) {
  const Process ros = driver({});
  Process h1 = robot("h1");
  ASSERT_TRUE(soon({"take", "h1"}));
  ASSERT_TRUE(eventually([&] { return listed("op1", "h1").value("mode", "") == "hold"; }));
  ASSERT_TRUE(soon({"goto", "h1", "1.5", "0"})) << h1.err();
  ASSERT_TRUE(eventually([&] { return x() > 0.8; }, Seconds(20))) << x();
  const Process second = driver({});
  EXPECT_TRUE(h1.wait_for_output("two participants send /odom", Seconds(10))) << h1.err();
  EXPECT_TRUE(h1.wait_for_output("two participants send /points", Seconds(10))) << h1.err();
  EXPECT_THAT(h1.err(), Not(HasSubstr("odometry_jumped")));
  EXPECT_GT(x(), 0.8);
}

TEST_F(FieldDriver, CheckJudgesTypesUnitsAndSources) {
  const Process ros = driver({"battery=12", "quat=zero", "imu=zero"});
  const std::string text = check("h1_stamped");
  EXPECT_THAT(text, HasSubstr("reads geometry_msgs/msg/Twist, but the agent sends"));
  EXPECT_THAT(text, HasSubstr("as if it were percent"));
  EXPECT_THAT(text, HasSubstr("no quaternion"));
  EXPECT_THAT(check("h1_imu"), HasSubstr("they have no stamp"));
  // Of two, the one that is found first is judged.
  const Process second = driver({});
  EXPECT_THAT(check("h1_stamped"), HasSubstr("two participants send /points"));
}

}  // namespace
}  // namespace adit::live
