// SPDX-License-Identifier: Apache-2.0
#include "bench/camera/frames.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace adit::bench {
namespace {

using perception::Picture;

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file && !file.eof()) throw std::runtime_error(path.string() + " cannot be read");
  return bytes;
}

/// A binary PPM without comments.
Picture ppm(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = bytes_of(path);
  std::istringstream text(std::string(
      bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 64))));
  std::string magic;
  std::uint32_t width = 0, height = 0, most = 0;
  text >> magic >> width >> height >> most;
  const std::size_t size = std::size_t{3} * width * height;
  if (magic != "P6" || most != 255 || size == 0 || bytes.size() < size)
    throw std::runtime_error(path.string() + " is no PPM of 8 bits");
  return {width, height, 3, {bytes.end() - static_cast<std::ptrdiff_t>(size), bytes.end()}};
}

std::uint32_t mixed(std::uint32_t x, std::uint32_t y) {
  std::uint32_t value = x * 0x9e3779b9U ^ y * 0x85ebca6bU;
  value = (value ^ value >> 15) * 0x2c1b3c6dU;
  return value ^ value >> 13;
}

/// Noise that is smooth over `cell` pixels, in [0, 1].
double smooth_noise(std::uint32_t x, std::uint32_t y, std::uint32_t cell) {
  const auto corner = [](std::uint32_t u, std::uint32_t v) { return (mixed(u, v) & 0xffff) / 65535.0; };
  const std::uint32_t u = x / cell, v = y / cell;
  const double a = static_cast<double>(x % cell) / cell, b = static_cast<double>(y % cell) / cell;
  return (corner(u, v) * (1 - a) + corner(u + 1, v) * a) * (1 - b) +
         (corner(u, v + 1) * (1 - a) + corner(u + 1, v + 1) * a) * b;
}

std::vector<std::filesystem::path> paths_of(const std::string& folder, std::size_t most) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const auto kind = entry.path().extension(); kind == ".jpg" || kind == ".jpeg" || kind == ".ppm")
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  paths.resize(std::min(paths.size(), most));
  if (paths.empty()) throw std::runtime_error(folder + " has no .jpg, .jpeg and .ppm");
  return paths;
}

}  // namespace

std::vector<std::string> frame_names(const std::string& folder, std::size_t most) {
  std::vector<std::string> out;
  for (const auto& path : paths_of(folder, most)) out.push_back(path.filename().string());
  return out;
}

std::vector<Picture> frames_of(const std::string& folder, std::size_t most) {
  std::vector<Picture> out;
  for (const auto& path : paths_of(folder, most)) {
    if (path.extension() == ".ppm") {
      out.push_back(ppm(path));
      continue;
    }
    auto picture =
        perception::decode_jpeg(bytes_of(path), perception::kMaxPictureSide, perception::kMaxPictureSide);
    if (!picture) throw std::runtime_error(path.string() + ": " + picture.error().text);
    out.push_back(std::move(*picture));
  }
  return out;
}

std::vector<Picture> made_up_frames(std::size_t count, std::uint32_t shift) {
  constexpr std::uint32_t kWidth = 1280, kHeight = 720;
  std::vector<Picture> out;
  for (std::uint32_t frame = 0; frame < count; ++frame) {
    Picture picture{kWidth, kHeight, 3, std::vector<std::uint8_t>(std::size_t{3} * kWidth * kHeight)};
    std::uint8_t* pixel = picture.bytes.data();
    for (std::uint32_t y = 0; y < kHeight; ++y)
      for (std::uint32_t x = 0; x < kWidth; ++x, pixel += 3) {
        const std::uint32_t u = x + shift * frame;
        double shade =
            110 * smooth_noise(u, y, 160) + 60 * smooth_noise(u, y, 24) + 40 * smooth_noise(u, y, 5);
        const bool panel = mixed(u / 90, y / 70) % 3 == 0;
        if (panel) shade += 45;
        const std::uint32_t left = 100 + 12 * frame % 1000;
        const bool object = x >= left && x < left + 80 && y >= 300 && y < 420;
        if (object) shade = 40 + mixed(x - left, y) % 60;
        const int noise = static_cast<int>(mixed(x + 7919 * frame, y) % 7) - 3;
        const double red = shade + (object ? 60 : 0), blue = shade - (panel ? 35 : 0);
        pixel[0] = static_cast<std::uint8_t>(std::clamp(red + noise, 0.0, 255.0));
        pixel[1] = static_cast<std::uint8_t>(std::clamp(shade + noise, 0.0, 255.0));
        pixel[2] = static_cast<std::uint8_t>(std::clamp(blue + noise, 0.0, 255.0));
      }
    out.push_back(std::move(picture));
  }
  return out;
}

}  // namespace adit::bench
