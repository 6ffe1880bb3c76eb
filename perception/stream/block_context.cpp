// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/block_context.hpp"

#include "perception/stream/block_tables.hpp"

namespace adit::perception {
namespace {

enum class Question : std::uint8_t {
  fine,
  coarse,
  child,
  target,
  fine_occupied,
  fine_unknown,
  coarse_occupied,
  coarse_unknown,
  base,
  base_face,     ///< A neighbour of the base through a face is occupied.
  fine_changed,  ///< Neighbours that are coded and differ from the base.
  coarse_changed,
  parent_changed,
  base_occupied,
  base_unknown
};

struct Feature {
  Question question{};
  std::uint8_t which{};  ///< Neighbour, bit of the child, level or least number.
  std::uint8_t mask{};
};

constexpr std::array<std::uint8_t, 3> kFineMasks{kKnown, kOccupied, kNotCoded};
constexpr std::array<std::uint8_t, 4> kCoarseMasks{kKnown, kOccupied, kNotCoded, kFull};
constexpr std::array<int, 6> kFaces{4, 10, 12, 13, 15, 21};  ///< Neighbours through the faces.
constexpr std::array<std::uint8_t, 5> kFineOccupied{1, 2, 3, 4, 6};
constexpr std::array<std::uint8_t, 4> kFineUnknown{1, 2, 4, 7};
constexpr std::array<std::uint8_t, 5> kCoarseOccupied{1, 2, 4, 6, 9};
constexpr std::array<std::uint8_t, 5> kCoarseUnknown{1, 3, 6, 9, 13};
constexpr std::array<std::uint8_t, 3> kBaseMasks{kKnown, kOccupied, kFull};
constexpr std::array<std::uint8_t, 2> kParentMasks{kKnown | kFull, kOccupied};
constexpr std::array<std::uint8_t, 4> kFineChanged{1, 2, 3, 5};
constexpr std::array<std::uint8_t, 3> kCoarseChanged{1, 2, 4};
constexpr std::array<std::uint8_t, 3> kBaseOccupied{1, 3, 6};
constexpr std::array<std::uint8_t, 2> kBaseUnknown{1, 4};
constexpr int kBaseFeatures = 3 + 6 + 4 + 3 + 2 + 3 + 2;

// The order is part of the format: ids below kShortIds take one character in the tables.
constexpr auto kFeatures = [] {
  std::array<Feature, 3 * 26 + 4 * 26 + 6 + 3 + 2 + 19 + kBaseFeatures> out{};
  std::size_t n = 0;
  const auto add = [&](Question question, int which, std::uint8_t mask = 0) {
    out[n++] = {question, static_cast<std::uint8_t>(which), mask};
  };
  const auto is_face = [](int neighbour) {
    for (const int face : kFaces)
      if (face == neighbour) return true;
    return false;
  };
  for (int bit = 0; bit < 3; ++bit) add(Question::child, bit);
  for (const int face : kFaces)
    for (const std::uint8_t mask : kFineMasks) add(Question::fine, face, mask);
  for (const std::uint8_t count : kFineOccupied) add(Question::fine_occupied, count);
  for (const std::uint8_t count : kFineUnknown) add(Question::fine_unknown, count);
  for (const std::uint8_t count : kCoarseOccupied) add(Question::coarse_occupied, count);
  for (const std::uint8_t count : kCoarseUnknown) add(Question::coarse_unknown, count);
  for (const int face : kFaces)
    for (const std::uint8_t mask : kCoarseMasks) add(Question::coarse, face, mask);
  for (int neighbour = 0; neighbour < kNeighbours; ++neighbour)
    if (!is_face(neighbour))
      for (const std::uint8_t mask : kFineMasks) add(Question::fine, neighbour, mask);
  for (int neighbour = 0; neighbour < kNeighbours; ++neighbour)
    if (!is_face(neighbour))
      for (const std::uint8_t mask : kCoarseMasks) add(Question::coarse, neighbour, mask);
  for (const int face : kFaces) add(Question::fine, face, kFull);
  add(Question::target, 1);
  add(Question::target, 3);
  for (const std::uint8_t mask : kBaseMasks) add(Question::base, 0, mask);
  for (const int face : kFaces) add(Question::base_face, face, kOccupied);
  for (const std::uint8_t count : kFineChanged) add(Question::fine_changed, count);
  for (const std::uint8_t count : kCoarseChanged) add(Question::coarse_changed, count);
  for (const std::uint8_t mask : kParentMasks) add(Question::parent_changed, 0, mask);
  for (const std::uint8_t count : kBaseOccupied) add(Question::base_occupied, count);
  for (const std::uint8_t count : kBaseUnknown) add(Question::base_unknown, count);
  return out;
}();

int count(const std::uint8_t* centre, const std::array<std::int16_t, kNeighbours>& step, std::uint8_t mask,
          std::uint8_t state) {
  int out = 0;
  for (const std::int16_t to : step) out += (centre[to] & mask) == state ? 1 : 0;
  return out;
}

int count_changed(const std::uint8_t* now, const std::uint8_t* before,
                  const std::array<std::int16_t, kNeighbours>& step) {
  int out = 0;
  for (const std::int16_t to : step)
    out += ((now[to] | before[to]) & kNotCoded) == 0 && ((now[to] ^ before[to]) & (kKnown | kOccupied)) != 0
               ? 1
               : 0;
  return out;
}

// Text of the tables: characters from '#' to '~' without the backslash.
constexpr int kCharacters = 91;
constexpr int kShortIds = kCharacters - ContextTrees::kLeafValues - 2;
constexpr int kLongIds = ContextTrees::kLeafValues + kShortIds;  ///< Two characters that announce a second.
static_assert(static_cast<int>(kFeatures.size()) <= kShortIds + 2 * kCharacters);
constexpr char character(int value) {
  const int at = '#' + value;
  return static_cast<char>(at < '\\' ? at : at + 1);
}
constexpr int value_of(char c) {
  const int at = static_cast<unsigned char>(c);
  if (at < '#' || at > '~' || at == '\\') return -1;
  return (at < '\\' ? at : at - 1) - '#';
}

// 65536 / (1 + exp(-x)) at x = 0.45 (v - 17.5), v = 0..35, clamped to what the coder takes.
constexpr std::array<std::uint16_t, ContextTrees::kLeafValues> kLeafProbabilities{
    25,    39,    61,    96,    150,   236,   369,   576,   899,   1399,  2168,  3338,
    5088,  7642,  11240, 16062, 22110, 29097, 36439, 43426, 49474, 54296, 57894, 60448,
    62198, 63368, 64137, 64637, 64960, 65167, 65300, 65386, 65440, 65475, 65497, 65511};

constexpr int kDeepest = 64;
constexpr std::size_t kMaxNodes = 60000;

}  // namespace

int feature_count() { return static_cast<int>(kFeatures.size()); }

bool VoxelContext::test(int feature) const {
  const Feature& f = kFeatures[static_cast<std::size_t>(feature)];
  switch (f.question) {
    case Question::fine:
      return (fine[(*fine_step)[f.which]] & f.mask) != 0;
    case Question::coarse:
      return (coarse[(*coarse_step)[f.which]] & f.mask) != 0;
    case Question::child:
      return (child >> f.which & 1) != 0;
    case Question::target:
      return target == f.which;
    case Question::fine_occupied:
      return count(fine, *fine_step, kOccupied, kOccupied) >= f.which;
    case Question::fine_unknown:
      return count(fine, *fine_step, 0xff, kUnknown) >= f.which;
    case Question::coarse_occupied:
      return count(coarse, *coarse_step, kOccupied, kOccupied) >= f.which;
    case Question::coarse_unknown:
      return count(coarse, *coarse_step, 0xff, kUnknown) >= f.which;
    case Question::base:
      return base != nullptr && (base[0] & f.mask) != 0;
    case Question::base_face:
      return base != nullptr && (base[(*fine_step)[f.which]] & f.mask) != 0;
    case Question::fine_changed:
      return base != nullptr && count_changed(fine, base, *fine_step) >= f.which;
    case Question::coarse_changed:
      return coarse_base != nullptr && count_changed(coarse, coarse_base, *coarse_step) >= f.which;
    case Question::parent_changed:
      return coarse_base != nullptr && ((coarse[0] ^ coarse_base[0]) & f.mask) != 0;
    case Question::base_occupied:
      return base != nullptr && count(base, *fine_step, kOccupied, kOccupied) >= f.which;
    case Question::base_unknown:
      return base != nullptr && count(base, *fine_step, 0xff, kUnknown) >= f.which;
  }
  return false;
}

const ContextTrees& ContextTrees::built_in() {
  static const ContextTrees trees{std::string_view(kBlockTables, kBlockTablesSize)};
  return trees;
}

ContextTrees::ContextTrees(std::string_view text) {
  std::size_t at = 0;
  for (int tree = 0; tree < kDecisions; ++tree) {
    roots_[static_cast<std::size_t>(tree)] = static_cast<std::uint16_t>(nodes_.size());
    if (read(text, at, 0)) continue;
    nodes_.assign(1, {-1, 1u << 15});
    roots_.fill(0);
    return;
  }
}

bool ContextTrees::read(std::string_view text, std::size_t& at, int depth) {
  if (at >= text.size() || depth > kDeepest || nodes_.size() > kMaxNodes) return false;
  int value = value_of(text[at++]);
  if (value < 0) return false;
  if (value < kLeafValues) {
    nodes_.push_back({-1, static_cast<std::uint16_t>(leaf_probability(value))});
    return true;
  }
  int feature = value - kLeafValues;
  if (value >= kLongIds) {
    const int second = at < text.size() ? value_of(text[at++]) : -1;
    if (second < 0) return false;
    feature = kShortIds + (value - kLongIds) * kCharacters + second;
  }
  if (feature >= feature_count()) return false;
  const std::size_t node = nodes_.size();
  nodes_.push_back({static_cast<std::int16_t>(feature), 0});
  if (!read(text, at, depth + 1)) return false;
  nodes_[node].next = static_cast<std::uint16_t>(nodes_.size());
  return read(text, at, depth + 1);
}

std::uint32_t ContextTrees::leaf_probability(int value) {
  return kLeafProbabilities[static_cast<std::size_t>(value)];
}

void ContextTrees::append_leaf(std::string& text, int value) { text += character(value); }

void ContextTrees::append_inner(std::string& text, int feature) {
  if (feature < kShortIds) {
    text += character(kLeafValues + feature);
    return;
  }
  const int rest = feature - kShortIds;
  text += character(kLongIds + rest / kCharacters);
  text += character(rest % kCharacters);
}

}  // namespace adit::perception
