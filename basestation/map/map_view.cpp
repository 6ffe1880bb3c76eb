// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_view.hpp"

#include <limits>
#include <utility>

#include "basestation/map/merged_map.hpp"

namespace adit::station {
namespace {

constexpr Duration kModelledView = std::chrono::milliseconds(200);
constexpr Duration kShortestPeriod = std::chrono::seconds(1);
constexpr double kViewResolution = 0.2;  // m

}  // namespace

void MapView::since(std::uint64_t revision, std::size_t most, Done done) {
  const bool current = merged_ == chunks_.revision() && merged_prior_ == prior_;
  const bool soon = begun_ && strand_.now() - *begun_ < kShortestPeriod;
  if (!running_ && (current || soon)) return answer(revision, most, done);
  waiting_.push_back([this, revision, most, done = std::move(done)] { answer(revision, most, done); });
  if (!running_) merge();
}

void MapView::merge() {
  running_ = true;
  begun_ = strand_.now();
  merged_ = chunks_.revision();
  merged_prior_ = prior_;
  strand_.compute(
      {.name = "map view", .modelled = kModelledView, .watchdog = std::chrono::seconds(60)},
      [parts = parts_of(chunks_), prior = prior_] {
        std::vector<MapTile> tiles = tiles_of(merged(parts, prior.get(), kViewResolution));
        add_received(tiles, parts, kViewResolution);
        return tiles;
      },
      [this, alive = std::weak_ptr(alive_)](Result<std::vector<MapTile>> tiles) {
        if (alive.expired()) return;
        running_ = false;
        if (tiles)
          tiles_.show(kViewResolution, std::move(*tiles));
        else
          merged_ = std::numeric_limits<std::uint64_t>::max();  // The next request begins it again.
        for (const auto& next : std::exchange(waiting_, {})) next();
      });
}

void MapView::answer(std::uint64_t revision, std::size_t most, const Done& done) const {
  MapUpdate update = tiles_.since(revision, most);
  update.clock = tile_clock(chunks_.clock(strand_.now()));
  const bool more = update.revision < tiles_.revision();
  done(std::move(update), more);
}

}  // namespace adit::station
