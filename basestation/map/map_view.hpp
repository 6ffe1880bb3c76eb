// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "basestation/map/tiles.hpp"
#include "core/exec/executor.hpp"

namespace adit::station {

class ChunkStore;

/// The map of all robots seen from above, for front ends. It is merged at most once a second, on a thread of
/// the pool, so that it delays no command.
class MapView {
 public:
  using Done = std::function<void(MapUpdate update, bool more)>;
  using Prior = std::shared_ptr<const perception::VoxelImage>;

  /// `chunks` and `prior` (what the crew had; null: nothing) must outlive the view.
  MapView(Executor& strand, const ChunkStore& chunks, const Prior& prior)
      : strand_(strand), chunks_(chunks), prior_(prior) {}

  /// Passes what changed after that revision to `done`, at most `most` tiles, once the view is complete.
  void since(std::uint64_t revision, std::size_t most, Done done);

 private:
  void merge();
  void answer(std::uint64_t revision, std::size_t most, const Done& done) const;

  Executor& strand_;
  const ChunkStore& chunks_;
  const Prior& prior_;
  Tiles tiles_{};
  std::uint64_t merged_{};                        ///< Revision of the map that the tiles show.
  Prior merged_prior_{};                          ///< And what the crew had then.
  std::optional<Time> begun_{};                   ///< The last time that a merge was begun.
  bool running_{false};                           ///< A merge is running.
  std::vector<std::function<void()>> waiting_{};  ///< Requests that are answered when it is complete.
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
