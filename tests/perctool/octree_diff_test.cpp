// SPDX-License-Identifier: Apache-2.0
// Maps compared cell by cell.
#include "sim/perctool/octree_diff.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <random>

#include "tests/sim/scratch.hpp"

namespace adit::sim::perctool {
namespace {

TEST(OctreeDiff, CountsCellsOfPrunedLeaves) {
  OctomapFile a{0.1, {{0, 0, 0, 4, true}, {8, 0, 0, 2, false}, {-4, 0, 0, 1, true}}};
  OctomapFile b{0.1, {{0, 0, 0, 2, true}, {2, 0, 0, 2, false}, {8, 0, 0, 2, false}, {20, 0, 0, 1, false}}};
  const OctreeDiff diff = compare(a, b).value();
  EXPECT_EQ(diff.equal, 8u + 8u);
  EXPECT_EQ(diff.different, 8u);
  EXPECT_EQ(diff.missing, 64u - 16u + 1u);
  EXPECT_EQ(diff.more, 1u);
  EXPECT_EQ(compare(a, a).value().share(), 1.0);
  EXPECT_EQ(compare({0.1, {}}, {0.1, {}}).value().share(), 1.0);
  EXPECT_EQ(compare({0.1, {}}, a).value().more, 64u + 8u + 1u);
  b.resolution = 0.2;
  EXPECT_EQ(compare(a, b).reason(), Reason::bad_argument);
}

TEST(OctreeDiff, AgreesWithLiboctomapCellByCell) {
  std::mt19937 random(3);
  octomap::OcTree a(0.1), b(0.1);
  for (int n = 0; n < 4000; ++n) {
    const octomap::OcTreeKey key(32760 + random() % 16, 32760 + random() % 16, 32760 + random() % 16);
    a.updateNode(key, random() % 3 != 0);
    b.updateNode(key, random() % 3 != 0);
    if (random() % 2 == 0) b.updateNode(octomap::OcTreeKey(key[0], key[1], 32780), true);
  }
  for (octomap::OcTree* tree : {&a, &b}) {
    tree->toMaxLikelihood();
    tree->prune();
  }
  const Scratch scratch;
  ASSERT_TRUE(a.writeBinary(scratch.path("a.bt").string()));
  ASSERT_TRUE(b.write(scratch.path("b.ot").string()));
  OctreeDiff expected;
  for (int x = 32750; x < 32790; ++x)
    for (int y = 32750; y < 32790; ++y)
      for (int z = 32750; z < 32790; ++z) {
        const octomap::OcTreeKey key(x, y, z);
        const auto *in_a = a.search(key), *in_b = b.search(key);
        if (in_a && in_b)
          ++(a.isNodeOccupied(in_a) == b.isNodeOccupied(in_b) ? expected.equal : expected.different);
        else if (in_a || in_b)
          ++(in_a ? expected.missing : expected.more);
      }
  const OctreeDiff diff =
      compare(read_map(scratch.path("a.bt")).value(), read_map(scratch.path("b.ot")).value()).value();
  EXPECT_EQ(diff.equal, expected.equal);
  EXPECT_EQ(diff.different, expected.different);
  EXPECT_EQ(diff.missing, expected.missing);
  EXPECT_EQ(diff.more, expected.more);
  EXPECT_GT(expected.equal, 100u);
}

TEST(OctreeDiff, RefusesAFileThatIsNoMap) {
  const Scratch scratch;
  scratch.write("cut.ot", "# Octomap OcTree file\nid OcTree\nsize 5\nres 0.1\ndata\nabc");
  scratch.write("other.ot", "hello");
  scratch.write("map.pcd", "");
  EXPECT_EQ(read_map(scratch.path("other.ot")).reason(), Reason::syntax);
  EXPECT_EQ(read_map(scratch.path("map.pcd")).reason(), Reason::not_supported);
  EXPECT_EQ(read_map(scratch.path("none.ot")).reason(), Reason::cannot_read);
  EXPECT_EQ(read_map(scratch.path("none.bt")).reason(), Reason::cannot_read);
}

}  // namespace
}  // namespace adit::sim::perctool
