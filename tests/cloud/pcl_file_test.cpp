// SPDX-License-Identifier: Apache-2.0
// .pcd and .ply files that the Point Cloud Library reads, whole and broken.
#include "sim/cloud/pcl_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "tests/folders/folders.hpp"

namespace adit::sim {
namespace {

class Pcd : public testing::Test {
 protected:
  std::filesystem::path folder_{scratch_folder()};
  Result<CloudFile> read(const std::string& text) {
    std::ofstream(folder_ / "a.pcd", std::ios::binary) << text;
    return read_cloud_file(folder_ / "a.pcd");
  }
};

std::string header(const std::string& data, int points = 2) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 2\nTYPE F F F U\nCOUNT 1 1 1 "
         "1\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 1 2 0.5 0.7071 0 0 0.7071\nPOINTS " +
         std::to_string(points) + "\nDATA " + data + "\n";
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

TEST_F(Pcd, Ascii) {
  const auto file = read(header("ascii") + "1 2 3 7\nnan 0 -1e-1 0\n");
  ASSERT_TRUE(file) << file.error().text;
  ASSERT_EQ(file->sweep.points.size(), 2u);
  EXPECT_EQ(file->sweep.points[0].position, Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(std::isnan(file->sweep.points[1].position.x()));
  EXPECT_EQ(file->viewpoint.position, Eigen::Vector3d(1, 2, 0.5));
  EXPECT_NEAR(file->viewpoint.yaw(), M_PI / 2, 1e-3);
}

TEST_F(Pcd, Binary) {
  std::string data;
  for (int i = 0; i < 2; ++i) {
    for (int a = 0; a < 3; ++a) put(data, static_cast<float>(10 * i + a));
    put(data, std::uint16_t{9});
  }
  const auto file = read(header("binary") + data);
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_EQ(file->sweep.points[1].position, Eigen::Vector3f(10, 11, 12));
  EXPECT_FALSE(read(header("binary") + data.substr(1)));
}

TEST_F(Pcd, BinaryCompressed) {
  // Field after field; x is twice the same, so that its second one is a copy of four bytes from four back.
  std::string packed;
  const auto literal = [&](std::string_view bytes) {
    packed.push_back(static_cast<char>(bytes.size() - 1));
    packed += bytes;
  };
  std::string x, rest;
  put(x, 5.0f);
  for (const float v : {1.0f, 2.0f, 3.0f, 4.0f}) put(rest, v);
  put(rest, std::uint32_t{0});
  literal(x);
  packed.push_back(static_cast<char>((4 - 2) << 5));
  packed.push_back(3);
  literal(rest);
  std::string data;
  put(data, static_cast<std::uint32_t>(packed.size()));
  put(data, std::uint32_t{28});
  const auto file = read(header("binary_compressed") + data + packed);
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_EQ(file->sweep.points[0].position, Eigen::Vector3f(5, 1, 3));
  EXPECT_EQ(file->sweep.points[1].position, Eigen::Vector3f(5, 2, 4));
  std::string damaged = packed;
  damaged[6] = 100;  // a copy from before the beginning
  EXPECT_FALSE(read(header("binary_compressed") + data + damaged));
}

TEST_F(Pcd, BrokenFilesAreOneLine) {
  const std::vector<std::string> broken{
      "",
      "garbage\n",
      header("ascii"),
      header("ascii") + "1 2\n3 4\n",
      header("zip"),
      header("ascii", 3) + "1 2 3 4\n",
      "FIELDS x y\nSIZE 4 4\nTYPE F F\nWIDTH 0\nHEIGHT 1\nDATA ascii\n",
      "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nDATA ascii\n",
      "FIELDS x y z\nWIDTH 99999999999\nDATA ascii\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 9000000\nHEIGHT 9000000\nDATA ascii\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F U\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 0 0 0 0\nDATA ascii\n1 2 3\n",
      header("binary_compressed") + "abc"};
  for (const std::string& text : broken) {
    const auto file = read(text);
    ASSERT_FALSE(file) << text;
    EXPECT_NE(file.error().text.find("a.pcd"), std::string::npos);
    EXPECT_EQ(file.error().text.find('\n'), std::string::npos);
  }
  EXPECT_FALSE(read_cloud_file(folder_ / "missing.pcd"));
}

TEST_F(Pcd, MutatedFilesDoNotCrash) {
  const std::string complete =
      header("binary_compressed") + std::string("\x0a\0\0\0\x1c\0\0\0", 8) + "0123456789";
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string text = complete;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random());
    const auto file = read(text);
    if (file) {
      EXPECT_LE(file->sweep.points.size(), 10'000'000u);
    }
  }
}

TEST_F(Pcd, TimesRingsAndWidePlacesAreRead) {
  const auto file = read(
      "VERSION 0.7\nFIELDS x y z t ring intensity\nSIZE 8 8 8 4 2 4\nTYPE F F F F U F\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n1 2 3 0.01 4 7\n1 2 4 0.09 5 8\n");
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_TRUE(file->sweep.timed);
  const perception::TimedPoint& last = file->sweep.points.back();
  EXPECT_EQ(last.position, Eigen::Vector3f(1, 2, 4));
  EXPECT_NEAR(last.time, 0.09f, 1e-6f);
  EXPECT_EQ(last.ring, 5);
  EXPECT_EQ(last.intensity, 8.0f);
}

TEST_F(Pcd, Ply) {
  const auto ply = [&](const std::string& text) {
    std::ofstream(folder_ / "a.ply", std::ios::binary) << text;
    return read_cloud_file(folder_ / "a.ply");
  };
  const std::string properties = "property float x\nproperty float y\nproperty float z\nend_header\n";
  const auto ascii = ply("ply\nformat ascii 1.0\nelement vertex 2\n" + properties + "1 2 3\n4 5 6\n");
  ASSERT_TRUE(ascii) << ascii.error().text;
  EXPECT_EQ(points_of(ascii->sweep), (PointCloud{{1, 2, 3}, {4, 5, 6}}));
  std::string data;
  for (const float v : {1.0f, 2.0f, 3.0f}) put(data, v);
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + properties;
  const auto binary = ply(head + data);
  ASSERT_TRUE(binary) << binary.error().text;
  EXPECT_EQ(points_of(binary->sweep), (PointCloud{{1, 2, 3}}));
  for (const std::string& text : {std::string(), std::string("ply\n"), "plx\n" + head, head,
                                  "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n" + properties,
                                  "ply\nformat ascii 1.0\nelement vertex 9000000\n" + properties}) {
    const auto broken = ply(text);
    ASSERT_FALSE(broken) << text;
    EXPECT_NE(broken.error().text.find("a.ply"), std::string::npos) << broken.error().text;
    EXPECT_EQ(broken.error().text.find('\n'), std::string::npos);
  }
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    std::string text = head + data;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random());
    const auto file = ply(text);
    if (file) {
      EXPECT_LE(file->sweep.points.size(), 10'000'000u);
    }
  }
}

}  // namespace
}  // namespace adit::sim
