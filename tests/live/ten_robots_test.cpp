// SPDX-License-Identifier: Apache-2.0
// Ten robots, two operators: the standing scenario, live. The whole of it, by hand: tools/live.sh. In
// rehearsal: Scenarios.EverythingHolds/ten_robots.
#include <gmock/gmock.h>

#include <fstream>
#include <regex>

#include "tests/folders/folders.hpp"
#include "tests/live/process.hpp"

namespace adit::live {
namespace {

using testing::HasSubstr;

const std::string kScenario = source_folder() + "/config/scenarios/ten_robots.yaml";

/// The scenario up to its stop of all, in two fifths of the time; what takes longer is not expected.
std::string shortened() {
  constexpr double last = 16.0, pace = 0.4;
  std::ifstream in(kScenario);
  std::string out;
  const std::regex timed(R"(^  - \{(at|by): ([0-9.]+),(.*))");
  std::smatch part;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_match(line, part, timed)) {
      out += line + "\n";
      continue;
    }
    const double at = std::stod(part[2]);
    const bool script = part[3].str().starts_with(" by:");
    if (script && at <= last) out += "  - {at: " + std::to_string(at * pace) + "," + part[3].str() + "\n";
  }
  return out;
}

TEST(TenRobots, Live) {
  const Folder folder;
  const std::string file = folder.write("ten_robots.yaml", shortened());
  const auto done =
      run({source_folder() + "/tools/live.sh", file}, {{"ADIT_BIN", program_folder()}}, Seconds(60));
  EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
  EXPECT_THAT(done.out, HasSubstr("10 robots known to 2 operators"));
  EXPECT_THAT(done.out, HasSubstr("everything holds"));
  // What is refused and what everybody obeys.
  EXPECT_TRUE(std::regex_search(done.out, std::regex("op2  r1: .*op1")))
      << "op2 took r1, which op1 has locked";
  for (int robot = 1; robot <= 10; ++robot)
    EXPECT_TRUE(std::regex_search(done.out, std::regex("op2  r" + std::to_string(robot) + ": stop")))
        << "r" << robot << "\n"
        << done.out;
}

}  // namespace
}  // namespace adit::live
