// SPDX-License-Identifier: Apache-2.0
#include "sim/world/flights.hpp"

#include <algorithm>
#include <cmath>

#include "core/time/random.hpp"

namespace adit::sim {
namespace {

// All in m. The flights begin at x = kFoot; the upper floor begins at x = kUpper.
constexpr double kFoot = 12.0, kUpper = 16.0, kEnd = 24.0, kDepth = 12.0;
constexpr double kHigh = 4.8, kRoof = 7.6;  // Of the upper floor, and of the walls.
constexpr double kWall = 0.2, kLane = 2.2;
constexpr double kLanding = 2.0;
constexpr double kRampWidth = 2.6, kRampRise = 0.06, kRampRun = 0.25;

/// Collects boxes; `solid` from the lower floor upwards.
struct Boxes {
  std::vector<Box> list{};
  void solid(double x0, double x1, double y0, double y1, double height) {
    list.push_back({x0, x1, y0, y1, 0.0, height});
  }
  void wall(double x0, double x1, double y0, double y1) { solid(x0, x1, y0, y1, kRoof); }
};

/// Where a flight is, and its first step.
struct Flight {
  double x{}, y0{}, y1{};
  bool forward{};  ///< Climbs along +x; else along -x.
  double floor{};  ///< Below it.
  int steps{};
};

Staircase add_flight(Boxes& boxes, const Flight& flight, double rise, double run) {
  const double sign = flight.forward ? 1.0 : -1.0;
  // The last riser leads to the landing.
  for (int n = 0; n + 1 < flight.steps; ++n) {
    const double a = flight.x + sign * n * run, b = flight.x + sign * (n + 1) * run;
    boxes.solid(std::min(a, b), std::max(a, b), flight.y0, flight.y1, flight.floor + (n + 1) * rise);
  }
  Staircase stairs;
  stairs.foot = {flight.x, (flight.y0 + flight.y1) / 2, flight.floor + rise / 2};
  stairs.heading = flight.forward ? 0.0 : M_PI;
  stairs.rise = rise;
  stairs.run = run;
  stairs.width = flight.y1 - flight.y0;
  stairs.steps = flight.steps;
  return stairs;
}

/// Steps of 6 cm, which every wheeled platform climbs, along the far side of the hall, and round the corner
/// to the upper floor.
void add_ramp(Boxes& boxes) {
  const double y0 = kDepth + kWall, y1 = y0 + kRampWidth;
  const int steps = static_cast<int>(std::lround(kHigh / kRampRise));
  const double end = kEnd - 2.2, begin = end - (steps - 1) * kRampRun;
  for (int n = 0; n + 1 < steps; ++n)
    boxes.solid(begin + n * kRampRun, begin + (n + 1) * kRampRun, y0, y1, (n + 1) * kRampRise);
  boxes.solid(end, kEnd, y0, y1, kHigh);
  boxes.solid(end, kEnd, kDepth, y0, kHigh);  // The threshold of the door to the upper floor.
  boxes.wall(begin, end, kDepth, y0);
  boxes.wall(0.0, kEnd + kWall, y1, y1 + kWall);
  boxes.wall(-kWall, 0.0, kDepth, y1 + kWall);
}

}  // namespace

FlightsWorld generate_flights(std::uint64_t seed) {
  Random random(seed);
  FlightsWorld out;
  // Risers of all flights together: 27 of 0.178 m to 33 of 0.145 m.
  const int first = 9 + static_cast<int>(random.below(3)), second = 9 + static_cast<int>(random.below(3));
  const int third = 9 + static_cast<int>(random.below(3));
  const double rise = kHigh / (first + second + third);
  const double run = random.chance(0.5) ? 0.25 : 0.30;
  const double width = 1.2 + 0.1 * static_cast<double>(random.below(8));
  out.ramp = seed % 2 == 0;

  Boxes boxes;
  const double side = (kLane - width) / 2;
  const auto lane = [&](int n) { return n * kLane; };
  const auto low = [&](int n) { return std::round((lane(n) + side) * 20.0) / 20.0; };
  const auto flight = [&](int n, double x, bool forward, double floor, int steps) {
    return Flight{x, low(n), low(n) + width, forward, floor, steps};
  };
  const double level1 = first * rise, level2 = (first + second) * rise;
  const double end1 = kFoot + (first - 1) * run;  // Where the first landing begins.
  const double end2 = end1 - (second - 1) * run;  // Where the second one ends.
  const double foot3 = std::max(end2, kUpper - (third - 1) * run - 0.5);
  out.stairs[0] = add_flight(boxes, flight(0, kFoot, true, 0.0, first), rise, run);
  boxes.solid(end1, end1 + kLanding, 0.0, lane(2), level1);
  out.stairs[1] = add_flight(boxes, flight(1, end1, false, level1, second), rise, run);
  boxes.solid(end2 - kLanding, end2, lane(1), lane(3), level2);
  boxes.solid(end2, foot3, lane(2), lane(3), level2);
  out.stairs[2] = add_flight(boxes, flight(2, foot3, true, level2, third), rise, run);
  const double end3 = foot3 + (third - 1) * run;
  boxes.solid(end3, kEnd, lane(2), lane(3), kHigh);
  boxes.solid(kUpper, kEnd, lane(3), kDepth, kHigh);
  // Walls beside the flights, on both sides of each lane.
  for (int n = 0; n < 3; ++n) {
    const double x0 = n == 0 ? kFoot : n == 1 ? end2 : foot3, x1 = n == 2 ? end3 : end1;
    const double y0 = lane(n), y1 = lane(n + 1);
    if (low(n) > y0) boxes.wall(x0, x1, y0, low(n));
    if (y1 > low(n) + width) boxes.wall(x0, x1, low(n) + width, y1);
  }
  // Around the landings, and between the upper floor and the hall.
  const double t = kWall;
  boxes.wall(end1 + kLanding, end1 + kLanding + t, 0.0, lane(2));
  boxes.wall(end1, kEnd, lane(2) - t, lane(2));
  boxes.wall(end2 - kLanding - t, end2 - kLanding, lane(1), lane(3) + t);
  boxes.wall(end2 - kLanding, kFoot, lane(1), lane(1) + t / 2);
  boxes.wall(end2 - kLanding, kUpper + t, lane(3), lane(3) + t);
  boxes.wall(kUpper, kUpper + t, lane(3) + t, kDepth);
  // The room, with a door of 1.2 m.
  boxes.wall(kUpper + 2.0, kUpper + 2.0 + t, lane(2), lane(2) + 0.5);
  boxes.wall(kUpper + 2.0, kUpper + 2.0 + t, lane(2) + 1.7, kDepth);
  // Around the whole.
  boxes.wall(-t, kEnd + t, -t, 0.0);
  boxes.wall(-t, 0.0, 0.0, kDepth);
  boxes.wall(kEnd, kEnd + t, 0.0, kDepth + (out.ramp ? t + kRampWidth : 0.0));
  if (out.ramp)
    add_ramp(boxes);
  else
    boxes.wall(-t, kEnd + t, kDepth, kDepth + t);
  out.world = {std::move(boxes.list), {6.0, 1.2}, {kEnd, kDepth}, kRoof};
  return out;
}

}  // namespace adit::sim
