// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace adit::perception {

/// What both sides know of a voxel while they code: bits.
constexpr std::uint8_t kUnknown = 0;
constexpr std::uint8_t kKnown = 1;
constexpr std::uint8_t kOccupied = 2;  ///< Always with kKnown.
constexpr std::uint8_t kNotCoded = 4;  ///< Or its block is not in the piece.
constexpr std::uint8_t kFull = 8;      ///< Free, and all its parts are known.

/// Decisions that are coded, each with a tree of contexts of its own. Those of levels 1 to 3 follow each
/// other in steps of kDecisionsOfLevel.
enum Decision : std::uint8_t {
  block_present,  ///< A block of the box around all of them.
  block_known,
  block_occupied,
  block_uniform,    ///< All voxels of a free block are free.
  all_parts_known,  ///< Of a free voxel of the level above.
  part_known_of_free,
  part_known_of_occupied,
  part_occupied
};
constexpr int kDecisionsOfLevel = 4;
constexpr int kDecisionsAlone = block_uniform + 1 + 3 * kDecisionsOfLevel;
constexpr int decision_at(Decision decision, int level) { return decision + (level - 1) * kDecisionsOfLevel; }
/// The same decisions about blocks of which the receiver has an older state, the base, have trees of their
/// own.
constexpr int with_base(int decision) { return decision + kDecisionsAlone; }
constexpr int kDecisions = 2 * kDecisionsAlone;

constexpr int kNeighbours = 26;
/// Offset of a neighbour, [-1, 1]: z slowest, the voxel itself left out.
constexpr std::array<int, 3> neighbour_offset(int n) {
  const int cell = n < 13 ? n : n + 1;
  return {cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
}

/// Surroundings of the voxel that is coded: its neighbours on its own level as far as they are coded, those
/// of its parent, and the base of both. Features are questions about them with the answer yes or no.
struct VoxelContext {
  const std::uint8_t* fine{};                                ///< The voxel in an array with a margin of one.
  const std::array<std::int16_t, kNeighbours>* fine_step{};  ///< To its neighbours.
  const std::uint8_t* coarse{};                              ///< Its parent, the same way.
  const std::array<std::int16_t, kNeighbours>*
      coarse_step{};                  ///< Mirrored: positive is outward of the parent.
  int child{};                        ///< Which part of the parent: x + 2 y + 4 z.
  int target{};                       ///< Level of the voxels that are coded in the end.
  const std::uint8_t* base{};         ///< As `fine`, of the base; null: the block has none.
  const std::uint8_t* coarse_base{};  ///< As `coarse`, of the base; null: no base, or no parent.

  bool test(int feature) const;
};

/// Number of features: see features() in the source.
int feature_count();

/// A tree of contexts for each decision, as in B. Martins and S. Forchhammer, Tree coding of bilevel images
/// (1998): each inner node asks for a feature of the surroundings, each leaf is a probability.
class ContextTrees {
 public:
  struct Node {
    std::int16_t feature{-1};  ///< -1: leaf.
    std::uint16_t next{};      ///< Node for yes, the one for no follows; of a leaf, the probability of yes.
  };

  /// The tables in the source. Version: 4 bits; pieces name it, as only equal tables decode.
  static const ContextTrees& built_in();
  static constexpr std::uint8_t kVersion = 2;

  /// Reads trees from printable text; every one is a single leaf of one half if the text is not of kDecisions
  /// trees.
  explicit ContextTrees(std::string_view text);

  /// Leaf of a decision.
  std::size_t leaf(int decision, const VoxelContext& context) const {
    std::size_t at = roots_[static_cast<std::size_t>(decision)];
    while (nodes_[at].feature >= 0) at = context.test(nodes_[at].feature) ? nodes_[at].next : at + 1;
    return at;
  }
  const std::vector<Node>& nodes() const { return nodes_; }

  /// Leaves have one of kLeafValues probabilities, spaced evenly in log-odds.
  static constexpr int kLeafValues = 36;
  static std::uint32_t leaf_probability(int value);
  /// Characters of a node in the text.
  static void append_leaf(std::string& text, int value);
  static void append_inner(std::string& text, int feature);

 private:
  bool read(std::string_view text, std::size_t& at, int depth);

  std::array<std::uint16_t, kDecisions> roots_{};
  std::vector<Node> nodes_{};
};

}  // namespace adit::perception
