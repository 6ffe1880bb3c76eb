// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/step_model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "core/geometry/staircase.hpp"

namespace adit::perception {
namespace {

constexpr double kBinLength = 0.025;  // Along the slope, m.
constexpr double kReach = 4.0;        // Along the slope from the origin, m.
constexpr double kNearPlane = 0.25;   // m
constexpr int kRounds = 6;

}  // namespace

StepModel::Nearest StepModel::nearest(double u, double h) const {
  const int tread = tread_at(u), riser = riser_at(h);
  Nearest best{tread, false, 1.0, true};
  const auto offer = [&](int step, bool of_riser, double off, bool beyond) {
    if (std::abs(off) < std::abs(best.off)) best = {step, of_riser, off, beyond};
  };
  // Where the neighbour of a face is not seen, points beyond the edge belong to the face, whose edge is
  // elsewhere then.
  if (sees_tread(tread)) {
    offer(tread, false, h - tread_h(tread), false);
  } else {
    const int face = static_cast<int>(std::lround((u - edge_u) / run));
    const double behind = u - riser_u(face), over = h - tread_h(face), under = tread_h(face - 1) - h;
    const double gap = std::max({over, under, 0.0});
    if (sees_riser(face)) offer(face, true, std::abs(behind) > gap ? behind : gap, gap > 0.0);
  }
  if (sees_riser(riser)) {
    offer(riser, true, u - riser_u(riser), false);
  } else {
    const int face = static_cast<int>(std::lround((h - edge_h) / rise));
    const double above = h - tread_h(face), before = riser_u(face) - u, after = u - riser_u(face + 1);
    const double gap = std::max({before, after, 0.0});
    if (sees_tread(face)) offer(face, false, std::abs(above) > gap ? above : gap, gap > 0.0);
  }
  return best;
}

/// The edges of faces whose neighbour is not seen: where their points end, at one side and the other.
double StepFitter::measure_edges(const StepModel& m, Edges& risers, Edges& treads, Eigen::Matrix3d& a,
                                 Eigen::Vector3d& b, Eigen::Matrix2d& c, Eigen::Vector2d& d) {
  constexpr std::size_t least = 12;
  constexpr double weight = 3.0;  // An edge is as certain as so many points.
  const auto pull = [](double off) { return off / std::max(1.0, std::abs(off) / kHuber); };
  std::vector<double> squares;
  const auto count = [&](double off) { squares.push_back(std::min(off * off, kMostOff * kMostOff)); };
  int floor = 0;  // Its points begin where the sensor sees it, not at an edge.
  while (floor < 2 * kSlots - 2 && treads[static_cast<std::size_t>(floor)].along.empty() &&
         treads[static_cast<std::size_t>(floor + 1)].along.empty())
    floor += 2;
  for (int slot = 0; slot < 2 * kSlots; ++slot) {
    const int k = slot / 2 - kSlots / 2;
    Edge& riser = risers[static_cast<std::size_t>(slot)];
    if (riser.along.size() >= least) {
      const auto end = riser.along.begin() + static_cast<std::ptrdiff_t>(riser.along.size() * 29 / 30);
      std::nth_element(riser.along.begin(), end, riser.along.end());
      const Eigen::Vector2d j(1.0, k);
      c += weight * j * j.transpose();
      d += weight * pull(static_cast<double>(*end) - m.tread_h(k)) * j;
      count(static_cast<double>(*end) - m.tread_h(k));
    }
    Edge& tread = treads[static_cast<std::size_t>(slot)];
    if (slot > floor + 1 && tread.along.size() >= least) {
      const auto end = tread.along.begin() + static_cast<std::ptrdiff_t>(tread.along.size() / 30);
      std::nth_element(tread.along.begin(), end, tread.along.end());
      const Eigen::Vector3d j(1.0, k, -tread.across / static_cast<double>(tread.along.size()));
      a += weight * j * j.transpose();
      b += weight * pull(static_cast<double>(*end) - m.riser_u(k)) * j;
      count(static_cast<double>(*end) - m.riser_u(k));
    }
  }
  if (squares.size() < 4) return 0.0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle;
}

StepFit StepFitter::refine(std::span<const SlopePoint> points, StepModel m) {
  StepFit fit;
  Edges risers(2 * kSlots), treads(2 * kSlots);
  for (int round = 0; round <= kRounds; ++round) {
    if (!(m.run > 0.5 * Staircase::kLeastRun && m.rise > 0.5 * Staircase::kLeastRise)) return {};
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    Eigen::Matrix2d c = Eigen::Matrix2d::Zero();
    Eigen::Vector2d d = Eigen::Vector2d::Zero();
    double squares = 0.0;
    std::size_t inside = 0;
    for (Edges* edges : {&risers, &treads})
      for (Edge& edge : *edges) {
        edge.along.clear();
        edge.across = 0.0;
      }
    for (const SlopePoint& p : points) {
      const StepModel::Nearest near = m.nearest(m.along(p), p.z());
      const double size = std::abs(near.off);
      if (size > kMostOff) continue;
      ++inside;
      squares += near.off * near.off;
      const auto slot = static_cast<std::size_t>(2 * (near.step + kSlots / 2) + (p.y() > 0 ? 1 : 0));
      if (slot < 2 * kSlots && !(near.riser ? m.sees_tread(near.step) : m.sees_riser(near.step))) {
        Edge& edge = (near.riser ? risers : treads)[slot];
        edge.along.push_back(near.riser ? p.z() : static_cast<float>(m.along(p)));
        edge.across += p.y();
      }
      if (near.beyond_edge) continue;
      const double weight = size > kHuber ? kHuber / size : 1.0;
      if (near.riser) {
        const Eigen::Vector3d j(1.0, near.step, -static_cast<double>(p.y()));
        a += weight * j * j.transpose();
        b += weight * near.off * j;
      } else {
        const Eigen::Vector2d j(1.0, near.step);
        c += weight * j * j.transpose();
        d += weight * near.off * j;
      }
    }
    fit.edge_squares = measure_edges(m, risers, treads, a, b, c, d);
    fit.model = m;
    fit.share = points.empty() ? 0.0 : static_cast<double>(inside) / static_cast<double>(points.size());
    fit.spread = inside == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(inside));
    // What the points do not determine stays: a step of so much is as likely as one point's error.
    constexpr double edge = 0.05, step = 0.02, turn = 0.05, noise = 0.02;
    a.diagonal() += (Eigen::Vector3d(edge, step, turn) / noise).cwiseAbs2().cwiseInverse();
    c.diagonal() += (Eigen::Vector2d(edge, step) / noise).cwiseAbs2().cwiseInverse();
    fit.run_covariance = a.inverse();
    fit.rise_covariance = c.inverse();
    if (round == kRounds) break;
    const Eigen::Vector3d du = fit.run_covariance * b;
    const Eigen::Vector2d dh = fit.rise_covariance * d;
    m.edge_u += du[0], m.run += du[1], m.turn += du[2];
    m.edge_h += dh[0], m.rise += dh[1];
  }
  return fit;
}

void StepFitter::fill(std::span<const SlopePoint> points, double slope) {
  const double angle = std::atan(slope), c = std::cos(angle), s = std::sin(angle);
  bins_.assign(static_cast<std::size_t>(2 * kReach / kBinLength), {});
  for (const SlopePoint& p : points) {
    const double t = p.x() * c + p.z() * s, e = p.z() * c - p.x() * s;
    if (std::abs(e) > kNearPlane || std::abs(t) >= kReach) continue;
    Bin& bin = bins_[std::min(bins_.size() - 1, static_cast<std::size_t>((t + kReach) / kBinLength))];
    bin.sum += e;
    bin.weight += 1.0;
  }
  // Their mean and drift: the plane is not known exactly.
  double n = 0, st1 = 0, se = 0, stt = 0, ste = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    Bin& bin = bins_[i];
    if (bin.weight == 0.0) continue;
    bin.sum /= bin.weight;
    bin.weight = std::min(bin.weight, 10.0);
    const double t = (static_cast<double>(i) + 0.5) * kBinLength - kReach;
    n += bin.weight, st1 += bin.weight * t, se += bin.weight * bin.sum;
    stt += bin.weight * t * t, ste += bin.weight * t * bin.sum;
  }
  const double det = n * stt - st1 * st1;
  drift_ = det > 1e-9 ? (n * ste - st1 * se) / det : 0.0;
  mean_ = n > 0.0 ? (se - drift_ * st1) / n : 0.0;
  for (std::size_t i = 0; i < bins_.size(); ++i)
    bins_[i].sum -= mean_ + drift_ * ((static_cast<double>(i) + 0.5) * kBinLength - kReach);
}

void StepFitter::find_waves() {
  waves_.clear();
  double n = 0.0, all = 0.0;
  std::size_t first = bins_.size(), last = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i)
    if (bins_[i].weight > 0.0) {
      n += bins_[i].weight;
      all += bins_[i].weight * bins_[i].sum * bins_[i].sum;
      first = std::min(first, i);
      last = i;
    }
  if (n < 50.0 || all <= 0.0) return;
  // The length of a step along the slope.
  const double shortest = std::hypot(Staircase::kLeastRise, Staircase::kLeastRun) * 0.9;
  const double longest = std::hypot(Staircase::kMostRise, Staircase::kMostRun) * 1.1;
  const double step =
      0.25 / (static_cast<double>(last - first + 1) * kBinLength);  // A quarter of the resolution.
  for (double f = 1.0 / longest; f <= 1.0 / shortest + step; f += step) {
    double cc = 0, cs = 0, ss = 0, yc = 0, ys = 0;
    const double turn = 2.0 * M_PI * f * kBinLength;
    const double tc = std::cos(turn), ts = std::sin(turn);
    const double begin = turn * (static_cast<double>(first) + 0.5);
    double x = std::cos(begin), y = std::sin(begin);
    for (std::size_t i = first; i <= last; ++i) {
      const double e = bins_[i].sum, w = bins_[i].weight;
      cc += w * x * x, cs += w * x * y, ss += w * y * y, yc += w * e * x, ys += w * e * y;
      const double next = x * tc - y * ts;
      y = x * ts + y * tc;
      x = next;
    }
    const double det = cc * ss - cs * cs;
    if (det <= 0.0) continue;
    const double A = (yc * ss - ys * cs) / det, B = (ys * cc - yc * cs) / det;
    waves_.push_back({f, (A * yc + B * ys) / all, std::atan2(B, A)});
  }
}

double StepFitter::periodicity(std::span<const SlopePoint> points, double slope) {
  fill(points, slope);
  find_waves();
  double most = 0.0;
  for (const Wave& wave : waves_) most = std::max(most, wave.power);
  return most;
}

const std::vector<StepFit>& StepFitter::fit(std::span<const SlopePoint> points, double slope,
                                            const SlopePoint& eye, std::size_t most) {
  fits_.clear();
  fill(points, slope);
  find_waves();
  std::vector<Wave> peaks;
  for (std::size_t i = 0; i < waves_.size(); ++i)
    if ((i == 0 || waves_[i].power >= waves_[i - 1].power) &&
        (i + 1 == waves_.size() || waves_[i].power > waves_[i + 1].power))
      peaks.push_back(waves_[i]);
  std::sort(peaks.begin(), peaks.end(), [](const Wave& a, const Wave& b) { return a.power > b.power; });
  if (peaks.size() > most) peaks.resize(most);
  const double angle = std::atan(slope), c = std::cos(angle), s = std::sin(angle);
  for (const Wave& peak : peaks) {
    const double length = 1.0 / peak.frequency;
    const double steeper = angle + std::atan(drift_);
    StepModel start{.run = length * std::cos(steeper),
                    .rise = length * std::sin(steeper),
                    .eye_u = eye.x(),
                    .eye_h = eye.z()};
    // The distance is largest at an edge: t = phase / (2 pi f) - kReach, above the mean by half the height of
    // the wave. The edge nearest to the origin is number 0.
    double t = peak.phase / (2.0 * M_PI * peak.frequency) - kReach;
    t -= length * std::round(t / length);
    const double e = mean_ + drift_ * t + start.rise * start.run / (2.0 * length);
    start.edge_u = t * c - e * s;
    start.edge_h = t * s + e * c;
    if (const StepFit fit = refine(points, start); fit.share > 0.0) fits_.push_back(fit);
  }
  return fits_;
}

}  // namespace adit::perception
