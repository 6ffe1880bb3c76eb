// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/presence.hpp"

#include <utility>

#include "adit/discovery.h"
#include "adit/link.h"
#include "core/command/words.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {

using namespace std::chrono_literals;

namespace {
constexpr Duration kReportPeriod = 2s;
constexpr std::size_t kMaxTimers = 31;  // Then further peers hear the periodic announcement only.
}  // namespace

struct Presence::Topics {
  wire::Writer<radio::Presence> presence{};
  wire::Writer<radio::Capabilities> capabilities{};
  wire::Writer<radio::LinkReport> report{};
};

Presence::Presence(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
                   Random& random)
    : params_(params),
      strand_(strand),
      radio_(radio),
      fleet_(fleet),
      random_(random),
      topics_(std::make_unique<Topics>()) {}

Presence::~Presence() = default;

Result<void> Presence::open() {
  auto presence = wire::Writer<radio::Presence>::make(radio_, wire::topics::kPresence);
  if (!presence) return presence.error();
  auto capabilities = wire::Writer<radio::Capabilities>::make(radio_, wire::topics::kCapabilities);
  if (!capabilities) return capabilities.error();
  auto report = wire::Writer<radio::LinkReport>::make(radio_, wire::topics::kLinkReport);
  if (!report) return report.error();
  *topics_ = {std::move(*presence), std::move(*capabilities), std::move(*report)};
  return {};
}

Result<void> Presence::start() {
  const contract::Capabilities self{.name = params_.name,
                                    .kind = contract::AgentKind::station,
                                    .id = params_.id,
                                    .protocol = contract::kProtocolVersion,
                                    .software = params_.software,
                                    .place = params_.place};
  if (params_.place) {
    fleet_.stand_at(*params_.place);
    const auto& [x, y, z] = *params_.place;
    radio_.set_place(radio_.id(), {x, y, z});
  }
  if (auto written = topics_->capabilities.write(encode(self)); !written) return written.error();
  announce();

  // The participant may store this handler longer than the station exists.
  radio_.on_participant(strand_, [this, alive = std::weak_ptr(alive_)](const wire::ParticipantEvent& event) {
    if (alive.expired() || !event.present) return;
    if (event.incompatible.empty()) return announce_often();
    fleet_.say({.severity = Severity::warning,
                .code = "other_release",
                .text = command::clean(event.incompatible, contract::kMaxText)},
               strand_.now());
  });
  // Random phases, so that stations that start together do not send at the same time.
  timers_.push_back(strand_.after(from_seconds(random_.uniform() * seconds(params_.presence)), [this] {
    timers_.push_back(strand_.every(params_.presence, [this] { announce(); }));
  }));
  timers_.push_back(strand_.after(from_seconds(random_.uniform() * seconds(kReportPeriod)), [this] {
    timers_.push_back(strand_.every(kReportPeriod, [this] { report_traffic(); }));
  }));
  return {};
}

void Presence::go_up() {
  up_ = true;
  announce();
}

void Presence::announce() {
  if (!up_) return;
  fleet_.said_present(++presence_seq_, strand_.now());
  // The next one follows within 1 s.
  (void)topics_->presence.write(encode(contract::Presence{
      params_.name, contract::AgentKind::station, params_.id, contract::kProtocolVersion, presence_seq_}));
}

void Presence::announce_often() {
  announce();
  // Presence is best effort.
  std::erase_if(timers_, [](const Timer& timer) { return !timer.active(); });
  if (timers_.size() > kMaxTimers) return;
  for (const Duration delay : {100ms, 300ms, 700ms})
    timers_.push_back(strand_.after(delay, [this] { announce(); }));
}

void Presence::look_at_radio(const wire::WireCounters& counters) {
  const auto say = [this](contract::Severity severity, const char* code, const std::string& text) {
    fleet_.say({.severity = severity, .code = code, .text = command::clean(text, contract::kMaxText)},
               strand_.now());
  };
  if (const std::string news = refusals_.told(counters.refused, strand_.now()); !news.empty())
    say(contract::Severity::warning, "radio_refused", "this station refuses datagrams: " + news);
  constexpr int kLooks = 3;  // A process that was stopped for a while hangs at the first look alone.
  receiver_hangs_ = counters.receiving > kReportPeriod ? receiver_hangs_ + 1 : 0;
  if (receiver_hangs_ == kLooks)
    say(contract::Severity::error, "radio_hangs",
        "a thread of this station that receives from the radio hangs: no answer arrives; end the station and "
        "start it again");
}

void Presence::report_traffic() {
  const wire::WireCounters counters = radio_.counters();
  look_at_radio(counters);
  contract::LinkReport report = meter_.read(params_.name, counters, radio_.sender(), strand_.now());
  fleet_.carried(radio_.peers(), strand_.now());
  radio::LinkReport sample = encode(report);
  sample.seq(++report_seq_);
  fleet_.own_traffic({std::move(report), strand_.now()});
  if (up_) (void)topics_->report.write(sample);  // Best effort: the next one replaces it.
}

}  // namespace adit::station
