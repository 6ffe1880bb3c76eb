// SPDX-License-Identifier: Apache-2.0
#include "bench/objects/truth.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace adit::bench {
namespace {

constexpr double kHit = 0.4;

double overlap(const TrueBox& a, const TrueBox& b) {
  const double width = std::min(a.left + a.width, b.left + b.width) - std::max(a.left, b.left);
  const double height = std::min(a.top + a.height, b.top + b.height) - std::max(a.top, b.top);
  if (width <= 0.0 || height <= 0.0) return 0.0;
  return width * height / (a.width * a.height + b.width * b.height - width * height);
}

}  // namespace

Truth read_truth(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + " cannot be read");
  Truth out;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line);
    std::string name;
    TrueBox box;
    if (!(words >> name >> box.left >> box.top >> box.width >> box.height))
      throw std::runtime_error(file + ":" + std::to_string(number) + ": expected NAME LEFT TOP WIDTH HEIGHT");
    out[name].push_back(box);
  }
  return out;
}

Agreement compare(const std::vector<perception::ObjectBox>& boxes, const std::vector<TrueBox>& truth,
                  double width, double height) {
  Agreement out{.objects = truth.size()};
  std::vector<bool> hit(truth.size());
  for (const perception::ObjectBox& box : boxes) {
    const TrueBox pixels{box.left * width, box.top * height, box.width * width, box.height * height};
    std::size_t best = truth.size();
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (overlap(pixels, truth[i]) >= kHit &&
          (best == truth.size() || overlap(pixels, truth[i]) > overlap(pixels, truth[best])))
        best = i;
    if (best == truth.size())
      ++out.false_alarms;
    else
      hit[best] = true;
  }
  out.hits = static_cast<std::size_t>(std::ranges::count(hit, true));
  return out;
}

}  // namespace adit::bench
