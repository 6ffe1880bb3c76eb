// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link/model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace adit::wire {
namespace {

constexpr double kOutOfRange = -1000.0;  // In dBm.

/// Standard normal deviate by the Box-Muller transform (Box and Muller 1958).
double normal(Random& random) {
  const double u = 1.0 - random.uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * random.uniform());
}

}  // namespace

double distance(const Position& a, const Position& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

std::optional<double> received_power(const LinkProfile& link, const Path& path) {
  if (!path.distance || link.fading <= 0.0) return std::nullopt;
  if (link.range > 0.0 && *path.distance > link.range) return kOutOfRange;
  const double metres = std::max(1.0, *path.distance);  // Below one metre the received power no longer rises.
  return link.power - link.path_loss - 10.0 * link.fading * std::log10(metres) - path.walls;
}

double fading_loss(double power, double noise, std::uint32_t bytes) {
  const double ratio = std::pow(10.0, (power - noise) / 10.0);
  const double bit_error = std::min(1.0, std::erfc(std::sqrt(ratio)));
  return -std::expm1(8.0 * bytes * std::log1p(-std::min(bit_error, 1.0 - 1e-12)));
}

bool LossModel::lost(const LinkProfile& link, const Path& path, std::uint32_t bytes,
                     std::optional<double> loss, Random& random) {
  if (link.range > 0.0 && path.distance && *path.distance > link.range) return true;
  const double chance = loss.value_or(link.loss);
  bool is_lost;
  if (link.burst <= 1.0 || chance <= 0.0 || chance >= 1.0) {
    is_lost = random.chance(chance);
    bad_ = false;
  } else {
    // Leaves the bad state after `burst` frames on average, and enters it so that the fraction `chance` of
    // all frames is lost.
    const double leave = 1.0 / link.burst;
    const double enter = std::min(1.0, leave * chance / (1.0 - chance));
    bad_ = bad_ ? !random.chance(leave) : random.chance(enter);
    is_lost = bad_;
  }
  if (const auto power = received_power(link, path)) {
    const double shadow = link.shadowing > 0.0 ? link.shadowing * normal(random) : 0.0;
    if (random.chance(fading_loss(*power + shadow, link.noise, bytes))) is_lost = true;
  }
  return is_lost;
}

Duration transit(const LinkProfile& link, Random& random) {
  const double jitter = link.jitter > 0.0 ? random.uniform(0.0, link.jitter) : 0.0;
  return from_seconds(link.latency + jitter);
}

bool Window::admit(const LinkProfile& link, std::uint32_t bytes, Duration now) {
  while (!sent_.empty() && sent_.front().at + from_seconds(link.window) <= now) {
    total_ -= sent_.front().bytes;
    sent_.pop_front();
  }
  if (static_cast<double>(total_ + bytes) * 8.0 > link.bandwidth * link.window) return false;
  sent_.push_back({now, bytes});
  total_ += bytes;
  return true;
}

}  // namespace adit::wire
