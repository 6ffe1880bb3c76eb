// SPDX-License-Identifier: Apache-2.0
#include "core/contract/team.hpp"

#include <algorithm>
#include <cmath>

#include "adit/team.h"
#include "core/command/words.hpp"

namespace adit::contract {
namespace {

constexpr double kMaxSpeed = 50.0;        // m/s or rad/s: no robot is faster.
constexpr double kMaxLength = 100'000.0;  // m: no path of a mission is longer.
constexpr double kMaxWidth = 10.0;        // m: no robot is wider.

using Offsets = std::vector<std::int16_t>;

/// Appends the offset of a point from the sender's position. Returns false if it is too large to be sent.
template <int kSize>
bool append(Offsets& out, const Eigen::Matrix<double, kSize, 1>& point,
            const Eigen::Matrix<double, kSize, 1>& place) {
  const Eigen::Matrix<double, kSize, 1> offset = (point - place) * kBeaconUnitsPerMetre;
  if (!(offset.cwiseAbs().maxCoeff() < INT16_MAX)) return false;
  for (const double value : offset) out.push_back(static_cast<std::int16_t>(std::lround(value)));
  return true;
}

template <int kSize>
std::vector<Eigen::Matrix<double, kSize, 1>> points_of(const Offsets& in,
                                                       const Eigen::Matrix<double, kSize, 1>& place) {
  std::vector<Eigen::Matrix<double, kSize, 1>> out;
  for (std::size_t i = 0; i + kSize <= in.size(); i += kSize)
    out.push_back(place +
                  Eigen::Map<const Eigen::Matrix<std::int16_t, kSize, 1>>(&in[i]).template cast<double>() /
                      kBeaconUnitsPerMetre);
  return out;
}

bool within(double value, double limit) { return std::isfinite(value) && std::fabs(value) <= limit; }

std::optional<ConvoyPart> decode_part(const radio::ConvoyPart& in, const Eigen::Vector3d& place) {
  const bool numbers = within(in.along(), kMaxLength) && within(in.gap(), kMaxLength);
  const std::size_t count = in.points().size();
  if (!numbers || count % 3 != 0 || count > 3 * ConvoyPart::kPoints) return std::nullopt;
  return ConvoyPart{in.convoy(), in.order_hash(), in.index(),  in.left(),  in.placed(),
                    in.along(),  in.gap(),        in.wanted(), in.first(), points_of(in.points(), place)};
}

radio::ConvoyPart encode_part(const ConvoyPart& part, const Eigen::Vector3d& place) {
  radio::ConvoyPart out;
  out.convoy(part.convoy);
  out.order_hash(part.order_hash);
  out.index(part.index);
  out.left(part.left);
  out.placed(part.placed);
  out.along(static_cast<float>(part.along));
  out.gap(static_cast<float>(part.gap));
  out.wanted(part.wanted);
  out.first(part.first);
  // A point that is too far away for the message ends the list: its successors would be misnumbered.
  const std::size_t count = std::min(part.points.size(), ConvoyPart::kPoints);
  for (std::size_t i = 0; i < count && append(out.points(), part.points[i], place);) ++i;
  return out;
}

std::optional<YieldAsk> decode_ask(const radio::YieldAsk& in, const Eigen::Vector2d& place) {
  const std::size_t count = in.route().size();
  const bool names =
      !in.to().empty() && in.to().size() <= YieldAsk::kRobots && command::valid_name(in.root()) &&
      std::all_of(in.to().begin(), in.to().end(), [](const auto& to) { return command::valid_name(to); });
  if (!names || !(in.width() > 0.0f) || !within(in.width(), kMaxWidth) || count % 2 != 0 || count < 4 ||
      count > 2 * YieldAsk::kPoints)
    return std::nullopt;
  return YieldAsk{in.to(), in.root(), in.width(), points_of(in.route(), place)};
}

radio::YieldAsk encode_ask(const YieldAsk& ask, const Eigen::Vector2d& place) {
  radio::YieldAsk out;
  out.to(ask.to);
  out.root(ask.root);
  out.width(static_cast<float>(ask.width));
  const std::size_t count = std::min(ask.route.size(), YieldAsk::kPoints);
  for (std::size_t i = 0; i < count && append(out.route(), ask.route[i], place);) ++i;
  return out;
}

std::optional<YieldAnswer> decode_answer(const radio::YieldAnswer& in) {
  const auto& [x, y] = in.place();
  if (!command::valid_name(in.root()) || !within(x, kFarthestPlace) || !within(y, kFarthestPlace))
    return std::nullopt;
  return YieldAnswer{in.root(), in.clears(), static_cast<Reason>(in.reason()), {x, y}};
}

radio::YieldAnswer encode_answer(const YieldAnswer& answer) {
  radio::YieldAnswer out;
  out.root(answer.root);
  out.clears(answer.clears);
  out.reason(static_cast<std::uint16_t>(answer.reason));
  out.place({static_cast<float>(answer.place.x()), static_cast<float>(answer.place.y())});
  return out;
}

}  // namespace

std::optional<TeamBeacon> decode(const radio::TeamBeacon& in) {
  const auto& [x, y, z, yaw] = in.pose();
  const auto& [vx, vy, wz] = in.speed();
  const bool numbers = within(x, kFarthestPlace) && within(y, kFarthestPlace) && within(z, kFarthestPlace) &&
                       within(yaw, 7.0) && within(vx, kMaxSpeed) && within(vy, kMaxSpeed) &&
                       within(wz, kMaxSpeed);
  const bool names = command::valid_name(in.robot()) && in.mode().size() <= kMaxName &&
                     command::clean(in.mode(), kMaxName) == in.mode() &&
                     (in.holder().empty() || command::valid_name(in.holder()));
  const bool parts = in.convoy().size() <= 1 && in.ask().size() <= 1 && in.answer().size() <= 1;
  if (!numbers || !names || !parts) return std::nullopt;
  TeamBeacon out{in.robot(),  in.start(),   in.seq(),  {x, y, wrap_angle(yaw)},
                 z,           {vx, vy, wz}, in.mode(), in.stopped(),
                 in.holder(), {},           in.rank(), in.yields()};
  for (const radio::ConvoyPart& part : in.convoy()) {
    out.convoy = decode_part(part, {x, y, z});
    if (!out.convoy) return std::nullopt;
  }
  for (const radio::YieldAsk& ask : in.ask())
    if (!(out.ask = decode_ask(ask, {x, y}))) return std::nullopt;
  for (const radio::YieldAnswer& answer : in.answer())
    if (!(out.answer = decode_answer(answer))) return std::nullopt;
  return out;
}

radio::TeamBeacon encode(const TeamBeacon& beacon) {
  radio::TeamBeacon out;
  out.robot(beacon.robot);
  out.start(beacon.start);
  out.seq(beacon.seq);
  out.pose({static_cast<float>(beacon.pose.x), static_cast<float>(beacon.pose.y),
            static_cast<float>(beacon.z), static_cast<float>(beacon.pose.yaw)});
  out.speed({static_cast<float>(beacon.twist.vx), static_cast<float>(beacon.twist.vy),
             static_cast<float>(beacon.twist.wz)});
  out.mode(beacon.mode);
  out.stopped(beacon.stopped);
  out.holder(beacon.holder);
  // The receiver adds the points to the position as it was sent.
  const auto& [x, y, z, yaw] = out.pose();
  if (beacon.convoy) out.convoy({encode_part(*beacon.convoy, {x, y, z})});
  out.rank(beacon.rank);
  out.yields(beacon.yields);
  if (beacon.ask) out.ask({encode_ask(*beacon.ask, {x, y})});
  if (beacon.answer) out.answer({encode_answer(*beacon.answer)});
  return out;
}

}  // namespace adit::contract
