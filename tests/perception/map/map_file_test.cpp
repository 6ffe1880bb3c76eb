// SPDX-License-Identifier: Apache-2.0
#include "perception/map/export/map_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <ostream>

#include "tests/folders/folders.hpp"

namespace adit::perception {
namespace {

namespace fs = std::filesystem;

class MapFile : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int x = 0; x < 20; ++x)
      for (int y = 0; y < 20; ++y) {
        image_.set({x, y, -1}, Voxel::occupied);
        for (int z = 0; z < 5; ++z) image_.set({x, y, z}, x == 19 ? Voxel::occupied : Voxel::free);
      }
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  fs::path folder_{scratch_folder()};
  VoxelImage image_{};
};

TEST_F(MapFile, SavesEachFormatUnderItsNameAlone) {
  for (const char* name : {"a.bt", "a.ot", "a.pcd", "a.ply", "a.pgm"}) {
    const auto saved = save_map(image_, folder_ / name);
    EXPECT_TRUE(saved) << name;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"a.bt", "a.ot", "a.pcd", "a.pgm", "a.ply", "a.yaml"}));
  for (const char* name : {"a.bt", "a.ot"}) {
    const auto loaded = load_map(folder_ / name);
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->occupied(), image_.occupied());
    EXPECT_EQ(loaded->free_count(), image_.free_count());
  }
}

TEST_F(MapFile, SaysWhyItCannotSave) {
  const auto unknown = save_map(image_, folder_ / "a.stl");
  EXPECT_EQ(unknown.reason(), Reason::bad_argument);
  EXPECT_NE(unknown.error().text.find(".pcd"), std::string::npos);
  EXPECT_EQ(save_map(image_, folder_ / "none" / "a.bt").reason(), Reason::cannot_write);
  EXPECT_EQ(save_map(VoxelImage{}, folder_ / "a.bt").reason(), Reason::map_empty);
  EXPECT_EQ(save_map(VoxelImage{}, folder_ / "a.pgm").reason(), Reason::map_empty);
  EXPECT_EQ(save_map(image_, folder_ / "a.pgm", {.floor = 7}).reason(), Reason::out_of_range);
  EXPECT_TRUE(files().empty());
  EXPECT_EQ(save_map(image_, "/dev/full.bt/a.bt").reason(), Reason::cannot_write);
}

TEST_F(MapFile, AFailureLeavesTheOldFileAndNoPart) {
  ASSERT_TRUE(save_map(image_, folder_ / "a.bt"));
  const auto size = fs::file_size(folder_ / "a.bt");
  const auto failed = write_file_atomically(folder_ / "a.bt", [](std::ostream& to) -> Result<void> {
    to << "half";
    return {Reason::map_empty, "no more"};
  });
  EXPECT_EQ(failed.reason(), Reason::map_empty);
  EXPECT_EQ(fs::file_size(folder_ / "a.bt"), size);
  // A folder of that name: the rename fails after all was written.
  fs::create_directory(folder_ / "b.bt");
  std::ofstream(folder_ / "b.bt" / "inside") << "x";
  EXPECT_EQ(save_map(image_, folder_ / "b.bt").reason(), Reason::cannot_write);
  EXPECT_EQ(files(), (std::vector<std::string>{"a.bt", "b.bt"}));
}

TEST_F(MapFile, AFullDiskIsAReasonAndLeavesNothing) {
  fs::create_symlink("/dev/full", folder_ / "a.bt.part");
  const auto saved = save_map(image_, folder_ / "a.bt");
  EXPECT_EQ(saved.reason(), Reason::cannot_write);
  EXPECT_TRUE(files().empty());
}

TEST_F(MapFile, SaysWhyItCannotLoad) {
  EXPECT_EQ(load_map(folder_ / "none.bt").reason(), Reason::cannot_read);
  EXPECT_EQ(load_map(folder_).reason(), Reason::cannot_read);
  std::ofstream(folder_ / "a.bt") << "no map";
  const auto loaded = load_map(folder_ / "a.bt");
  EXPECT_EQ(loaded.reason(), Reason::syntax);
  EXPECT_NE(loaded.error().text.find("a.bt"), std::string::npos);
}

}  // namespace
}  // namespace adit::perception
