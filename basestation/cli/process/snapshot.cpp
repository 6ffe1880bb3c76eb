// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/process/snapshot.hpp"

#include "basestation/report/json.hpp"

namespace adit::station::cli {

nlohmann::json snapshot_json(const Station& station) {
  constexpr std::size_t most_notices = 30;
  const Fleet& fleet = station.fleet();
  const Time now = station.now();
  nlohmann::json out = list_json(fleet, now);
  out["station"] = station.params().name;
  out["link"] = station.params().link;
  const Counts& counts = station.counts();
  out["commands"] = {{"sent", counts.sent},
                     {"accepted", counts.accepted},
                     {"refused", counts.refused},
                     {"unanswered", counts.unanswered}};
  nlohmann::json notices = nlohmann::json::array();
  const auto& all = fleet.notices();
  for (std::size_t i = all.size() > most_notices ? all.size() - most_notices : 0; i < all.size(); ++i)
    notices.push_back(notice_json(all[i], now));
  out["notices"] = notices;
  nlohmann::json traffic = nlohmann::json::object();
  for (const auto& [agent, view] : fleet.traffic())
    traffic[agent] = {
        {"out", view.total_out}, {"in", view.total_in}, {"age", seconds(now - view.last_heard)}};
  out["traffic"] = traffic;
  return out;
}

}  // namespace adit::station::cli
