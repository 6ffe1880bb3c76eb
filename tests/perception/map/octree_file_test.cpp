// SPDX-License-Identifier: Apache-2.0
#include "perception/map/export/octree_file.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <memory>
#include <random>
#include <sstream>

#include "perception/map/export/points_file.hpp"

namespace adit::perception {
namespace {

/// Free cubes, some of which OctoMap prunes, with occupied voxels in between.
VoxelImage sample() {
  VoxelImage image(0.1);
  std::mt19937 random(3);
  for (int x = -20; x < 20; ++x)
    for (int y = -16; y < 16; ++y)
      for (int z = 0; z < 8; ++z)
        image.set({x, y, z}, x < 0 || random() % 9 != 0 ? Voxel::free : Voxel::occupied);
  return image;
}

std::vector<std::pair<VoxelIndex, Voxel>> content(const VoxelImage& image) {
  std::vector<std::pair<VoxelIndex, Voxel>> out;
  image.for_each([&](const VoxelIndex& v, Voxel voxel) { out.push_back({v, voxel}); });
  return out;
}

std::string written(Result<void> (*write)(const VoxelImage&, std::ostream&), const VoxelImage& image) {
  std::ostringstream to;
  EXPECT_TRUE(write(image, to));
  return std::move(to).str();
}

std::size_t equal_voxels(const octomap::OcTree& tree, const VoxelImage& image) {
  std::size_t equal = 0;
  image.for_each([&](const VoxelIndex& v, Voxel voxel) {
    const Eigen::Vector3d c = image.centre(v);
    const octomap::OcTreeNode* node = tree.search(c.x(), c.y(), c.z());
    equal += node != nullptr && tree.isNodeOccupied(node) == (voxel == Voxel::occupied);
  });
  return equal;
}

TEST(OctreeFile, OctoMapReadsWhatWeWrite) {
  const VoxelImage image = sample();
  octomap::OcTree tree(1.0);
  std::istringstream bt(written(write_bt, image));
  ASSERT_TRUE(tree.readBinary(bt));
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.1);
  EXPECT_EQ(equal_voxels(tree, image), content(image).size());
  const std::size_t nodes = tree.calcNumNodes();
  EXPECT_EQ(tree.size(), nodes);
  tree.prune();
  EXPECT_EQ(tree.calcNumNodes(), nodes);  // Nothing was left to prune.
  std::istringstream ot(written(write_ot, image));
  const std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(ot));
  const auto* full = dynamic_cast<octomap::OcTree*>(any.get());
  ASSERT_NE(full, nullptr);
  EXPECT_EQ(equal_voxels(*full, image), content(image).size());
  EXPECT_EQ(full->calcNumNodes(), nodes);
}

TEST(OctreeFile, WeReadWhatOctoMapWrites) {
  const VoxelImage image = sample();
  octomap::OcTree tree(0.1);
  image.for_each([&](const VoxelIndex& v, Voxel voxel) {
    const Eigen::Vector3d c = image.centre(v);
    tree.updateNode(c.x(), c.y(), c.z(), voxel == Voxel::occupied);
  });
  std::ostringstream ot;
  tree.write(ot);
  std::ostringstream bt;
  tree.writeBinary(bt);
  for (const std::string& text : {ot.str(), bt.str()}) {
    const auto read = read_octree(text);
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_DOUBLE_EQ(read->resolution(), 0.1);
    EXPECT_EQ(content(*read), content(image));
  }
}

TEST(OctreeFile, ReportsTheErrorInAFile) {
  const auto reason = [](const std::string& text) { return read_octree(text).reason(); };
  EXPECT_EQ(reason(""), Reason::syntax);
  EXPECT_EQ(reason("ply\n"), Reason::syntax);
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nsize 1\n"), Reason::syntax);
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid ColorOcTree\nres 0.1\ndata\nxx"), Reason::not_supported);
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nres 0\ndata\nxx"), Reason::syntax);
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nres nan\ndata\nxx"), Reason::syntax);
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nres 0.1\ndata\n"), Reason::map_empty);
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nres 0.1\ndata\n" + std::string(2, char{0})),
            Reason::map_empty);
  // A leaf half as large as the tree.
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nres 0.1\ndata\n" + std::string("\1\0", 2)),
            Reason::not_supported);
  EXPECT_EQ(reason("# Octomap OcTree file\nid OcTree\nres 0.1\ndata\n" + std::string(5, '\0')),
            Reason::not_supported);
  // Deeper than a tree is.
  EXPECT_EQ(reason("# Octomap OcTree binary file\nid OcTree\nres 0.1\ndata\n" + std::string(400, '\3')),
            Reason::syntax);
  EXPECT_EQ(reason(written(write_bt, sample()) + "more"), Reason::syntax);
}

TEST(OctreeFile, RefusesAFileThatIsCutAtAnyByte) {
  for (const auto write : {write_bt, write_ot}) {
    const std::string complete = written(write, sample());
    for (std::size_t size = 0; size < complete.size(); size += 1 + complete.size() / 300)
      EXPECT_FALSE(read_octree(complete.substr(0, size))) << size;
  }
}

TEST(OctreeFile, DamagedFilesDoNoHarm) {
  std::mt19937 random(5);
  VoxelImage small(0.1);
  for (int x = -3; x < 3; ++x) small.set({x, 0, 0}, x == 0 ? Voxel::occupied : Voxel::free);
  for (const auto write : {write_bt, write_ot}) {
    const std::string complete = written(write, small);
    for (int n = 0; n < 40; ++n) {
      std::string text = complete;
      for (int i = 0; i < 3; ++i) text[random() % text.size()] = static_cast<char>(random());
      const auto read = read_octree(text);
      EXPECT_TRUE(read.ok() || !read.error().text.empty());
    }
  }
}

TEST(OctreeFile, AnEmptyMapIsNotWritten) {
  std::ostringstream to;
  EXPECT_EQ(write_bt(VoxelImage{}, to).reason(), Reason::map_empty);
  EXPECT_EQ(write_ot(VoxelImage{}, to).reason(), Reason::map_empty);
  EXPECT_EQ(write_pcd(VoxelImage{}, to).reason(), Reason::map_empty);
  EXPECT_EQ(write_ply(VoxelImage{}, to).reason(), Reason::map_empty);
  EXPECT_TRUE(to.str().empty());
  VoxelImage far(0.1);
  far.set({40000, 0, 0}, Voxel::free);
  EXPECT_EQ(write_bt(far, to).reason(), Reason::out_of_range);
}

TEST(PointsFile, HoldsTheCentresOfOccupiedVoxels) {
  VoxelImage image;
  image.set({1, 2, -3}, Voxel::occupied);
  image.set({0, 0, 0}, Voxel::free);
  for (const auto write : {static_cast<Result<void> (*)(const VoxelImage&, std::ostream&)>(write_pcd),
                           static_cast<Result<void> (*)(const VoxelImage&, std::ostream&)>(write_ply)}) {
    const std::string text = written(write, image);
    ASSERT_GT(text.size(), 12u);
    float values[3];
    std::memcpy(values, text.data() + text.size() - 12, 12);
    EXPECT_FLOAT_EQ(values[0], 0.3f);
    EXPECT_FLOAT_EQ(values[1], 0.5f);
    EXPECT_FLOAT_EQ(values[2], -0.5f);
    EXPECT_TRUE(text.ends_with(std::string("\n") + std::string(reinterpret_cast<char*>(values), 12)));
  }
  EXPECT_NE(written(write_pcd, image).find("POINTS 1\nDATA binary\n"), std::string::npos);
}

}  // namespace
}  // namespace adit::perception
