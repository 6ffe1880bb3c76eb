// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/step_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/staircase.hpp"

namespace adit::perception {
namespace {

constexpr double kOfStrips = 0.35;  // A face is there if so much of the core's strips show it.
constexpr double kCoreStrip = 0.1;  // m
constexpr double kSome = 4.0;       // Points on a face of which little is in view.

}  // namespace

void StepEvidence::count_core(double right, double left, double tolerance) {
  risers_.fill({});
  treads_.fill({});
  above_risers_.fill(0);
  before_risers_.fill(0);
  const double margin = std::clamp(tolerance, 0.15 * model_.rise, 0.4 * model_.rise);
  for (const Placed& p : placed_) {
    if (p.v < right || p.v > left) continue;
    const int slot = p.step + kMiddle;
    if (slot < 1 || slot >= kSteps - 1) continue;
    const auto strip = static_cast<std::size_t>(std::clamp((p.v - right) / kCoreStrip, 0.0, kStrips - 1.0));
    if (std::abs(p.off) <= tolerance) {
      // Only what lies within a face: near an edge, the other face is as likely.
      const double part = p.riser ? (model_.tread_h(p.step) - p.h) / model_.rise
                                  : (p.u - model_.riser_u(p.step)) / model_.run;
      const bool next_to_outer = p.riser ? model_.sees_tread(p.step) : model_.sees_riser(p.step);
      const bool next_to_inner = p.riser ? model_.sees_tread(p.step - 1) : model_.sees_riser(p.step + 1);
      if ((next_to_outer && part < 0.15) || (next_to_inner && part > 0.85)) continue;
      Face& face = (p.riser ? risers_ : treads_)[static_cast<std::size_t>(slot)];
      face.strips.set(strip);
      face.count += 1;
    }
    // Before a riser, nothing is at its height: a floor that leans goes on there.
    const int at_height = model_.riser_at(p.h);
    const double before = model_.riser_u(at_height) - p.u;
    if (before > tolerance && before < 0.6 * model_.run && model_.tread_h(at_height) - p.h > margin &&
        p.h - model_.tread_h(at_height - 1) > margin && std::abs(at_height) < kMiddle)
      ++before_risers_[static_cast<std::size_t>(at_height + kMiddle)];
    // A wall goes on above its riser.
    for (const int k : {slot - 1, slot, slot + 1}) {
      const int riser = k - kMiddle;
      const double over = (p.h - model_.tread_h(riser)) / model_.rise;
      if (std::abs(p.u - model_.riser_u(riser)) < tolerance && over > 0.4 && over < 1.4)
        ++above_risers_[static_cast<std::size_t>(k)];
    }
  }
}

bool StepEvidence::seen(const Face& face) const {
  return static_cast<double>(face.strips.count()) >= kOfStrips * core_strips_;
}

StepEvidence::Seen StepEvidence::riser_seen(int k) const {
  const auto slot = static_cast<std::size_t>(k + kMiddle);
  const Face &riser = risers_[slot], &below = treads_[slot - 1], &above = treads_[slot];
  const bool wall = above_risers_[slot] > riser.count || before_risers_[slot] > riser.count / 2;
  if ((seen(riser) && !wall) || (seen(below) && seen(above))) return Seen::clearly;
  const auto some = [](const Face& face) { return face.count >= kSome; };
  return (some(riser) && !wall) || (some(below) && some(above)) ? Seen::hardly : Seen::no;
}

bool StepEvidence::find_chain(FlightEvidence& out) const {
  int best = 0;
  for (int k = 1 - kMiddle; k < kMiddle - 1; ++k) {
    if (riser_seen(k) == Seen::no) continue;
    int last = k;
    // One riser may be hidden, as by a person.
    for (int n = k; n < kMiddle - 1 && n - last <= 2; ++n)
      if (riser_seen(n) != Seen::no) last = n;
    // At its ends, the floor, or a tread, must be in view; above the eye, a riser is enough.
    int first = k, end = last;
    const auto tread_seen = [&](int step) { return seen(treads_[static_cast<std::size_t>(step + kMiddle)]); };
    const auto clearly = [&](int riser) { return riser_seen(riser) == Seen::clearly; };
    while (first < end && !tread_seen(first - 1) && !(clearly(first) && !model_.sees_tread(first - 1)))
      ++first;
    while (end > first && !tread_seen(end) && !(clearly(end) && !model_.sees_well(end))) --end;
    int found = 0;
    for (int n = first; n <= end; ++n) found += clearly(n) ? 1 : 0;
    if (found > best) {
      best = found;
      out.first = first;
      out.last = end;
    }
    k = last;
  }
  return best >= Staircase::kLeastSteps;
}

bool StepEvidence::find_width(FlightEvidence& out, double tolerance, double middle) {
  struct Strip {
    std::bitset<kSteps> steps{};
    int on{}, beside{};
  };
  constexpr int half = kStrips / 2;
  std::vector<Strip> strips(kStrips);
  const double begin = model_.riser_u(out.first), end = model_.riser_u(out.last);
  for (const Placed& p : placed_) {
    const double place = (p.v - middle) / kStrip + half;
    if (place < 0 || place >= kStrips || p.u < begin - tolerance || p.u > end + model_.run) continue;
    Strip& strip = strips[static_cast<std::size_t>(place)];
    const bool of_chain = p.step >= out.first && p.step <= out.last;
    if (std::abs(p.off) <= tolerance && of_chain) {
      strip.steps.set(static_cast<std::size_t>(p.step + kMiddle));
      ++strip.on;
    } else if (std::abs(p.off) > tolerance) {
      ++strip.beside;
    }
  }
  const double need = std::max(2.0, 0.3 * (out.last - out.first + 1));
  const auto obeys = [&](int n) {
    const Strip& s = strips[static_cast<std::size_t>(n)];
    return static_cast<double>(s.steps.count()) >= need && s.on > s.beside;
  };
  int low = half, high = half;
  while (low > 0 && !obeys(low) && low > half - 4) --low;
  if (!obeys(low)) {
    low = half;
    while (low < kStrips - 1 && !obeys(low) && low < half + 4) ++low;
  }
  if (!obeys(low)) return false;
  high = low;
  // Beams leave gaps between points: one strip.
  while (low > 1 && (obeys(low - 1) || obeys(low - 2))) --low;
  while (high < kStrips - 2 && (obeys(high + 1) || obeys(high + 2))) ++high;
  const double right = middle + (low - half - 1) * kStrip, left = middle + (high - half + 2) * kStrip;
  std::vector<float> across;
  for (const Placed& p : placed_)
    if (p.v >= right && p.v <= left && std::abs(p.off) <= tolerance && p.step >= out.first &&
        p.step <= out.last)
      across.push_back(p.v);
  if (across.size() < 20) return false;
  std::sort(across.begin(), across.end());
  const std::size_t outer = across.size() / 200;
  out.right = across[outer];
  out.left = across[across.size() - 1 - outer];
  return true;
}

void StepEvidence::compare(FlightEvidence& out, double tolerance) {
  const double begin = model_.riser_u(out.first), end = model_.riser_u(out.last) + model_.run;
  // The plane through the points themselves.
  double n = 0, su = 0, sh = 0, suu = 0, suh = 0, shh = 0;
  double squares = 0, on = 0, beside = 0;
  risers_.fill({});
  treads_.fill({});
  for (const Placed& p : placed_) {
    if (p.v < out.right + 0.05 || p.v > out.left - 0.05 || p.u < begin - tolerance || p.u > end) continue;
    if (p.h < model_.tread_h(out.first - 1) - 0.1 || p.h > model_.tread_h(out.last) + 0.5) continue;
    if (std::abs(p.off) > 2 * tolerance) {
      beside += 1;
      continue;
    }
    on += 1;
    if (p.step < out.first || p.step > out.last) continue;
    n += 1, su += p.u, sh += p.h, suu += double{p.u} * p.u, suh += double{p.u} * p.h,
        shh += double{p.h} * p.h;
    squares += double{p.off} * p.off;
    Face& face = (p.riser ? risers_ : treads_)[static_cast<std::size_t>(p.step + kMiddle)];
    face.count += 1, face.sum += p.off;
    face.strips.set(static_cast<std::size_t>(std::clamp((p.v - out.right) / kStrip, 0.0, kStrips - 1.0)));
  }
  if (n < 10) return;
  const double cuu = suu - su * su / n, cuh = suh - su * sh / n, chh = shh - sh * sh / n;
  // Orthogonal distances: the smaller eigenvalue.
  const double mean = (cuu + chh) / 2, spread = std::hypot((cuu - chh) / 2, cuh);
  out.plane_spread = std::sqrt(std::max(0.0, mean - spread) / n);
  out.spread = std::sqrt(squares / n);
  for (const auto* faces : {&risers_, &treads_}) {
    double weight = 0, offsets = 0;
    for (const Face& face : *faces) {
      if (face.count == 0) continue;
      const double measured = std::min(face.count, 2.0 * static_cast<double>(face.strips.count()));
      weight += measured;
      offsets += measured * std::pow(face.sum / face.count, 2);
    }
    out.independent += weight;
    if (weight > 0) out.unequal = std::max(out.unequal, std::sqrt(offsets / weight));
  }
  out.clean = on / (on + beside);
}

std::optional<FlightEvidence> StepEvidence::weigh(const StepFit& fit, std::span<const SlopePoint> points,
                                                  double core_right, double core_left) {
  model_ = fit.model;
  placed_.clear();
  for (const SlopePoint& p : points) {
    const double u = model_.along(p), v = model_.across(p);
    const StepModel::Nearest near = model_.nearest(u, p.z());
    if (std::abs(near.step) >= kMiddle - 1) continue;
    placed_.push_back({static_cast<float>(u), static_cast<float>(v), p.z(), static_cast<float>(near.off),
                       near.step, near.riser});
  }
  const double tolerance = std::clamp(2.5 * fit.spread, 0.03, 0.06);
  FlightEvidence out;
  count_core(core_right, core_left, tolerance);
  core_strips_ = std::max(1.0, (core_left - core_right) / kCoreStrip);
  if (!find_chain(out)) return std::nullopt;
  if (!find_width(out, tolerance, (core_left + core_right) / 2)) return std::nullopt;
  compare(out, tolerance);
  return out;
}

}  // namespace adit::perception
