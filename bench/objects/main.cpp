// SPDX-License-Identifier: Apache-2.0
// bench_objects: what a detector finds in the pictures of a folder, and how long it takes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "bench/camera/frames.hpp"
#include "bench/objects/truth.hpp"
#include "perception/vision/vision_detector.hpp"

namespace {

using namespace adit;
using namespace adit::perception;

struct Options {
  std::string folder{}, truth{}, draw{};
  std::size_t pictures{1000};
  DetectorParams detector{};
};

void draw_box(Picture& picture, const ObjectBox& box) {
  const auto at = [](double share, std::uint32_t side) {
    return std::min(side - 1, static_cast<std::uint32_t>(share * side));
  };
  const std::uint32_t left = at(box.left, picture.width), right = at(box.left + box.width, picture.width);
  const std::uint32_t top = at(box.top, picture.height), bottom = at(box.top + box.height, picture.height);
  const auto set = [&picture](std::uint32_t x, std::uint32_t y) {
    std::uint8_t* pixel = &picture.bytes[(std::size_t{y} * picture.width + x) * picture.channels];
    for (int c = 0; c < picture.channels; ++c) pixel[c] = c == 1 ? 255 : 0;
  };
  for (std::uint32_t x = left; x <= right; ++x) set(x, top), set(x, bottom);
  for (std::uint32_t y = top; y <= bottom; ++y) set(left, y), set(right, y);
}

Picture scaled(const Picture& picture, std::uint32_t side) {
  const RawPicture raw{picture.width,
                       picture.height,
                       picture.width * picture.channels,
                       picture.channels == 3 ? "rgb8" : "mono8",
                       false,
                       picture.bytes};
  return convert(raw, side, side).value();
}

int run(const Options& options) {
  auto detector = make_vision_detector(options.detector);
  if (!detector) {
    fmt::print(stderr, "bench_objects: {}\n", detector.error().text);
    return 1;
  }
  const auto pictures = bench::frames_of(options.folder, options.pictures);
  const auto names = bench::frame_names(options.folder, options.pictures);
  const bench::Truth truth = options.truth.empty() ? bench::Truth{} : bench::read_truth(options.truth);
  std::vector<double> times;
  bench::Agreement all;
  std::size_t boxes_of_all = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    Picture picture = scaled(pictures[i], (*detector)->picture_side());
    const auto start = std::chrono::steady_clock::now();
    const auto boxes = (*detector)->detect(picture);
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    if (!boxes) throw std::runtime_error(names[i] + ": " + boxes.error().text);
    boxes_of_all += boxes->size();
    if (const auto known = truth.find(names[i]); !truth.empty()) {
      const bench::Agreement here =
          compare(*boxes, known == truth.end() ? std::vector<bench::TrueBox>{} : known->second,
                  pictures[i].width, pictures[i].height);
      all.objects += here.objects;
      all.hits += here.hits;
      all.false_alarms += here.false_alarms;
    }
    if (options.draw.empty()) continue;
    for (const ObjectBox& box : *boxes) draw_box(picture, box);
    const auto jpeg = encode_jpeg(picture, 90);
    const auto name = std::filesystem::path(names[i]).stem().string() + "_boxes.jpg";
    std::ofstream(std::filesystem::path(options.draw) / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
  }
  std::ranges::sort(times);
  fmt::print("{} pictures, {} boxes; median {:.0f} ms of one processor, longest {:.0f} ms\n", pictures.size(),
             boxes_of_all, times[times.size() / 2], times.back());
  if (!truth.empty())
    fmt::print(
        "{} of {} objects found ({:.0f} %), {} false alarms ({:.2f} a picture)\n", all.hits, all.objects,
        100.0 * static_cast<double>(all.hits) / static_cast<double>(std::max<std::size_t>(1, all.objects)),
        all.false_alarms, static_cast<double>(all.false_alarms) / static_cast<double>(pictures.size()));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"What a detector of objects finds in pictures. Without --model: OpenCV's detector of people."};
  app.footer(
      "examples:\n"
      "  bench_objects photos                                          people in the JPEGs of a folder\n"
      "  bench_objects photos --truth boxes.txt --draw out             compared with boxes, and drawn\n"
      "  bench_objects photos --model yolo.onnx --labels classes.txt   with a network");
  Options options;
  app.add_option("folder", options.folder, "JPEG and PPM files")->required()->check(CLI::ExistingDirectory);
  app.add_option("--model", options.detector.model, "An ONNX file");
  app.add_option("--labels", options.detector.labels, "Its classes, one a line");
  app.add_option("--mean", options.detector.mean, "Of the model's input");
  app.add_option("--scale", options.detector.scale, "Of the model's input");
  app.add_option("--min-score", options.detector.min_score, "Boxes below it are left out")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--truth", options.truth, "Lines NAME LEFT TOP WIDTH HEIGHT, in pixels");
  app.add_option("--draw", options.draw, "Folder for the pictures with boxes")->check(CLI::ExistingDirectory);
  app.add_option("--pictures", options.pictures, "At most so many");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_objects: {}\n", error.what());
    return 1;
  }
}
