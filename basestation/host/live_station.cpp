// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/live_station.hpp"

#include <cstdio>
#include <future>
#include <random>

#include "basestation/client/paths.hpp"
#include "basestation/host/identity.hpp"
#include "basestation/model/outcome.hpp"
#include "core/store/file_disk.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/link_file.hpp"

namespace adit::station::host {

Result<std::unique_ptr<LiveStation>> LiveStation::open(const client::StationOptions& options,
                                                       const Hooks& hooks) {
  auto id = station_id(options.name);
  if (!id) return id.error();
  auto link = wire::load_link(options.link.empty() ? "lan" : options.link);
  if (!link) return link.error();
  std::unique_ptr<LiveStation> live(new LiveStation);
  wire::FastDdsParams radio{.domain = options.domain,
                            .name = options.name,
                            .interfaces = options.interfaces,
                            .peers = options.peers};
  if (!options.link.empty()) radio.link = *link;
  radio.link_seed = std::random_device{}();
  auto opened = wire::open_fastdds(radio);
  if (!opened) return opened.error();
  live->wire_ = std::move(*opened);
  live->flight_recorder_ = std::make_unique<record::FlightRecorder>(record::FlightRecorderParams{
      .folder = hooks.record ? options.record : "none",
      .name = options.name,
      .about = {{"kind", "station"}, {"software", ADIT_VERSION}},
      .on_error = [](const std::string& text) { std::fprintf(stderr, "basestation: %s\n", text.c_str()); }});
  wire::Participant& wire = live->flight_recorder_->tap(*live->wire_, "radio");
  live->strand_ = live->runtime_.strand("station");
  StationParams params{.name = options.name,
                       .id = *id,
                       .software = ADIT_VERSION,
                       .link = options.link.empty() ? "" : link->name,
                       .bandwidth = options.link.empty() ? 0.0 : link->bandwidth,
                       .content = hooks.content,
                       .presence = hooks.presence,
                       .discovery_grace = hooks.discovery_grace};
  if (options.at.size() == 3) params.place = {options.at[0], options.at[1], options.at[2]};
  for (const std::uint8_t byte : live->wire_->id()) params.seed = params.seed * 257 + byte;
  // An unusable disk must not prevent stops of robots: findings then stay in memory.
  if (const auto folder = client::state_folder(); folder && hooks.content) {
    auto disk = store::FileDisk::open(*folder + "/findings-" + options.name);
    if (disk)
      params.disk = std::move(*disk);
    else
      std::fprintf(stderr, "basestation: findings are not kept: %s\n", disk.error().text.c_str());
  }
  Result<void> started;
  live->on_strand([&] {
    live->station_ = std::make_unique<Station>(std::move(params), *live->strand_, wire);
    if (hooks.ready) hooks.ready(*live->station_);
    started = live->station_->start();
  });
  if (!started) return started.error();
  return live;
}

LiveStation::~LiveStation() {
  if (strand_ && station_) on_strand([this] { station_.reset(); });
}

void LiveStation::on_strand(const std::function<void()>& work) {
  std::promise<void> done;
  strand_->post([&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

Outcome LiveStation::execute(const command::Request& request, std::chrono::milliseconds limit) {
  const auto ended = std::make_shared<std::promise<Outcome>>();
  auto future = ended->get_future();
  strand_->post([this, request, ended] {
    station_->execute(request, [ended](const Outcome& outcome) { ended->set_value(outcome); });
  });
  if (future.wait_for(limit) == std::future_status::ready) return future.get();
  return failed_outcome(kExitNoAnswer, {Reason::no_answer, "no answer"});
}

}  // namespace adit::station::host
