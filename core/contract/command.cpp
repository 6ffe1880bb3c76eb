// SPDX-License-Identifier: Apache-2.0
#include "core/contract/command.hpp"

#include <algorithm>

#include "adit/command.h"
#include "core/command/words.hpp"

namespace adit::contract {
namespace {

radio::PlannedRoute encode(const PlannedRoute& route) {
  radio::PlannedRoute out;
  out.length(static_cast<float>(route.length));
  out.unknown_length(static_cast<float>(route.unknown_length));
  out.corners(static_cast<std::uint16_t>(std::min<std::size_t>(route.corners, UINT16_MAX)));
  const std::size_t count = std::min(route.points.size(), PlannedRoute::kMaxCorners);
  for (std::size_t i = 0; i < count; ++i)
    for (const double metres : route.points[i]) out.points().push_back(static_cast<float>(metres));
  return out;
}

std::optional<PlannedRoute> decode(const radio::PlannedRoute& sample) {
  const auto& points = sample.points();
  if (!finite(sample.length(), sample.unknown_length()) || points.size() % 3 != 0 ||
      points.size() > 3 * PlannedRoute::kMaxCorners)
    return std::nullopt;
  PlannedRoute out{sample.length(), sample.unknown_length(), sample.corners(), {}};
  for (std::size_t i = 0; i < points.size(); i += 3) {
    if (!finite(points[i], points[i + 1])) return std::nullopt;
    out.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  }
  return out;
}

}  // namespace

radio::Command encode(const Command& command) {
  const command::Payload payload = command::pack(command.request);
  radio::Command out;
  out.robot(command.robot);
  out.station(command.station);
  out.station_id(command.station_id);
  out.epoch(encode(command.epoch));
  out.seq(command.seq);
  out.kind(static_cast<radio::CommandKind>(payload.number));
  out.words(payload.words);
  out.numbers(payload.numbers);
  out.options(payload.options);
  return out;
}

Command decode(const radio::Command& sample) {
  Command out{.robot = clipped(sample.robot(), kMaxName),
              .station = clipped(sample.station(), kMaxName),
              .station_id = sample.station_id(),
              .epoch = decode(sample.epoch()),
              .seq = sample.seq()};
  const auto number = static_cast<std::int32_t>(sample.kind());
  auto request = command::unpack({number, sample.words(), sample.numbers(), sample.options()});
  if (request) {
    out.request = std::move(*request);
    return out;
  }
  out.invalid = request.error();
  if (const command::CommandInfo* row = command::find_number(number))
    out.request = command::Request(command::verb_of(*row));
  return out;
}

radio::Joystick encode(const Joystick& sample) {
  radio::Joystick out;
  out.robot(sample.robot);
  out.station_id(sample.station_id);
  out.epoch(encode(sample.epoch));
  out.seq(sample.seq);
  out.echo(sample.echo);
  out.vx(static_cast<float>(sample.twist.vx));
  out.vy(static_cast<float>(sample.twist.vy));
  out.wz(static_cast<float>(sample.twist.wz));
  return out;
}

Joystick decode(const radio::Joystick& sample) {
  return {clipped(sample.robot(), kMaxName),
          sample.station_id(),
          decode(sample.epoch()),
          sample.seq(),
          sample.echo(),
          {sample.vx(), sample.vy(), sample.wz()}};
}

radio::Acknowledgement encode(const Acknowledgement& answer) {
  radio::Acknowledgement out;
  out.robot(answer.robot);
  out.station(clipped(answer.station, kMaxName));
  out.station_id(answer.station_id);
  out.seq(answer.seq);
  out.accepted(answer.accepted());
  out.reason(static_cast<std::uint16_t>(answer.reason));
  out.text(clipped(answer.text, Acknowledgement::kMaxSentText));
  out.holder(answer.holder);
  out.epoch(encode(answer.epoch));
  if (answer.route) out.route({encode(*answer.route)});
  return out;
}

std::optional<Acknowledgement> decode(const radio::Acknowledgement& sample) {
  const bool refused = !sample.accepted();
  if (!command::valid_name(sample.robot()) || (refused && sample.reason() == 0)) return std::nullopt;
  Acknowledgement out{.robot = sample.robot(),
                      .station = clipped(sample.station(), kMaxName),
                      .station_id = sample.station_id(),
                      .seq = sample.seq(),
                      .reason = refused ? static_cast<Reason>(sample.reason()) : Reason::none,
                      .text = command::clean(sample.text(), kMaxText),
                      .holder = cleaned_name(sample.holder()),
                      .epoch = decode(sample.epoch())};
  if (!refused && !sample.route().empty()) out.route = decode(sample.route().front());
  return out;
}

}  // namespace adit::contract
