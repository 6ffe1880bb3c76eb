// SPDX-License-Identifier: Apache-2.0
#include "perception/vision/box_outputs.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr float kOverlap = 0.45f;      // Intersection over union of two boxes of one object.
constexpr std::size_t kMaxRaw = 4096;  // Boxes that are compared with each other.

std::string shapes(std::span<const OutputTensor> outputs) {
  std::string out;
  for (const OutputTensor& output : outputs) {
    out += out.empty() ? "[" : " and [";
    for (std::size_t i = 0; i < output.sides.size(); ++i)
      out += (i == 0 ? "" : ", ") + std::to_string(output.sides[i]);
    out += "]";
  }
  return out.empty() ? "nothing" : out;
}

/// Collects boxes with a sufficient score.
class Collector {
 public:
  Collector(double width, double height, double min_score)
      : width_(static_cast<float>(width)),
        height_(static_cast<float>(height)),
        min_score_(static_cast<float>(min_score)) {}

  /// In pixels.
  void add(std::size_t label, float score, float left, float top, float right, float bottom) {
    if (!(score >= min_score_)) return;
    RawBox box{label,
               std::min(score, 1.0f),
               std::clamp(left, 0.0f, width_),
               std::clamp(top, 0.0f, height_),
               std::clamp(right, 0.0f, width_),
               std::clamp(bottom, 0.0f, height_)};
    const bool finite =
        std::isfinite(left) && std::isfinite(top) && std::isfinite(right) && std::isfinite(bottom);
    if (finite && box.right - box.left >= 1.0f && box.bottom - box.top >= 1.0f) boxes.push_back(box);
  }
  void add_middle(std::size_t label, float score, float x, float y, float width, float height) {
    add(label, score, x - width / 2, y - height / 2, x + width / 2, y + height / 2);
  }
  /// In shares of the sides.
  void add_shares(std::size_t label, float score, std::span<const float> corners) {
    add(label, score, corners[0] * width_, corners[1] * height_, corners[2] * width_, corners[3] * height_);
  }

  std::vector<RawBox> boxes{};

 private:
  float width_, height_, min_score_;
};

/// [boxes, 5 + classes]
void read_yolo5(std::span<const float> values, std::size_t labels, Collector& out) {
  const std::size_t row = 5 + labels;
  for (std::size_t at = 0; at + row <= values.size(); at += row) {
    const auto box = values.subspan(at, row);
    const auto scores = box.subspan(5);
    const auto best = std::ranges::max_element(scores);
    out.add_middle(static_cast<std::size_t>(best - scores.begin()), box[4] * *best, box[0], box[1], box[2],
                   box[3]);
  }
}

/// [4 + classes, boxes]
void read_yolo8(std::span<const float> values, std::size_t labels, Collector& out) {
  const std::size_t count = values.size() / (4 + labels);
  const auto at = [&](std::size_t row, std::size_t box) { return values[row * count + box]; };
  for (std::size_t box = 0; box < count; ++box) {
    std::size_t best = 0;
    for (std::size_t label = 1; label < labels; ++label)
      if (at(4 + label, box) > at(4 + best, box)) best = label;
    out.add_middle(best, at(4 + best, box), at(0, box), at(1, box), at(2, box), at(3, box));
  }
}

/// [boxes, 7]: picture, class, score and corners.
void read_ssd(std::span<const float> values, std::size_t labels, bool background, Collector& out) {
  for (std::size_t at = 0; at + 7 <= values.size(); at += 7) {
    const float label = values[at + 1] - (background ? 1.0f : 0.0f);
    if (label >= 0.0f && label < static_cast<float>(labels))
      out.add_shares(static_cast<std::size_t>(label), values[at + 2], values.subspan(at + 3, 4));
  }
}

/// Corners [boxes, 4] and scores [boxes, columns]. `first`: column of the first class.
void read_two(std::span<const float> corners, std::span<const float> scores, std::size_t columns,
              std::size_t first, Collector& out) {
  for (std::size_t box = 0; box * 4 + 4 <= corners.size(); ++box) {
    const auto row = scores.subspan(box * columns, columns).subspan(first);
    const auto best = std::ranges::max_element(row);
    out.add_shares(static_cast<std::size_t>(best - row.begin()), *best, corners.subspan(box * 4, 4));
  }
}

bool is_whole(const OutputTensor& output) {
  std::size_t size = 1;
  for (const int side : output.sides) {
    if (side <= 0) return false;
    size *= static_cast<std::size_t>(side);
  }
  return size == output.values.size();
}

float area(const RawBox& box) { return (box.right - box.left) * (box.bottom - box.top); }

float overlap(const RawBox& a, const RawBox& b) {
  const float width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const float height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  if (width <= 0 || height <= 0) return 0;
  return width * height / (area(a) + area(b) - width * height);
}

}  // namespace

Result<std::vector<RawBox>> read_boxes(std::span<const OutputTensor> outputs, std::size_t labels,
                                       bool background, double width, double height, double min_score) {
  Collector out(width, height, min_score);
  const Error refused{Reason::malformed, "it returns " + shapes(outputs) +
                                             ", neither boxes of a YOLO nor of an SSD network for " +
                                             std::to_string(labels) +
                                             " classes, as many as there are labels"};
  if (labels == 0 || !std::ranges::all_of(outputs, is_whole)) return refused;
  const int classes = static_cast<int>(labels);
  if (outputs.size() == 1) {
    const OutputTensor& only = outputs[0];
    const std::vector<int>& sides = only.sides;
    if (sides.size() == 4 && sides[0] == 1 && sides[1] == 1 && sides[3] == 7) {
      read_ssd(only.values, labels, background, out);
    } else if (sides.size() == 3 && sides[0] == 1 && sides[2] == 5 + classes) {
      read_yolo5(only.values, labels, out);
    } else if (sides.size() == 3 && sides[0] == 1 && sides[1] == 4 + classes) {
      read_yolo8(only.values, labels, out);
    } else {
      return refused;
    }
    return std::move(out.boxes);
  }
  if (outputs.size() != 2) return refused;
  for (const std::size_t corners : {std::size_t{0}, std::size_t{1}}) {
    const OutputTensor& box = outputs[corners];
    const OutputTensor& score = outputs[1 - corners];
    if (box.sides.size() != 3 || score.sides.size() != 3 || box.sides[0] != 1 || score.sides[0] != 1)
      continue;
    if (box.sides[2] != 4 || box.sides[1] != score.sides[1]) continue;
    const int columns = score.sides[2];
    if (columns != classes && columns != classes + 1) continue;
    read_two(box.values, score.values, static_cast<std::size_t>(columns),
             static_cast<std::size_t>(columns - classes), out);
    return std::move(out.boxes);
  }
  return refused;
}

std::vector<RawBox> without_overlaps(std::vector<RawBox> boxes, std::size_t max) {
  std::ranges::stable_sort(boxes, [](const RawBox& a, const RawBox& b) { return a.score > b.score; });
  if (boxes.size() > kMaxRaw) boxes.resize(kMaxRaw);
  std::vector<RawBox> out;
  for (const RawBox& box : boxes) {
    if (out.size() >= max) break;
    const bool known = std::ranges::any_of(
        out, [&](const RawBox& other) { return other.label == box.label && overlap(other, box) > kOverlap; });
    if (!known) out.push_back(box);
  }
  return out;
}

}  // namespace adit::perception
