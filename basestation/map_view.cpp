// SPDX-License-Identifier: Apache-2.0
// The map seen from above, for front ends. Merging runs on a thread of the pool, so that it delays no
// command.
#include <limits>
#include <utility>

#include "basestation/map/merged_map.hpp"
#include "basestation/map/tile_ages.hpp"
#include "basestation/station_impl.hpp"

namespace adit::station {
namespace {

constexpr Duration kModelledView = std::chrono::milliseconds(200);
constexpr Duration kShortestPeriod = std::chrono::seconds(1);
constexpr double kViewResolution = 0.2;  // m

}  // namespace

void Station::Impl::map_since(std::uint64_t revision, std::size_t most, MapDone done) {
  const bool current = view_.chunks == map_.chunks().revision() && view_.prior == prior_;
  const bool soon = view_.begun && strand_.now() - *view_.begun < kShortestPeriod;
  if (!view_.running && (current || soon)) return answer_tiles(revision, most, done);
  view_.waiting.push_back(
      [this, revision, most, done = std::move(done)] { answer_tiles(revision, most, done); });
  if (view_.running) return;
  view_.running = true;
  view_.begun = strand_.now();
  view_.chunks = map_.chunks().revision();
  view_.prior = prior_;
  strand_.compute(
      {.name = "map view", .modelled = kModelledView, .watchdog = std::chrono::seconds(60)},
      [parts = parts_of(map_.chunks()), prior = prior_] {
        std::vector<MapTile> tiles = tiles_of(merged(parts, prior.get(), kViewResolution));
        add_received(tiles, parts, kViewResolution);
        return tiles;
      },
      [this, alive = std::weak_ptr(alive_)](Result<std::vector<MapTile>> tiles) {
        if (alive.expired()) return;
        view_.running = false;
        if (tiles)
          view_.tiles.show(kViewResolution, std::move(*tiles));
        else
          view_.chunks = std::numeric_limits<std::uint64_t>::max();  // The next request begins it again.
        for (const auto& answer : std::exchange(view_.waiting, {})) answer();
      });
}

void Station::Impl::answer_tiles(std::uint64_t revision, std::size_t most, const MapDone& done) const {
  MapUpdate update = view_.tiles.since(revision, most);
  update.clock = tile_clock(map_.chunks().clock(strand_.now()));
  const bool more = update.revision < view_.tiles.revision();
  done(std::move(update), more);
}

}  // namespace adit::station
