// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/radio/convert.hpp"

namespace adit::agent {
namespace {

constexpr double kMaxSpeed = 50.0;        // m/s or rad/s: no robot is faster.
constexpr double kMaxLength = 100'000.0;  // m: no path of a mission is longer.
constexpr double kMaxWidth = 10.0;        // m: no robot is wider.
constexpr double kCentimetres = 100.0;
constexpr std::size_t kMaxModeName = 32;

bool within(double value, double limit) { return std::isfinite(value) && std::fabs(value) <= limit; }

std::optional<ConvoyPart> part_from_radio(const radio::ConvoyPart& in, const Eigen::Vector3d& place) {
  const bool numbers = within(in.along(), kMaxLength) && within(in.gap(), kMaxLength);
  const std::size_t count = in.points().size();
  if (!numbers || count % 3 != 0 || count > 3 * ConvoyPart::kPoints) return std::nullopt;
  ConvoyPart out{in.convoy(), in.order_hash(), in.index(),  in.left(),  in.placed(),
                 in.along(),  in.gap(),        in.wanted(), in.first(), {}};
  for (std::size_t i = 0; i < count; i += 3)
    out.points.push_back(place + Eigen::Vector3d(in.points()[i], in.points()[i + 1], in.points()[i + 2]) /
                                     kCentimetres);
  return out;
}

radio::ConvoyPart part_to_radio(const ConvoyPart& part, const Eigen::Vector3d& place) {
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
  for (const Eigen::Vector3d& point : part.points) {
    const Eigen::Vector3d away = (point - place) * kCentimetres;
    // A point that is too far away for the message ends the list: its successors would be misnumbered.
    if (!(away.cwiseAbs().maxCoeff() < INT16_MAX) || out.points().size() == 3 * ConvoyPart::kPoints) break;
    for (const double value : {away.x(), away.y(), away.z()})
      out.points().push_back(static_cast<std::int16_t>(std::lround(value)));
  }
  return out;
}

std::optional<YieldAsk> ask_from_radio(const radio::YieldAsk& in, const Eigen::Vector2d& place) {
  const std::size_t count = in.route().size();
  const bool names =
      !in.to().empty() && in.to().size() <= YieldAsk::kRobots && valid_name(in.root()) &&
      std::all_of(in.to().begin(), in.to().end(), [](const auto& to) { return valid_name(to); });
  if (!names || !(in.width() > 0.0f) || !within(in.width(), kMaxWidth) || count % 2 != 0 || count < 4 ||
      count > 2 * YieldAsk::kPoints)
    return std::nullopt;
  YieldAsk out{in.to(), in.root(), in.width(), {}};
  for (std::size_t i = 0; i < count; i += 2)
    out.route.push_back(place + Eigen::Vector2d(in.route()[i], in.route()[i + 1]) / kCentimetres);
  return out;
}

radio::YieldAsk ask_to_radio(const YieldAsk& ask, const Eigen::Vector2d& place) {
  radio::YieldAsk out;
  out.to(ask.to);
  out.root(ask.root);
  out.width(static_cast<float>(ask.width));
  for (const Eigen::Vector2d& point : ask.route) {
    const Eigen::Vector2d away = (point - place) * kCentimetres;
    if (!(away.cwiseAbs().maxCoeff() < INT16_MAX) || out.route().size() == 2 * YieldAsk::kPoints) break;
    for (const double value : {away.x(), away.y()})
      out.route().push_back(static_cast<std::int16_t>(std::lround(value)));
  }
  return out;
}

std::optional<YieldAnswer> answer_from_radio(const radio::YieldAnswer& in) {
  const auto& [x, y] = in.place();
  if (!valid_name(in.root()) || !within(x, kFarthestPlace) || !within(y, kFarthestPlace)) return std::nullopt;
  return YieldAnswer{in.root(), in.clears(), static_cast<Reason>(in.reason()), {x, y}};
}

radio::YieldAnswer answer_to_radio(const YieldAnswer& answer) {
  radio::YieldAnswer out;
  out.root(answer.root);
  out.clears(answer.clears);
  out.reason(static_cast<std::uint16_t>(answer.reason));
  out.place({static_cast<float>(answer.place.x()), static_cast<float>(answer.place.y())});
  return out;
}

}  // namespace

std::optional<TeamBeacon> from_radio(const radio::TeamBeacon& in) {
  const auto& [x, y, z, yaw] = in.pose();
  const auto& [vx, vy, wz] = in.speed();
  const bool numbers = within(x, kFarthestPlace) && within(y, kFarthestPlace) && within(z, kFarthestPlace) &&
                       within(yaw, 7.0) && within(vx, kMaxSpeed) && within(vy, kMaxSpeed) &&
                       within(wz, kMaxSpeed);
  const bool names = valid_name(in.robot()) && in.mode().size() <= kMaxModeName &&
                     command::clean(in.mode(), kMaxModeName) == in.mode() &&
                     (in.holder().empty() || valid_name(in.holder()));
  const bool parts = in.convoy().size() <= 1 && in.ask().size() <= 1 && in.answer().size() <= 1;
  if (!numbers || !names || !parts) return std::nullopt;
  TeamBeacon out{in.robot(),  in.start(),   in.seq(),  {x, y, wrap_angle(yaw)},
                 z,           {vx, vy, wz}, in.mode(), in.stopped(),
                 in.holder(), {},           in.rank(), in.yields()};
  for (const radio::ConvoyPart& part : in.convoy()) {
    out.convoy = part_from_radio(part, {x, y, z});
    if (!out.convoy) return std::nullopt;
  }
  for (const radio::YieldAsk& ask : in.ask())
    if (!(out.ask = ask_from_radio(ask, {x, y}))) return std::nullopt;
  for (const radio::YieldAnswer& answer : in.answer())
    if (!(out.answer = answer_from_radio(answer))) return std::nullopt;
  return out;
}

radio::TeamBeacon to_radio(const TeamBeacon& beacon) {
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
  if (beacon.convoy) out.convoy({part_to_radio(*beacon.convoy, {x, y, z})});
  out.rank(beacon.rank);
  out.yields(beacon.yields);
  if (beacon.ask) out.ask({ask_to_radio(*beacon.ask, {x, y})});
  if (beacon.answer) out.answer({answer_to_radio(*beacon.answer)});
  return out;
}

}  // namespace adit::agent
