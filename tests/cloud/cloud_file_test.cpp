// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/cloud_file.hpp"

#include <gtest/gtest.h>

#include <array>

#include "sim/cloud/tum_file.hpp"
#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

TEST(CloudFile, ReadsKittisPointsWithoutTheirReflectance) {
  const Scratch scratch;
  const std::array<float, 8> values{1, 2, 3, 0.5, -4, 5.5, -1.73f, 0};
  const auto file = scratch.write("0.bin", {reinterpret_cast<const char*>(values.data()), sizeof values});
  const auto cloud = read_cloud(file);
  ASSERT_TRUE(cloud.ok()) << cloud.error().text;
  EXPECT_EQ(*cloud, (PointCloud{{1, 2, 3}, {-4, 5.5, -1.73f}}));
}

TEST(CloudFile, RefusesACutFileAndAnUnknownOne) {
  const Scratch scratch;
  scratch.write("cut.bin", std::string(17, 'x'));
  scratch.write("cloud.las", "");
  EXPECT_EQ(read_cloud(scratch.path("cut.bin")).error().reason, Reason::syntax);
  EXPECT_EQ(read_cloud(scratch.path("cloud.las")).error().reason, Reason::not_supported);
  EXPECT_EQ(read_cloud(scratch.path("none.bin")).error().reason, Reason::cannot_read);
}

TEST(CloudFile, ListsTheCloudsOfAFolderByNameOrTheFileItself) {
  const Scratch scratch;
  EXPECT_EQ(cloud_files(scratch.path("")).error().reason, Reason::cannot_read);
  for (const char* name : {"b.bin", "a.pcd", "c.ply", "notes.txt"}) scratch.write(name, "");
  const auto files = cloud_files(scratch.path(""));
  ASSERT_TRUE(files.ok());
  ASSERT_EQ(files->size(), 3u);
  EXPECT_EQ(files->front().filename(), "a.pcd");
  EXPECT_EQ(cloud_files(scratch.path("b.bin"))->size(), 1u);
}

TEST(CloudFile, ReadsPosesAndNamesTheLineThatIsNone) {
  const Scratch scratch;
  scratch.write("good.tum", "# stamp x y z qx qy qz qw\n0 1 2 3 0 0 0 1\n\n0.1 2 2 3 0 0 1 0\n");
  const auto poses = read_tum(scratch.path("good.tum"));
  ASSERT_TRUE(poses.ok()) << poses.error().text;
  ASSERT_EQ(poses->size(), 2u);
  EXPECT_EQ(poses->back().stamp_s, 0.1);
  EXPECT_NEAR(std::abs(poses->back().pose.yaw()), M_PI, 1e-9);
  for (const char* line : {"0 1 2 3 0 0 0", "0 1 2 3 0 0 0 0", "0 1 2 3 0 0 0 nan", "0 1 2 3 0 0 0 1 9"}) {
    scratch.write("bad.tum", std::string("0 1 2 3 0 0 0 1\n") + line + "\n");
    const auto bad = read_tum(scratch.path("bad.tum"));
    ASSERT_FALSE(bad.ok()) << line;
    EXPECT_NE(bad.error().text.find("bad.tum:2:"), std::string::npos) << bad.error().text;
  }
}

}  // namespace
}  // namespace adit::sim
