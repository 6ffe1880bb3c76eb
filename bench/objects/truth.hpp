// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "perception/objects/object_detector.hpp"

namespace adit::bench {

/// Boxes in pixels of each picture, by its file's name.
struct TrueBox {
  double left{}, top{}, width{}, height{};
};
using Truth = std::map<std::string, std::vector<TrueBox>>;

/// Reads lines NAME LEFT TOP WIDTH HEIGHT. Throws std::runtime_error with the line that is wrong.
Truth read_truth(const std::string& file);

/// How the boxes of a detector agree with the truth.
struct Agreement {
  std::size_t objects{}, hits{}, false_alarms{};
};
/// An object is hit by a box that covers it by at least 40 % (intersection over union); each box counts once.
/// Boxes that cover an object that another box hit are no false alarms.
Agreement compare(const std::vector<perception::ObjectBox>& boxes, const std::vector<TrueBox>& truth,
                  double width, double height);

}  // namespace adit::bench
