// SPDX-License-Identifier: Apache-2.0
// Clouds as lidar drivers send them when packets are lost: the points of lost columns are no return, and
// their time is unset.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

struct Case {
  const char* file;
  int returns;  ///< Each in a voxel of its own.
};

class FieldClouds : public testing::TestWithParam<Case> {};

TEST_P(FieldClouds, GiveAMapOfTheirReturns) {
  const Scratch scratch;
  const std::string clouds = source_folder() + "/tests/field/clouds/";
  const std::string line = program_folder() + "/perctool map --clouds " + clouds + GetParam().file +
                           " --poses " + clouds + "one.tum --out " + scratch.path("out.bt").string() +
                           " 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  std::array<char, 4096> buffer;
  std::string out;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), n);
  EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 0) << out;
  EXPECT_NE(out.find(std::to_string(GetParam().returns) + " voxels occupied"), std::string::npos) << out;
}

INSTANTIATE_TEST_SUITE_P(Times, FieldClouds,
                         testing::Values(Case{"times_good.pcd", 512}, Case{"times_zero_first.pcd", 504},
                                         Case{"times_zero_middle.pcd", 504}, Case{"times_nan_first.pcd", 504},
                                         Case{"times_wrapped.pcd", 504}),
                         [](const auto& which) {
                           const std::string name = which.param.file;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace adit::sim
