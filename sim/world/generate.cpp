// SPDX-License-Identifier: Apache-2.0
#include "sim/world/generate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/time/random.hpp"
#include "sim/world/flights.hpp"

namespace adit::sim {
namespace {

constexpr double kOuterWallThickness = 0.2;    ///< m
constexpr double kInnerWallThickness = 0.2;    ///< m
constexpr double kCeilingHeight = 3.0;         ///< Walls reach up to it, m.
constexpr double kStartClearanceRadius = 1.0;  ///< No obstacle comes closer to the start, m.

/// Builds a world from boxes on a floor at height 0. Coordinates are in the world frame, m; x runs from 0 to
/// the width and y from 0 to the depth of the floor.
class Builder {
 public:
  /// A floor of that size with walls around it.
  Builder(double width, double depth, Eigen::Vector2d start) {
    constexpr double t = kOuterWallThickness;
    world_.size = {width, depth};
    world_.start = start;
    add_wall(-t, width + t, -t, 0.0);
    add_wall(-t, width + t, depth, depth + t);
    add_wall(-t, 0.0, 0.0, depth);
    add_wall(width, width + t, 0.0, depth);
  }
  /// Adds a box from the floor to the ceiling.
  void add_wall(double x0, double x1, double y0, double y1) { add_box(x0, x1, y0, y1, kCeilingHeight); }
  /// Adds a box from the floor up to `height`.
  void add_box(double x0, double x1, double y0, double y1, double height) {
    world_.boxes.push_back({x0, x1, y0, y1, 0.0, height});
  }
  /// Adds a box centred on (x, y), unless it would come within kStartClearanceRadius of the start.
  void add_obstacle(double x, double y, double length, double width, double height) {
    const double dx = std::max(0.0, std::abs(x - world_.start.x()) - length / 2);
    const double dy = std::max(0.0, std::abs(y - world_.start.y()) - width / 2);
    if (std::hypot(dx, dy) < kStartClearanceRadius) return;
    add_box(x - length / 2, x + length / 2, y - width / 2, y + width / 2, height);
  }
  GeneratedWorld take() { return std::move(world_); }

 private:
  GeneratedWorld world_{};
};

/// A corridor 50 m long and 4 m wide with boxes along both walls. At least 1.4 m stay free between them.
GeneratedWorld corridor(Random random) {
  constexpr double corridor_width = 4.0;
  Builder b(50.0, corridor_width, {1.5, 2.0});
  for (double x = 3.5; x < 48.0; x += random.uniform(1.6, 2.6)) {
    const double width = random.uniform(0.3, 1.3), length = random.uniform(0.3, 0.8);
    const double height = random.uniform(0.3, 1.8);
    b.add_obstacle(x, random.chance(0.5) ? width / 2 : corridor_width - width / 2, length, width, height);
  }
  return b.take();
}

constexpr double kStreet = 3.2, kBlock = 8.0;  ///< Widths, m.

/// Corners with the smallest x and y of blocks in a square of `size` x `size`.
std::vector<Eigen::Vector2d> block_corners(int size) {
  std::vector<Eigen::Vector2d> out;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j)
      out.emplace_back(kStreet + i * (kBlock + kStreet), kStreet + j * (kBlock + kStreet));
  return out;
}

double blocks_side(int size) { return size * kBlock + (size + 1) * kStreet; }

/// 3 x 3 blocks of 8 m with streets of 3.2 m between and around them (docs/references.md, FAR Planner).
GeneratedWorld blocks(Random) {
  constexpr int size = 3;
  const double side = blocks_side(size);
  Builder b(side, side, {kStreet / 2, kStreet / 2});
  for (const Eigen::Vector2d& corner : block_corners(size))
    b.add_wall(corner.x(), corner.x() + kBlock, corner.y(), corner.y() + kBlock);
  return b.take();
}

constexpr double kStreetBox = 0.5;  ///< Edge of the boxes in the streets, m.
constexpr std::size_t kStreetBoxes = 10;
using StreetBoxes = std::array<std::array<double, 2>, kStreetBoxes>;

/// Corners with the smallest x and y of the boxes in the worlds that TARE was measured in, m.
constexpr StreetBoxes kBoxesOf3{{{2.050, 29.420},
                                 {2.050, 30.876},
                                 {11.450, 21.547},
                                 {33.850, 18.710},
                                 {8.657, 13.250},
                                 {25.399, 2.050},
                                 {13.250, 7.763},
                                 {33.850, 11.282},
                                 {13.250, 11.951},
                                 {20.577, 22.650}}};
constexpr StreetBoxes kBoxesOf5{{{13.250, 48.925},
                                 {13.250, 51.453},
                                 {22.650, 35.250},
                                 {45.050, 30.322},
                                 {12.862, 13.250},
                                 {41.940, 2.050},
                                 {24.450, 11.309},
                                 {56.250, 17.422},
                                 {24.450, 18.583},
                                 {33.565, 33.850}}};

/// Boxes on either side of the streets, as in those worlds: 0.25 m from the one wall, or 0.65 m from the
/// other. None stands within 2 m of the start.
StreetBoxes draw_street_boxes(int size, std::uint64_t seed) {
  constexpr std::array kAcross{0.25, 2.05};  // m from the street's edge
  Random random(seed);
  StreetBoxes out{};
  for (std::size_t n = 0; n < out.size();) {
    const auto street = static_cast<double>(random.below(static_cast<std::uint64_t>(size) + 1));
    const double across = street * (kBlock + kStreet) + kAcross[random.below(kAcross.size())];
    const double along = random.uniform(kStreetBox, blocks_side(size) - 2 * kStreetBox);
    const bool along_x = random.chance(0.5);
    const std::array<double, 2> corner{along_x ? along : across, along_x ? across : along};
    if (std::max(corner[0], corner[1]) > kStreet / 2 + 2) out[n++] = corner;
  }
  return out;
}

/// A car park with pillars, two rows of parked cars, and a ramp of 12 % up to a deck 1.2 m high.
GeneratedWorld car_park(Random random) {
  Builder b(40.0, 30.0, {2.0, 2.0});
  for (double x = 8.0; x < 39.0; x += 8.0)
    for (double y = 6.0; y < 20.0; y += 6.0) b.add_obstacle(x, y, 0.5, 0.5, kCeilingHeight);
  for (double x = 5.0; x < 38.0; x += 3.0)
    for (const double y : {9.0, 15.0})
      if (random.chance(0.6)) b.add_obstacle(x, y + random.uniform(-0.3, 0.3), 1.8, 4.2, 1.5);
  // The ramp consists of steps 6 cm high, which every wheeled platform climbs. Rise and run of a step, m.
  constexpr double rise = 0.06, run = 0.5, deck_height = 1.2;
  constexpr int steps = static_cast<int>(deck_height / rise);
  for (int n = 0; n < steps; ++n) b.add_box(4.0 + n * run, 4.0 + (n + 1) * run, 22.0, 26.0, (n + 1) * rise);
  b.add_box(4.0 + steps * run, 36.0, 22.0, 30.0, deck_height);
  return b.take();
}

/// The rock of a cave: square cells, solid or open, grown by a cellular automaton (L. Johnson et al., 2010,
/// docs/references.md).
class CaveRock {
 public:
  static constexpr int kCells = 60;         ///< Number of cells along each side.
  static constexpr double kCellSize = 0.5;  ///< m

  /// Draws every cell at random, solid with that probability.
  CaveRock(Random& random, double solid_share) {
    for (auto& solid : solid_) solid = random.chance(solid_share);
  }

  bool solid(int i, int j) const { return solid_[index(i, j)] != 0; }
  void open(int i, int j) { solid_[index(i, j)] = 0; }

  /// One round of the automaton: a cell becomes solid if at least 5 of the 9 cells around and at it are.
  void grow() {
    const CaveRock before = *this;
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) solid_[index(i, j)] = before.solid_neighbours(i, j) >= 5;
  }

 private:
  static std::size_t index(int i, int j) {
    return static_cast<std::size_t>(j) * kCells + static_cast<std::size_t>(i);
  }
  /// Number of solid cells among the 9 around and at (i, j); cells outside of the cave count as solid.
  int solid_neighbours(int i, int j) const {
    int count = 0;
    for (int b = j - 1; b <= j + 1; ++b)
      for (int a = i - 1; a <= i + 1; ++a) {
        const bool outside = a < 0 || b < 0 || a >= kCells || b >= kCells;
        if (outside || solid(a, b)) ++count;
      }
    return count;
  }

  std::vector<std::uint8_t> solid_ = std::vector<std::uint8_t>(static_cast<std::size_t>(kCells) * kCells);
};

/// Offset in y of the cave's gallery from its middle row, in cells, at column `i`.
double gallery_offset(int i) { return 4.0 * std::sin(0.2 * i); }

/// Opens a winding gallery 6 cells wide, so that the cave can be crossed over 25 m for every seed.
void open_gallery(CaveRock& rock) {
  constexpr int middle = CaveRock::kCells / 2, half_width = 3;
  for (int i = 2; i < CaveRock::kCells - 2; ++i)
    for (int j = middle - half_width; j < middle + half_width; ++j)
      rock.open(i, j + static_cast<int>(std::lround(gallery_offset(i))));
}

/// Adds the solid cells as walls: one box for each run of solid cells along x.
void add_rock(Builder& b, const CaveRock& rock) {
  constexpr double cell = CaveRock::kCellSize;
  for (int j = 0; j < CaveRock::kCells; ++j)
    for (int i = 0; i < CaveRock::kCells;) {
      int end = i;
      while (end < CaveRock::kCells && rock.solid(end, j)) ++end;
      if (end > i) b.add_wall(i * cell, end * cell, j * cell, (j + 1) * cell);
      i = end + 1;
    }
}

/// Adds bumps up to 0.12 m high: stacks of 1 to 6 plates, each 2 cm thick.
void add_bumps(Builder& b, Random& random) {
  constexpr double plate_thickness = 0.02;
  for (int bump = 0; bump < 60; ++bump) {
    const double x = random.uniform(1.0, 29.0), y = random.uniform(1.0, 29.0);
    const int plates = 1 + static_cast<int>(random.below(6));
    for (int plate = 0; plate < plates; ++plate) {
      const double size = 0.4 + 0.3 * (plates - plate);
      b.add_box(x - size / 2, x + size / 2, y - size / 2, y + size / 2, plate_thickness * (plate + 1));
    }
  }
}

/// A cave with a gallery through its middle and a floor with bumps.
GeneratedWorld cave(Random random) {
  constexpr int start_column = 5;
  constexpr double cell = CaveRock::kCellSize, side = CaveRock::kCells * cell;
  CaveRock rock(random, 0.44);
  for (int round = 0; round < 5; ++round) rock.grow();
  open_gallery(rock);
  // The start is in the middle of the gallery.
  Builder b(side, side, {start_column * cell, side / 2 + gallery_offset(start_column) * cell});
  add_rock(b, rock);
  add_bumps(b, random);
  return b.take();
}

/// Stairs with steps of 20 cm up to a landing and down again, beside a level corridor for robots that do not
/// climb stairs.
GeneratedWorld stairs(Random) {
  Builder b(24.0, 10.0, {2.0, 2.5});
  constexpr double rise = 0.20, run = 0.3;  // Height and depth of a step, m.
  constexpr int steps = 6;
  b.add_wall(6.0, 18.0, 5.0, 5.2);
  for (int n = 0; n < steps; ++n) {
    b.add_box(8.0 + n * run, 8.0 + (n + 1) * run, 0.0, 5.0, (n + 1) * rise);
    b.add_box(16.0 - (n + 1) * run, 16.0 - n * run, 0.0, 5.0, (n + 1) * rise);
  }
  b.add_box(8.0 + steps * run, 16.0 - steps * run, 0.0, 5.0, steps * rise);
  return b.take();
}

/// A hall with four dead ends that open towards the start and are deeper than the local planner's view.
GeneratedWorld dead_ends(Random random) {
  Builder b(40.0, 24.0, {2.0, 12.0});
  for (int n = 0; n < 4; ++n) {
    // Each dead end is a U of three walls, 12 m wide and 4 m deep, that opens towards -x. Robots pass it at
    // one of its two sides: the free space there alternates at random.
    const double x = 6.0 + 9.0 * n, y = 10.0 + random.uniform(-1.5, 1.5);
    const double shift = random.chance(0.5) ? 2.5 : -2.5;
    b.add_wall(x + 4.0, x + 4.2, y - 4.0 + shift, y + 8.0 + shift);
    b.add_wall(x, x + 4.0, y - 4.0 + shift, y - 3.8 + shift);
    b.add_wall(x, x + 4.0, y + 7.8 + shift, y + 8.0 + shift);
  }
  return b.take();
}

/// Four walls with one gap each, 10 to 40 cm wider than the widest standard platform (0.6 m).
GeneratedWorld gaps(Random random) {
  Builder b(26.0, 8.0, {2.0, 4.0});
  for (int n = 0; n < 4; ++n) {
    const double x = 5.0 + 5.0 * n, gap_width = 0.7 + 0.1 * (3 - n), y = random.uniform(2.0, 6.0);
    // The edges are on multiples of 5 cm, the cell size of the world's grid, so that the gap has exactly its
    // nominal width there.
    const double low = std::round((y - gap_width / 2) * 20.0) / 20.0, high = low + gap_width;
    b.add_wall(x, x + kInnerWallThickness, 0.0, low);
    b.add_wall(x, x + kInnerWallThickness, high, 8.0);
  }
  return b.take();
}

/// An open floor with debris of five heights: robots drive over low pieces and around high ones.
GeneratedWorld rubble(Random random) {
  constexpr std::array heights{0.04, 0.06, 0.3, 0.6, 1.2};  // m
  Builder b(30.0, 30.0, {3.0, 3.0});
  for (int n = 0; n < 110; ++n) {
    const double height = heights[random.below(heights.size())];
    const double width = random.uniform(0.2, 1.2), length = random.uniform(0.2, 1.2);
    const double y = random.uniform(0.5, 29.5), x = random.uniform(0.5, 29.5);
    b.add_obstacle(x, y, length, width, height);
  }
  return b.take();
}

/// Six rooms, each 6 m x 6 m, on each side of a corridor. Each has a door 1 m wide and a piece of furniture.
GeneratedWorld rooms(Random random) {
  Builder b(36.0, 15.0, {2.0, 7.5});
  for (int n = 0; n < 6; ++n) {
    const double x = 6.0 * n;
    if (n > 0) {
      b.add_wall(x - 0.1, x + 0.1, 0.0, 6.0);
      b.add_wall(x - 0.1, x + 0.1, 9.0, 15.0);
    }
    for (const double y : {6.0, 9.0}) {
      const double door = x + random.uniform(1.0, 4.0);
      b.add_wall(x, door, y - 0.1, y + 0.1);
      b.add_wall(door + 1.0, x + 6.0, y - 0.1, y + 0.1);
      const double furniture_y = y < 7.0 ? 1.2 : 13.8;
      const double furniture_length = random.uniform(0.6, 1.6);
      b.add_obstacle(x + random.uniform(1.5, 4.5), furniture_y, furniture_length, 0.8, 0.75);
    }
  }
  return b.take();
}

/// A maze of 6 x 6 cells of 4 m with exactly one path between any two cells, made by a depth-first search in
/// random order.
GeneratedWorld maze(Random random) {
  constexpr int n = 6;
  constexpr double cell = 4.0;
  Builder b(n * cell, n * cell, {cell / 2, cell / 2});
  std::array<bool, n * n> visited{};
  std::array<bool, n * n> open_east{}, open_north{};  // No wall between a cell and the next one.
  std::vector<int> path{0};
  visited[0] = true;
  while (!path.empty()) {
    const int at = path.back(), i = at % n, j = at / n;
    std::array<int, 4> next{};
    std::size_t count = 0;
    if (i + 1 < n && !visited[static_cast<std::size_t>(at + 1)]) next[count++] = at + 1;
    if (i > 0 && !visited[static_cast<std::size_t>(at - 1)]) next[count++] = at - 1;
    if (j + 1 < n && !visited[static_cast<std::size_t>(at + n)]) next[count++] = at + n;
    if (j > 0 && !visited[static_cast<std::size_t>(at - n)]) next[count++] = at - n;
    if (count == 0) {
      path.pop_back();
      continue;
    }
    const int to = next[random.below(count)];
    auto& open = std::abs(to - at) == 1 ? open_east : open_north;
    open[static_cast<std::size_t>(std::min(at, to))] = true;
    visited[static_cast<std::size_t>(to)] = true;
    path.push_back(to);
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(j * n + i);
      const double x = (i + 1) * cell, y = (j + 1) * cell;
      if (i + 1 < n && !open_east[at]) b.add_wall(x - 0.1, x + 0.1, j * cell, y);
      if (j + 1 < n && !open_north[at]) b.add_wall(i * cell, x, y - 0.1, y + 0.1);
    }
  return b.take();
}

GeneratedWorld tunnel(Random) { return generate_tunnel(kUsualTunnel); }

/// Four corridors of 40 m x 3 m around a square block, which look the same but for one box in each: at a
/// random place, of the same size. A lap is about 148 m.
GeneratedWorld loop(Random random) {
  constexpr double side = 40.0, width = 3.0;
  constexpr double box = 0.5, box_height = 0.9, free_end = 6.0;
  Builder b(side, side, {width / 2, width / 2});
  b.add_wall(width, side - width, width, side - width);
  for (int corridor = 0; corridor < 4; ++corridor) {
    // Along the block, so that 1.9 m stay free beside it.
    const double along = random.uniform(free_end, side - free_end), across = width - 0.35;
    const double other = side - across;
    if (corridor == 0) b.add_obstacle(along, across, box, box, box_height);
    if (corridor == 1) b.add_obstacle(other, along, box, box, box_height);
    if (corridor == 2) b.add_obstacle(along, other, box, box, box_height);
    if (corridor == 3) b.add_obstacle(across, along, box, box, box_height);
  }
  return b.take();
}

template <GeneratedWorld (*make)(Random)>
GeneratedWorld drawn(std::uint64_t seed) {
  return make(Random(seed));
}
GeneratedWorld flights(std::uint64_t seed) { return generate_flights(seed).world; }

struct Kind {
  std::string_view name;
  GeneratedWorld (*make)(std::uint64_t seed);
};
constexpr std::array kKinds{
    Kind{"corridor", drawn<corridor>}, Kind{"blocks", drawn<blocks>}, Kind{"car_park", drawn<car_park>},
    Kind{"cave", drawn<cave>},         Kind{"stairs", drawn<stairs>}, Kind{"dead_ends", drawn<dead_ends>},
    Kind{"gaps", drawn<gaps>},         Kind{"rubble", drawn<rubble>}, Kind{"rooms", drawn<rooms>},
    Kind{"maze", drawn<maze>},         Kind{"tunnel", drawn<tunnel>}, Kind{"loop", drawn<loop>},
    Kind{"flights", flights}};

constexpr auto kNames = [] {
  std::array<std::string_view, kKinds.size()> out{};
  for (std::size_t n = 0; n < kKinds.size(); ++n) out[n] = kKinds[n].name;
  return out;
}();

}  // namespace

std::span<const std::string_view> world_kinds() { return kNames; }

std::span<const std::string_view> navigation_kinds() {
  constexpr std::size_t others = 3;  // The last ones.
  return std::span(kNames).first(kNames.size() - others);
}

Result<GeneratedWorld> generate_world(std::string_view kind, std::uint64_t seed) {
  for (const Kind& each : kKinds)
    if (each.name == kind) return each.make(seed);
  return {Reason::bad_argument, "no world is called " + std::string(kind)};
}

GeneratedWorld generate_tunnel(int length) {
  constexpr double width = 3.0;
  return Builder(length, width, {2.0, width / 2}).take();
}

GeneratedWorld generate_blocks(int size, std::uint64_t seed) {
  constexpr double wall = 0.3, below = -1.0, above = 4.0, box_height = 0.9;  // m
  const double side = blocks_side(size);
  GeneratedWorld out;
  out.size = {side, side};
  out.start = {kStreet / 2, kStreet / 2};
  for (const Eigen::Vector2d& c : block_corners(size))
    out.boxes.push_back({c.x(), c.x() + kBlock, c.y(), c.y() + kBlock, below, above});
  out.boxes.push_back({-wall, 0, 0, side, below, above});
  out.boxes.push_back({side, side + wall, 0, side, below, above});
  out.boxes.push_back({0, side, -wall, 0, below, above});
  out.boxes.push_back({0, side, side, side + wall, below, above});
  const StreetBoxes boxes = seed == 0 && size == 3   ? kBoxesOf3
                            : seed == 0 && size == 5 ? kBoxesOf5
                                                     : draw_street_boxes(size, seed);
  for (const auto& [x, y] : boxes)
    out.boxes.push_back({x, x + kStreetBox, y, y + kStreetBox, 0.0, box_height});
  return out;
}

}  // namespace adit::sim
