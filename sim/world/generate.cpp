// SPDX-License-Identifier: Apache-2.0
#include "sim/world/generate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/time/random.hpp"

namespace adit::sim {
namespace {

constexpr double kWall = 0.2;     // thickness, m
constexpr double kCeiling = 3.0;  // of the room, m
constexpr double kFree = 1.0;     // around the start, m

/// Boxes on a floor, kept away from the start.
class Builder {
 public:
  Builder(double width, double height, Eigen::Vector2d start) {
    world_.size = {width, height};
    world_.start = start;
    wall(-kWall, width + kWall, -kWall, 0.0);
    wall(-kWall, width + kWall, height, height + kWall);
    wall(-kWall, 0.0, 0.0, height);
    wall(width, width + kWall, 0.0, height);
  }
  void wall(double x0, double x1, double y0, double y1) { box(x0, x1, y0, y1, kCeiling); }
  void box(double x0, double x1, double y0, double y1, double top, double bottom = 0.0) {
    world_.boxes.push_back({x0, x1, y0, y1, bottom, top});
  }
  /// Clutter: left out where it would come within kFree of the start.
  void thing(double x, double y, double length, double width, double top) {
    const double dx = std::max(0.0, std::abs(x - world_.start.x()) - length / 2);
    const double dy = std::max(0.0, std::abs(y - world_.start.y()) - width / 2);
    if (std::hypot(dx, dy) < kFree) return;
    box(x - length / 2, x + length / 2, y - width / 2, y + width / 2, top);
  }
  GeneratedWorld take() { return std::move(world_); }

 private:
  GeneratedWorld world_{};
};

/// A long corridor of 4 m, boxes along both sides: 1.4 m at least stay free between them.
GeneratedWorld corridor(Random random) {
  Builder b(50.0, 4.0, {1.5, 2.0});
  for (double x = 3.5; x < 48.0; x += random.uniform(1.6, 2.6)) {
    const double width = random.uniform(0.3, 1.3), length = random.uniform(0.3, 0.8);
    b.thing(x, random.chance(0.5) ? width / 2 : 4.0 - width / 2, length, width, random.uniform(0.3, 1.8));
  }
  return b.take();
}

/// 3 x 3 blocks of 8 m with streets of 3.2 m, as in FAR planner's comparison.
GeneratedWorld blocks(Random) {
  constexpr double street = 3.2, block = 8.0, side = 3 * block + 4 * street;
  Builder b(side, side, {street / 2, street / 2});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double x = street + i * (block + street), y = street + j * (block + street);
      b.wall(x, x + block, y, y + block);
    }
  return b.take();
}

/// Pillars, parked cars, and a ramp of 12 % up to a raised deck of 1.2 m.
GeneratedWorld car_park(Random random) {
  Builder b(40.0, 30.0, {2.0, 2.0});
  for (double x = 8.0; x < 39.0; x += 8.0)
    for (double y = 6.0; y < 20.0; y += 6.0) b.thing(x, y, 0.5, 0.5, kCeiling);
  for (double x = 5.0; x < 38.0; x += 3.0)
    for (const double y : {9.0, 15.0})
      if (random.chance(0.6)) b.thing(x, y + random.uniform(-0.3, 0.3), 1.8, 4.2, 1.5);
  constexpr double rise = 0.06, run = 0.5, deck = 1.2;  // m a step of the ramp: every wheel climbs it
  constexpr int steps = static_cast<int>(deck / rise);
  for (int n = 0; n < steps; ++n) b.box(4.0 + n * run, 4.0 + (n + 1) * run, 22.0, 26.0, (n + 1) * rise);
  b.box(4.0 + steps * run, 36.0, 22.0, 30.0, deck);
  return b.take();
}

/// A cave: cells of 0.5 m grown by a cellular automaton (Johnson et al., "Cellular automata for real-time
/// generation of infinite cave levels", 2010), and a floor of bumps up to 0.12 m whose edges are 2 cm.
GeneratedWorld cave(Random random) {
  constexpr int n = 60;
  constexpr double cell = 0.5;
  const auto index = [](int i, int j) {
    return static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i);
  };
  std::vector<std::uint8_t> rock(static_cast<std::size_t>(n) * n);
  for (auto& r : rock) r = random.chance(0.44);
  const auto around = [&](const std::vector<std::uint8_t>& from, int i, int j) {
    int count = 0;
    for (int b = j - 1; b <= j + 1; ++b)
      for (int a = i - 1; a <= i + 1; ++a) count += a < 0 || b < 0 || a >= n || b >= n || from[index(a, b)];
    return count;
  };
  for (int round = 0; round < 5; ++round) {
    const std::vector<std::uint8_t> old = rock;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) rock[index(i, j)] = around(old, i, j) >= 5;
  }
  // A gallery through the middle, so that every seed has a way of 25 m.
  for (int i = 2; i < n - 2; ++i)
    for (int j = 27; j < 33; ++j)
      rock[index(i, j + static_cast<int>(std::lround(4.0 * std::sin(0.2 * i))))] = 0;
  Builder b(n * cell, n * cell, {2.5, 15.0 + 2.0 * std::sin(1.0)});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n;) {
      int end = i;
      while (end < n && rock[index(end, j)]) ++end;
      if (end > i) b.wall(i * cell, end * cell, j * cell, (j + 1) * cell);
      i = end + 1;
    }
  for (int bump = 0; bump < 60; ++bump) {
    const double x = random.uniform(1.0, 29.0), y = random.uniform(1.0, 29.0);
    const int rings = 1 + static_cast<int>(random.below(6));
    for (int ring = 0; ring < rings; ++ring) {
      const double size = 0.4 + 0.3 * (rings - ring);
      b.box(x - size / 2, x + size / 2, y - size / 2, y + size / 2, 0.02 * (ring + 1));
    }
  }
  return b.take();
}

/// Stairs of 20 cm up to a landing, and down again; and a way around for who cannot climb.
GeneratedWorld stairs(Random) {
  Builder b(24.0, 10.0, {2.0, 2.5});
  constexpr double rise = 0.20, run = 0.3;
  constexpr int steps = 6;
  b.wall(6.0, 18.0, 5.0, 5.2);
  for (int n = 0; n < steps; ++n) {
    b.box(8.0 + n * run, 8.0 + (n + 1) * run, 0.0, 5.0, (n + 1) * rise);
    b.box(16.0 - (n + 1) * run, 16.0 - n * run, 0.0, 5.0, (n + 1) * rise);
  }
  b.box(8.0 + steps * run, 16.0 - steps * run, 0.0, 5.0, steps * rise);
  return b.take();
}

/// A corridor with pockets that end, deeper than the local planner looks.
GeneratedWorld dead_ends(Random random) {
  Builder b(40.0, 24.0, {2.0, 12.0});
  for (int n = 0; n < 4; ++n) {
    const double x = 6.0 + 9.0 * n, mouth = 10.0 + random.uniform(-1.5, 1.5);
    // A cup that opens towards the start; the way on is past its upper or lower edge.
    const double shift = random.chance(0.5) ? 2.5 : -2.5;
    b.wall(x + 4.0, x + 4.2, mouth - 4.0 + shift, mouth + 8.0 + shift);
    b.wall(x, x + 4.0, mouth - 4.0 + shift, mouth - 3.8 + shift);
    b.wall(x, x + 4.0, mouth + 7.8 + shift, mouth + 8.0 + shift);
  }
  return b.take();
}

/// Walls with one gap each, 10 to 40 cm wider than the widest standard platform (0.6 m).
GeneratedWorld gaps(Random random) {
  Builder b(26.0, 8.0, {2.0, 4.0});
  for (int n = 0; n < 4; ++n) {
    const double x = 5.0 + 5.0 * n, wide = 0.7 + 0.1 * (3 - n), y = random.uniform(2.0, 6.0);
    // On whole columns of the grid, so that the gap is as wide as it says.
    const double low = std::round((y - wide / 2) * 20.0) / 20.0, high = low + wide;
    b.wall(x, x + 0.2, 0.0, low);
    b.wall(x, x + 0.2, high, 8.0);
  }
  return b.take();
}

/// Debris of all heights on an open floor: what is low is driven over, the rest around.
GeneratedWorld rubble(Random random) {
  Builder b(30.0, 30.0, {3.0, 3.0});
  for (int n = 0; n < 110; ++n)
    b.thing(random.uniform(0.5, 29.5), random.uniform(0.5, 29.5), random.uniform(0.2, 1.2),
            random.uniform(0.2, 1.2), std::array{0.04, 0.06, 0.3, 0.6, 1.2}[random.below(5)]);
  return b.take();
}

/// Rooms of 6 m along a corridor, doors of 1 m, furniture.
GeneratedWorld rooms(Random random) {
  Builder b(36.0, 15.0, {2.0, 7.5});
  for (int n = 0; n < 6; ++n) {
    const double x = 6.0 * n;
    if (n > 0) {
      b.wall(x - 0.1, x + 0.1, 0.0, 6.0);
      b.wall(x - 0.1, x + 0.1, 9.0, 15.0);
    }
    for (const double y : {6.0, 9.0}) {
      const double door = x + random.uniform(1.0, 4.0);
      b.wall(x, door, y - 0.1, y + 0.1);
      b.wall(door + 1.0, x + 6.0, y - 0.1, y + 0.1);
      const double inside = y < 7.0 ? 1.2 : 13.8;
      b.thing(x + random.uniform(1.5, 4.5), inside, random.uniform(0.6, 1.6), 0.8, 0.75);
    }
  }
  return b.take();
}

/// A maze of 6 x 6 cells of 4 m, one way between any two cells (depth first).
GeneratedWorld maze(Random random) {
  constexpr int n = 6;
  constexpr double cell = 4.0;
  Builder b(n * cell, n * cell, {cell / 2, cell / 2});
  std::array<bool, n * n> seen{};
  std::array<bool, n * n> east{}, north{};  // open towards the next cell
  std::vector<int> way{0};
  seen[0] = true;
  while (!way.empty()) {
    const int at = way.back(), i = at % n, j = at / n;
    std::array<int, 4> next{};
    std::size_t count = 0;
    if (i + 1 < n && !seen[static_cast<std::size_t>(at + 1)]) next[count++] = at + 1;
    if (i > 0 && !seen[static_cast<std::size_t>(at - 1)]) next[count++] = at - 1;
    if (j + 1 < n && !seen[static_cast<std::size_t>(at + n)]) next[count++] = at + n;
    if (j > 0 && !seen[static_cast<std::size_t>(at - n)]) next[count++] = at - n;
    if (count == 0) {
      way.pop_back();
      continue;
    }
    const int to = next[random.below(count)];
    auto& open = std::abs(to - at) == 1 ? east : north;
    open[static_cast<std::size_t>(std::min(at, to))] = true;
    seen[static_cast<std::size_t>(to)] = true;
    way.push_back(to);
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(j * n + i);
      const double x = (i + 1) * cell, y = (j + 1) * cell;
      if (i + 1 < n && !east[at]) b.wall(x - 0.1, x + 0.1, j * cell, y);
      if (j + 1 < n && !north[at]) b.wall(i * cell, x, y - 0.1, y + 0.1);
    }
  return b.take();
}

struct Kind {
  std::string_view name;
  GeneratedWorld (*make)(Random);
};
constexpr std::array kKinds{Kind{"corridor", corridor}, Kind{"blocks", blocks}, Kind{"car_park", car_park},
                            Kind{"cave", cave},         Kind{"stairs", stairs}, Kind{"dead_ends", dead_ends},
                            Kind{"gaps", gaps},         Kind{"rubble", rubble}, Kind{"rooms", rooms},
                            Kind{"maze", maze}};

constexpr auto kNames = [] {
  std::array<std::string_view, kKinds.size()> out{};
  for (std::size_t n = 0; n < kKinds.size(); ++n) out[n] = kKinds[n].name;
  return out;
}();

}  // namespace

std::span<const std::string_view> world_kinds() { return kNames; }

Result<GeneratedWorld> generate_world(std::string_view kind, std::uint64_t seed) {
  for (const Kind& each : kKinds)
    if (each.name == kind) return each.make(Random(seed));
  return {Reason::bad_argument, "no world is called " + std::string(kind)};
}

}  // namespace adit::sim
