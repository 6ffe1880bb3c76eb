// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/exec/executor.hpp"
#include "perception/stream/piece.hpp"

namespace adit::agent {

/// A piece of a map to encode, as a value for another thread.
struct PieceJob {
  perception::SubmapKey key{};
  std::vector<perception::BlockUpdate> blocks{};
  std::map<perception::BlockIndex, perception::CoarseBlock> bases{};  ///< What all receivers have of them.
  std::size_t max_bytes{};

  perception::PackedPiece run() const {
    return perception::pack(
        key, blocks, max_bytes,
        [this](const perception::BlockIndex& index) -> std::optional<perception::CoarseBlock> {
          const auto base = bases.find(index);
          return base == bases.end() ? std::nullopt : std::optional(base->second);
        });
  }
};

inline constexpr Duration kPieceCoding = std::chrono::milliseconds(5);  ///< Of one piece in rehearsal.

/// Runs the work by `compute` of the strand, or, without one, at once.
template <class Work, class Done>
void compute_or_now(Executor* strand, JobSpec spec, Work work, Done done) {
  if (strand != nullptr)
    strand->compute(std::move(spec), std::move(work), std::move(done));
  else
    done(Result<job_value_t<Work>>(work()));
}

}  // namespace adit::agent
