// SPDX-License-Identifier: Apache-2.0
// Paths of wheels with stamps as recordings have them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

struct Ended {
  int status{};
  std::string text{};
};

Ended odometry(const std::string& wheels, const std::string& out) {
  const std::string folder = source_folder() + "/tests/field/wheels/";
  const std::string line = program_folder() + "/perctool odometry --clouds " + folder + "clouds --wheels " +
                           folder + wheels + " --out " + out + " 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  std::array<char, 4096> buffer;
  Ended ended;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    ended.text.append(buffer.data(), n);
  ended.status = WEXITSTATUS(pclose(pipe));
  return ended;
}

TEST(FieldWheels, StampsSinceTheStartAreUsed) {
  const Scratch scratch;
  const Ended ended = odometry("since_start.tum", scratch.path("out.tum").string());
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_NE(ended.text.find("10 sweeps, 0.72 m"), std::string::npos) << ended.text;
  EXPECT_NE(ended.text.find("ok"), std::string::npos) << ended.text;
}

TEST(FieldWheels, StampsSince1970AreRefusedWithTheCause) {
  const Scratch scratch;
  const Ended ended = odometry("since_1970.tum", scratch.path("out.tum").string());
  EXPECT_EQ(ended.status, 2) << ended.text;
  EXPECT_NE(ended.text.find("nothing of it would be used"), std::string::npos) << ended.text;
  EXPECT_FALSE(std::filesystem::exists(scratch.path("out.tum")));
}

}  // namespace
}  // namespace adit::sim
