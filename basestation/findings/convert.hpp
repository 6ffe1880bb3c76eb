// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversions between the radio contract's findings and the station's. Included by .cpp files only.
#include "adit/findings.h"
#include "basestation/findings/desk.hpp"

namespace adit::station {

inline findings::Finding from_radio(const radio::Finding& in) {
  return {{in.robot(), in.id()}, in.kind(), in.importance(), in.position(), in.stamp(), in.text(), in.data()};
}

inline radio::FindingsAck to_radio(const std::string& robot, const std::array<std::uint8_t, 16>& station,
                                   const std::vector<std::uint64_t>& ids) {
  radio::FindingsAck out;
  out.robot(robot);
  out.station_id(station);
  out.ids(ids);
  return out;
}

}  // namespace adit::station
