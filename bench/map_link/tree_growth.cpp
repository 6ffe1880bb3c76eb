// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/tree_growth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <queue>

namespace adit::bench {
namespace {

using perception::ContextTrees;

double cost(double no, double yes) {
  const double all = no + yes;
  const auto part = [all](double n) { return n > 0 ? -n * std::log2(n / all) : 0.0; };
  return part(no) + part(yes);
}

/// What a bit saved is worth: pieces of 0.2 m are what is sent most.
double weight_of(int decision) {
  decision %= perception::kDecisionsAlone;
  if (decision < perception::all_parts_known) return 4.0;
  return std::array{
      4.0, 3.0,
      1.0}[static_cast<std::size_t>(decision - perception::all_parts_known) / perception::kDecisionsOfLevel];
}

struct Leaf {
  double weight{1.0};
  std::vector<Sample> samples{};
  std::array<double, 2> count{};
  int feature{-1};
  double gain{0.0};
  std::unique_ptr<Leaf> no{}, yes{};
};

/// Finds the question that saves most.
void judge(Leaf& leaf) {
  const int features = perception::feature_count();
  std::vector<std::array<double, 2>> yes(static_cast<std::size_t>(features));
  leaf.count = {};
  for (const Sample& sample : leaf.samples) {
    leaf.count[0] += sample.count[0];
    leaf.count[1] += sample.count[1];
    for (std::size_t word = 0; word < sample.answers.size(); ++word)
      for (std::uint64_t bits = sample.answers[word]; bits != 0; bits &= bits - 1) {
        auto& counted = yes[64 * word + static_cast<std::size_t>(std::countr_zero(bits))];
        counted[0] += sample.count[0];
        counted[1] += sample.count[1];
      }
  }
  const double now = cost(leaf.count[0], leaf.count[1]);
  constexpr double kFewest = 60.0;
  for (int f = 0; f < features; ++f) {
    const auto& y = yes[static_cast<std::size_t>(f)];
    const double n0 = leaf.count[0] - y[0], n1 = leaf.count[1] - y[1];
    if (y[0] + y[1] < kFewest || n0 + n1 < kFewest) continue;
    const double gain = leaf.weight * (now - cost(n0, n1) - cost(y[0], y[1]));
    if (gain <= leaf.gain) continue;
    leaf.gain = gain;
    leaf.feature = f;
  }
}

void append(std::string& text, const Leaf& leaf) {
  if (leaf.no) {
    ContextTrees::append_inner(text, leaf.feature);
    append(text, *leaf.no);
    append(text, *leaf.yes);
    return;
  }
  const double one = (leaf.count[1] + 0.4) / (leaf.count[0] + leaf.count[1] + 0.8);
  int best = 0;
  double least = 1e300;
  for (int value = 0; value < ContextTrees::kLeafValues; ++value) {
    const double p = ContextTrees::leaf_probability(value) / 65536.0;
    const double bits = -one * std::log2(p) - (1.0 - one) * std::log2(1.0 - p);
    if (bits >= least) continue;
    least = bits;
    best = value;
  }
  ContextTrees::append_leaf(text, best);
}

}  // namespace

std::string grow_trees(const std::array<std::vector<Sample>, perception::kDecisions>& samples,
                       std::size_t max_characters, double min_gain) {
  std::array<Leaf, perception::kDecisions> roots;
  const auto less = [](const Leaf* a, const Leaf* b) { return a->gain < b->gain; };
  std::priority_queue<Leaf*, std::vector<Leaf*>, decltype(less)> open(less);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    roots[i].weight = weight_of(static_cast<int>(i));
    roots[i].samples = samples[i];
    judge(roots[i]);
    open.push(&roots[i]);
  }
  std::size_t characters = roots.size();
  while (!open.empty() && characters + 3 <= max_characters) {
    Leaf& leaf = *open.top();
    open.pop();
    if (leaf.gain < min_gain) break;
    leaf.no = std::make_unique<Leaf>();
    leaf.yes = std::make_unique<Leaf>();
    for (const Sample& sample : leaf.samples) {
      const bool is_yes =
          (sample.answers[static_cast<std::size_t>(leaf.feature) / 64] >> (leaf.feature % 64) & 1) != 0;
      (is_yes ? leaf.yes : leaf.no)->samples.push_back(sample);
    }
    leaf.no->weight = leaf.yes->weight = leaf.weight;
    leaf.samples.clear();
    leaf.samples.shrink_to_fit();
    std::string inner;
    ContextTrees::append_inner(inner, leaf.feature);
    characters += 1 + inner.size();
    for (Leaf* part : {leaf.no.get(), leaf.yes.get()}) {
      judge(*part);
      open.push(part);
    }
  }
  std::string text;
  for (const Leaf& root : roots) append(text, root);
  return text;
}

}  // namespace adit::bench
