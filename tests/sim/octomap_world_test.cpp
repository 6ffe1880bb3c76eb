// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include "sim/world/noise.hpp"
#include "sim/world/octomap_file.hpp"
#include "sim/world/read_file.hpp"
#include "sim/world/world.hpp"
#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

/// Marks a cell by its indices; cell (0, 0, 0) begins at the origin.
void mark(octomap::OcTree& tree, int x, int y, int z, bool occupied) {
  const double r = tree.getResolution();
  const octomap::point3d centre(static_cast<float>((x + 0.5) * r), static_cast<float>((y + 0.5) * r),
                                static_cast<float>((z + 0.5) * r));
  for (int n = 0; n < 8; ++n) tree.updateNode(centre, occupied);
}

Result<World> load(const Scratch& scratch, octomap::OcTree& tree) {
  tree.writeBinary(scratch.path("map.bt").string());
  return load_octomap(scratch.path("map.bt"));
}

bool solid_at(const World& world, double x, double y, double z) {
  const VoxelGrid& grid = world.grid();
  return grid.solid(grid.column_x(x), grid.column_y(y), grid.locate({x, y, z}).k);
}

using Key = std::tuple<int, int, int, bool>;

TEST(OctomapFile, reads_what_the_library_reads) {
  const std::filesystem::path file = building_map();
  if (file.empty()) GTEST_SKIP() << "geb079.bt is not installed; run ./run setup";
  const auto map = read_octomap_file(file);
  ASSERT_TRUE(map) << map.error().text;
  octomap::OcTree tree(file.string());
  EXPECT_DOUBLE_EQ(map->resolution, tree.getResolution());
  std::set<Key> ours, theirs;
  for (const OctreeLeaf& leaf : map->leaves)
    for (int x = 0; x < leaf.size; ++x)
      for (int y = 0; y < leaf.size; ++y)
        for (int z = 0; z < leaf.size; ++z) ours.emplace(leaf.x + x, leaf.y + y, leaf.z + z, leaf.occupied);
  tree.expand();
  for (auto it = tree.begin_leafs(); it != tree.end_leafs(); ++it) {
    const octomap::OcTreeKey key = it.getKey();
    theirs.emplace(key[0] - 32768, key[1] - 32768, key[2] - 32768, tree.isNodeOccupied(*it));
  }
  EXPECT_EQ(ours.size(), 185673u + 950759u);
  EXPECT_TRUE(ours == theirs);
}

TEST(OctomapWorld, unknown_is_solid_but_for_narrow_gaps) {
  const Scratch scratch;
  octomap::OcTree tree(0.1);
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 20; ++y) {
      mark(tree, x, y, 0, true);
      const bool gap = (x >= 10 && x < 14) || (x >= 25 && x < 36);  // 0.4 m and 1.1 m wide
      for (int z = 1; z < 12; ++z)
        if (!gap) mark(tree, x, y, z, false);
    }
  const auto world = load(scratch, tree);
  ASSERT_TRUE(world) << world.error().text;
  EXPECT_FALSE(solid_at(*world, 1.25, 1.0, 0.5)) << "free within 0.5 m on both sides";
  EXPECT_TRUE(solid_at(*world, 3.05, 1.0, 0.5)) << "free farther than 0.5 m away on one side";
  EXPECT_TRUE(solid_at(*world, 0.5, 1.0, 0.05)) << "the floor";
  EXPECT_EQ(world->grid().cast(world->grid().locate({0.55, 1.0, 0.55}), {-1, 0, 0}, 5.0), 0.55)
      << "beside the map";
}

TEST(OctomapWorld, a_missing_floor_is_filled_from_its_neighbours) {
  const Scratch scratch;
  octomap::OcTree tree(0.1);
  for (int x = 0; x < 30; ++x)
    for (int y = 0; y < 30; ++y) {
      const bool unseen = x >= 5 && x < 25 && y >= 5 && y < 25;
      if (!unseen) mark(tree, x, y, 2, true);
      for (int z = unseen ? 6 : 3; z < 15; ++z) mark(tree, x, y, z, false);
    }
  const auto world = load(scratch, tree);
  ASSERT_TRUE(world) << world.error().text;
  for (const double x : {0.25, 0.75, 1.55, 2.35}) {
    const auto ground = world->ground_height(x, 1.5, 0.5);
    ASSERT_TRUE(ground) << ground.error().text;
    EXPECT_NEAR(*ground, 0.3, 1e-9) << x;
  }
}

TEST(OctomapWorld, the_lowest_floor_with_headroom_counts) {
  const Scratch scratch;
  octomap::OcTree tree(0.1);
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y)
      for (int z = 0; z < 30; ++z) mark(tree, x, y, z, z == 0 || z == 5 || z == 16);
  const auto world = load(scratch, tree);
  ASSERT_TRUE(world) << world.error().text;
  EXPECT_NEAR(*world->ground_height(0.5, 0.5, 0.4), 0.1, 1e-9);
  EXPECT_NEAR(*world->ground_height(0.5, 0.5, 0.5), 0.6, 1e-9) << "only 0.4 m under the table";
  EXPECT_NEAR(*world->ground_height(0.5, 0.5, 1.2), 1.7, 1e-9);
  EXPECT_EQ(world->ground_height(0.5, 0.5, 2.0).reason(), Reason::out_of_range);
  EXPECT_EQ(world->ground_height(1e9, 0.5, 0.5).reason(), Reason::out_of_range);
}

TEST(OctomapWorld, names_the_error_in_a_file) {
  const Scratch scratch;
  const auto reason = [&](std::string_view content) {
    const auto world = load_octomap(scratch.write("bad.bt", content));
    EXPECT_FALSE(world);
    if (world) return Reason::none;
    EXPECT_NE(world.error().text.find("bad.bt"), std::string::npos);
    EXPECT_EQ(world.error().text.find('\n'), std::string::npos);
    return world.reason();
  };
  const std::string head = "# Octomap OcTree binary file\n";
  EXPECT_EQ(reason(""), Reason::syntax);
  EXPECT_EQ(reason("P5 1 1 255"), Reason::syntax);
  EXPECT_EQ(reason(head + "id OcTree\nres 0.1\n"), Reason::syntax) << "no data";
  EXPECT_EQ(reason(head + "id OcTree\nres nan\ndata\n"), Reason::syntax);
  EXPECT_EQ(reason(head + "id OcTree\nres -1\ndata\n"), Reason::syntax);
  EXPECT_EQ(reason(head + "id ColorOcTree\nres 0.1\ndata\n"), Reason::not_supported);
  EXPECT_EQ(reason(head + "id OcTree\nres 0.1\ndata\n\x03"), Reason::syntax) << "half a node";
  EXPECT_EQ(reason(head + "id OcTree\nres 0.1\ndata\n" + std::string(64, '\xff')), Reason::syntax);
  EXPECT_EQ(reason(head + "id OcTree\nres 0.1\ndata\n" + std::string(2, '\0')), Reason::syntax) << "empty";
  EXPECT_EQ(reason(head + "id OcTree\nres 0.1\ndata\n\x01" + std::string(1, '\0')), Reason::not_supported)
      << "an eighth of all space";
  const auto missing = load_octomap(scratch.path("nowhere.bt"));
  EXPECT_EQ(missing.reason(), Reason::cannot_read);
  EXPECT_NE(missing.error().text.find("./run setup"), std::string::npos);
  EXPECT_EQ(load_octomap(scratch.path("")).reason(), Reason::cannot_read) << "a folder";
}

TEST(OctomapWorld, survives_damaged_files) {
  const Scratch scratch;
  octomap::OcTree tree(0.1);
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 12; ++y)
      for (int z = 0; z < 8; ++z) mark(tree, x, y, z, z == 0 || x == 7);
  ASSERT_TRUE(load(scratch, tree));
  const std::string complete = *read_file(scratch.path("map.bt"));
  Random random(3);
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string content = complete;
    if (round % 2) content.resize(random.next() % content.size());
    for (int n = 0; n < 3 && !content.empty(); ++n)
      content[random.next() % content.size()] = static_cast<char>(random.next());
    refused += !read_octomap_file(scratch.write("bad.bt", content));
  }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace adit::sim
