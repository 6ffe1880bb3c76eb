// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "basestation/gui/scene/trails.hpp"
#include "basestation/gui/scene/voxel_painter.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::gui {

/// A floor of a building or a level of a mine.
struct Floor {
  double z{};          ///< Height of its ground, map frame, m.
  std::string name{};  ///< "0" for the floor where the station is, "-1" for the one below it.
  bool operator==(const Floor&) const = default;
};

/// The heights that are shown of a floor, m: what a robot could touch there.
inline Slice slice_of(const Floor& floor) { return {.low = floor.z - 0.3, .high = floor.z + 2.2}; }

/// Finds floors: heights at which robots drove or could drive, at least 2 m apart. A height counts only if it
/// stands out from those within 1 m of it, so a ramp makes no floors.
class Floors {
 public:
  static constexpr double kApart = 2.0;     ///< Least distance of floors, m.
  static constexpr double kFree = 1.0;      ///< Above what can be driven on, m.
  static constexpr double kCeiling = 8.0;   ///< Ground has a ceiling this far above it: others are roofs, m.
  static constexpr double kMinArea = 10.0;  ///< Of a floor, m2.
  static constexpr std::size_t kMost = 40;  ///< Floors that are named.

  /// Takes a newer map; only tiles that changed are read again.
  void show(const station::TileMap& map);
  /// Takes where robots are and were. True if the floors changed since the last call.
  bool show(const station::World& world, const Trails& trails);
  /// From below. With fewer than two the whole map is one floor.
  const std::vector<Floor>& floors() const { return floors_; }
  /// The floor on which something at that height stands: the highest one that is not above it by more than
  /// half a metre. Nothing without floors.
  std::optional<std::size_t> floor_at(double z) const;

 private:
  static constexpr double kBin = 0.2;       // m
  static constexpr int kBins = 2000;        // Heights from -200 m to 200 m.
  using Histogram = std::map<int, double>;  // Area by bin, m2.
  struct Tile {
    std::shared_ptr<const station::MapTile> tile{};
    Histogram ground{};
  };

  static int bin_of(double z);
  static Histogram ground_of(const station::MapTile& tile, double resolution);
  void learn_reference(const station::World& world);

  std::map<std::pair<int, int>, Tile> tiles_{};
  double resolution_{0.2};
  std::vector<double> ground_ = std::vector<double>(kBins);  ///< Sum of all tiles.
  std::optional<double> reference_{};                        ///< Height of floor "0", m.
  bool by_station_{false};                                   ///< The station's place said so.
  std::vector<Floor> floors_{};
};

/// What a slice shows of a tile, cell by cell as in MapTile, row by row from low y: heights are above the
/// slice's ground, and end below the first gap that a robot could drive through. Codes from kGhost on are of
/// what is on other floors alone.
inline constexpr std::uint8_t kGhost = 128;
void slice_cells(const station::MapTile& tile, double resolution, const Floor& floor,
                 std::vector<std::uint8_t>& cells);

/// The ground of a floor at a place, map frame, m; that of the floor where nothing was seen.
double ground_at(const station::TileMap& map, const Floor& floor, const Point& place);

}  // namespace adit::gui
