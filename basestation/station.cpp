// SPDX-License-Identifier: Apache-2.0
#include "basestation/station.hpp"

#include <algorithm>
#include <utility>

#include "adit/authority.h"
#include "adit/bulk.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "basestation/station_impl.hpp"
#include "core/command/parse.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"
#include "core/transfer/receipt_message.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {

using namespace std::chrono_literals;

namespace {
constexpr std::uint16_t kProtocol = 1;
constexpr Duration kReportPeriod = 2s;
constexpr Duration kTickPeriod = 100ms;
constexpr Duration kChanges = 20ms;  // Changes within it are reported together.
constexpr std::size_t kMaxReportTopics = 16;
constexpr Duration kCarrierHeard = 30s;
constexpr Duration kLookHolds = 5s;      // Front ends say every second what they show.
constexpr std::uint64_t kStartSalt = 1;  // Beside the sequence of the phases.

radio::BulkDigest to_radio(const transfer::ContentDigest& digest) {
  radio::BulkDigest out;
  out.robot(digest.robot);
  out.parts(digest.parts);
  return out;
}
}  // namespace

struct Station::Impl::Radio {
  wire::Writer<radio::Presence> presence{};
  wire::Writer<radio::Capabilities> capabilities{};
  wire::Writer<radio::LinkReport> report{};
  wire::Writer<radio::BulkAck> bulk_ack{};
  std::vector<std::unique_ptr<wire::RawReader>> readers{};
};

Station::Impl::Impl(Station& owner, StationParams params, Executor& strand, wire::Participant& radio)
    : owner_(owner),
      params_(std::move(params)),
      strand_(strand),
      radio_(radio),
      fleet_(params_.name, params_.id),
      sender_({.name = params_.name, .id = params_.id, .discovery_grace = params_.discovery_grace}, strand,
              radio, fleet_),
      stick_(params_.id, strand, radio, fleet_),
      started_(strand.now()),
      random_(params_.seed),
      book_(params_.disk, strand),
      pieces_([&strand] { return strand.now(); }),
      desk_({}, params_.disk, strand, desk_outputs()),
      map_(drawn_start(), params_.disk, strand,
           [this](const std::string& text) { map_trouble("map_not_stored", text); }),
      topics_(std::make_unique<Radio>()) {}

Station::Impl::~Impl() = default;

template <class T>
Result<void> Station::Impl::read(const wire::Topic<T>& topic) {
  auto reader =
      wire::make_reader(radio_, topic, strand_, [this](const T& sample, const wire::SampleInfo& info) {
        fleet_.hear(sample, info);
        changed();
      });
  if (!reader) return reader.error();
  topics_->readers.push_back(std::move(*reader));
  return {};
}

Result<void> Station::Impl::start() {
  if (!command::valid_name(params_.name))
    return {Reason::bad_argument, "'" + command::clean(params_.name, 40) +
                                      "' cannot be an operator's name "
                                      "(1 to 32 of A-Z a-z 0-9 _ -); choose another --name"};
  fleet_.on_notice = [this](const StoredNotice& notice) {
    if (owner_.on_notice) owner_.on_notice(notice);
    changed();
  };
  fleet_.on_robot = [this](const RobotView& robot) {
    sender_.prepare(robot.name);
    pieces_.greet();
    announce_often();
  };
  sender_.on_sent = [this](const RobotCommand& robot_command, std::uint64_t seq) {
    if (owner_.on_sent) owner_.on_sent(robot_command, seq);
  };
  sender_.on_late = [this](const Answer& answer) { late_stop(answer); };

  auto presence = wire::Writer<radio::Presence>::make(radio_, wire::topics::kPresence);
  if (!presence) return presence.error();
  topics_->presence = std::move(*presence);
  auto capabilities = wire::Writer<radio::Capabilities>::make(radio_, wire::topics::kCapabilities);
  if (!capabilities) return capabilities.error();
  topics_->capabilities = std::move(*capabilities);
  auto report = wire::Writer<radio::LinkReport>::make(radio_, wire::topics::kLinkReport);
  if (!report) return report.error();
  topics_->report = std::move(*report);

  if (const std::string lost = desk_.load().text(); !lost.empty())
    desk_outputs().trouble("findings_damaged", lost);
  if (const std::string lost = book_.load(); !lost.empty()) desk_outputs().trouble("findings_damaged", lost);
  for (const auto& [key, finding] : desk_.all()) book_.add(key);

  auto answers =
      wire::make_reader(radio_, wire::topics::kAcknowledgement, strand_,
                        [this](const radio::Acknowledgement& sample, const wire::SampleInfo& info) {
                          heard_acknowledgement(sample, info);
                        });
  if (!answers) return answers.error();
  topics_->readers.push_back(std::move(*answers));
  for (const Result<void>& opened :
       {read(wire::topics::kCapabilities), read(wire::topics::kPresence), read(wire::topics::kRobotState),
        read(wire::topics::kAuthority), read(wire::topics::kBehaviour), read(wire::topics::kRoute),
        read(wire::topics::kNotification), read(wire::topics::kHealth), read(wire::topics::kLinkReport)})
    if (!opened) return opened.error();
  if (auto opened = open_content(); !opened) return opened.error();

  radio::Capabilities self;
  self.name(params_.name);
  self.kind(radio::AGENT_STATION);
  self.id(params_.id);
  self.protocol(kProtocol);
  self.software(params_.software);
  if (params_.place) {
    self.placed(true);
    self.place(*params_.place);
    fleet_.stand_at(*params_.place);
    const auto& [x, y, z] = *params_.place;
    radio_.set_place(radio_.id(), {x, y, z});
  }
  if (auto written = topics_->capabilities.write(self); !written) return written.error();
  announce();

  // The participant may keep this handler longer than the station exists.
  radio_.on_participant(strand_, [this, alive = std::weak_ptr(alive_)](const wire::ParticipantEvent& event) {
    if (alive.expired() || !event.present) return;
    if (event.incompatible.empty()) return announce_often();
    fleet_.say(
        {.level = Level::warning, .code = "other_release", .text = command::clean(event.incompatible, 240)},
        strand_.now());
  });
  // Random phases, so that stations that start together do not send at the same time.
  timers_.push_back(strand_.after(from_seconds(random_.uniform() * seconds(params_.presence)), [this] {
    timers_.push_back(strand_.every(params_.presence, [this] { announce(); }));
  }));
  timers_.push_back(strand_.after(from_seconds(random_.uniform() * seconds(kReportPeriod)), [this] {
    timers_.push_back(strand_.every(kReportPeriod, [this] { report_traffic(); }));
  }));
  timers_.push_back(strand_.every(kTickPeriod, [this] { tick(); }));
  return {};
}

Result<void> Station::Impl::open_content() {
  if (!params_.content) return {};
  if (const std::string lost = map_.load(); !lost.empty()) map_trouble("map_damaged", lost);
  pieces_.add(transfer::Kind::findings, [this](const PieceReader::Piece& piece, PieceReader::Stored stored) {
    return desk_.hear(piece.robot, piece.data, std::move(stored));
  });
  pieces_.otherwise([this](const PieceReader::Piece& piece, const PieceReader::Stored& stored) {
    return map_.take(piece.robot, piece.kind, piece.waiting, piece.data, stored);
  });
  auto ack = wire::Writer<radio::BulkAck>::make(radio_, wire::topics::kBulkAck);
  if (!ack) return ack.error();
  topics_->bulk_ack = std::move(*ack);
  auto pieces = wire::make_reader(
      radio_, wire::topics::kBulk, strand_,
      [this](const radio::BulkPiece& sample, const wire::SampleInfo& info) { heard_piece(sample, info); });
  if (!pieces) return pieces.error();
  topics_->readers.push_back(std::move(*pieces));
  return {};
}

void Station::Impl::heard_piece(const radio::BulkPiece& sample, const wire::SampleInfo& info) {
  // Only the robot itself adds to its map and findings: Fleet::speaks_for would also take a participant that
  // is not known yet.
  const RobotView* robot = fleet_.robot(sample.robot());
  if (closed_ || !robot || robot->participant != info.sender) return;
  pieces_.take(
      {sample.robot(), sample.session(), sample.id(), sample.kind(), sample.waiting(), sample.data()});
}

void Station::Impl::acknowledge_pieces() {
  if (closed_ || !params_.content || fleet_.robots().empty()) return;
  const wire::LinkProfile* link = radio_.sender().link;
  const double bandwidth = link ? link->bandwidth : 0.0;
  const auto receipts = pieces_.due(bandwidth);
  if (!receipts) return;
  radio::BulkAck ack;
  ack.station(params_.name);
  ack.station_id(params_.id);
  ack.start(map_.start());
  for (const auto& [robot, receipt] : *receipts)
    ack.receipts().push_back(transfer::to_message<radio::BulkReceipt>(robot, receipt));
  if (look_ && strand_.now() - looked_ < kLookHolds)
    ack.look({static_cast<float>(look_->x), static_cast<float>(look_->y), static_cast<float>(look_->radius)});
  if (const auto digests = carrier_heard()
                               ? digests_.due(map_.chunks(), receipts->size(), bandwidth, strand_.now())
                               : std::nullopt) {
    ack.all_digests(digests->all);
    for (const transfer::ContentDigest& digest : digests->list) ack.digests().push_back(to_radio(digest));
  }
  (void)topics_->bulk_ack.write(ack);  // Best effort: a receipt has what those before it had.
}

bool Station::Impl::carrier_heard() const {
  const auto& robots = fleet_.robots();
  return std::any_of(robots.begin(), robots.end(), [this](const auto& entry) {
    const RobotView& robot = entry.second;
    return strand_.now() - robot.last_heard < kCarrierHeard &&
           std::find(robot.services.begin(), robot.services.end(), wire::topics::kCarryService) !=
               robot.services.end();
  });
}

std::uint32_t Station::Impl::drawn_start() {
  return static_cast<std::uint32_t>(Random(params_.seed).fork(kStartSalt + starts_++).next()) | 1U;
}

void Station::Impl::map_trouble(const std::string& code, const std::string& text) {
  fleet_.say({.level = Level::warning, .code = code, .text = command::clean(text, 240)}, strand_.now());
}

FindingDesk::Outputs Station::Impl::desk_outputs() {
  return {
      [this](const findings::Finding& f) {
        book_.add(f.key);
        fleet_.say({.robot = f.key.robot,
                    .code = "found",
                    .text = f.key.robot + " found " + command::clean(f.kind, findings::Finding::kKind) +
                            (f.text.empty() ? "" : ": " + command::clean(f.text, findings::Finding::kText))},
                   strand_.now());
      },
      [this](const std::string& code, const std::string& text) {
        fleet_.say({.level = Level::warning, .code = code, .text = command::clean(text, 240)}, strand_.now());
      }};
}

/// Many samples come together: front ends receive their result once.
void Station::Impl::changed() {
  if (change_pending_ || !owner_.on_changed) return;
  change_pending_ = true;
  change_timer_ = strand_.after(kChanges, [this] {
    change_pending_ = false;
    owner_.on_changed();
  });
}

void Station::Impl::announce() {
  if (closed_) return;
  radio::Presence presence;
  presence.name(params_.name);
  presence.kind(radio::AGENT_STATION);
  presence.id(params_.id);
  presence.protocol(kProtocol);
  presence.seq(++presence_seq_);
  fleet_.said_present(presence_seq_, strand_.now());
  (void)topics_->presence.write(presence);  // The next one follows within 1 s.
}

void Station::Impl::announce_often() {
  announce();
  // Its endpoints may not be matched yet, and presence is best effort.
  std::erase_if(timers_, [](const Timer& timer) { return !timer.active(); });
  if (timers_.size() > 32) return;
  for (const Duration delay : {100ms, 300ms, 700ms})
    timers_.push_back(strand_.after(delay, [this] { announce(); }));
}

void Station::Impl::report_traffic() {
  TrafficView view = meter_.read(params_.name, radio_.counters(), radio_.sender(), strand_.now());
  fleet_.carried(radio_.peers(), strand_.now());
  radio::LinkReport report;
  report.agent(params_.name);
  report.discovery_out(view.discovery_out);
  report.discovery_in(view.discovery_in);
  report.total_out(view.total_out);
  report.total_in(view.total_in);
  report.malformed(view.malformed);
  report.link(view.sender.link);
  report.bandwidth(static_cast<float>(view.sender.bandwidth));
  report.queue(static_cast<float>(view.sender.queue));
  report.dropped(view.sender.dropped);
  report.seq(++report_seq_);
  for (const TopicRate& rate : view.topics) {
    if (report.topics().size() == kMaxReportTopics) break;
    radio::TopicTraffic row;
    row.topic(rate.topic);
    row.bytes_out(rate.bytes_out);
    row.samples_out(rate.samples_out);
    row.bytes_in(rate.bytes_in);
    row.samples_in(rate.samples_in);
    row.dropped(rate.dropped);
    report.topics().push_back(row);
  }
  fleet_.own_traffic(std::move(view));
  if (!closed_) (void)topics_->report.write(report);  // Best effort: the next one replaces it.
}

void Station::Impl::heard_acknowledgement(const radio::Acknowledgement& sample,
                                          const wire::SampleInfo& info) {
  if (sample.station() != params_.name || sample.station_id() != params_.id) return;
  // Another robot of that name also answers.
  if (!fleet_.speaks_for(sample.robot(), info.sender)) return;
  fleet_.learn_authority(sample.robot(), sample.holder(), {sample.epoch().start(), sample.epoch().counter()});
  if (sample.seq() != 0) return sender_.hear(sample, info);
  const auto reason = static_cast<Reason>(sample.reason());
  const auto text = command::clean(sample.text(), 240);
  for (const auto& [handle, flow] : std::multimap(flows_))
    if (flow->robot() == sample.robot()) flow->stream_refused(reason, text);
}

Station::Station(StationParams params, Executor& strand, wire::Participant& radio)
    : impl_(std::make_unique<Impl>(*this, std::move(params), strand, radio)) {}
Station::~Station() = default;

Result<void> Station::start() { return impl_->start(); }

std::uint64_t Station::execute(const std::string& line, Done done) {
  return execute(command::parse(line), std::move(done));
}

std::uint64_t Station::execute(const Result<command::Request>& request, Done done) {
  if (!request) return impl_->refuse(request.error(), done);
  if (request->info->runs == command::Runs::terminal)
    return impl_->refuse(
        {Reason::not_supported, std::string(request->info->name) + " works in a terminal only"}, done);
  return impl_->execute(*request, std::move(done));
}

void Station::cancel(std::uint64_t handle) { impl_->cancel(handle); }
std::uint64_t Station::teleop(const std::string& robot, Done done) {
  return impl_->teleop(robot, std::move(done));
}
void Station::stick(std::uint64_t handle, const StickVelocity& velocity) { impl_->stick(handle, velocity); }
const Fleet& Station::fleet() const { return impl_->fleet_; }
const StationParams& Station::params() const { return impl_->params_; }
Time Station::now() const { return impl_->now(); }
const Counts& Station::counts() const { return impl_->sender_.counts(); }
const ChunkStore& Station::map() const { return impl_->chunks(); }
const std::optional<Answer>& Station::last_answer() const { return impl_->last_answer_; }
void Station::map_since(std::uint64_t revision, std::size_t most, MapDone done) {
  impl_->map_since(revision, most, std::move(done));
}

void Station::look_at(const LookedAt& place) { impl_->look_at(place); }
std::size_t Station::findings() const { return impl_->findings(); }
bool Station::closed() const { return impl_->closed_; }

}  // namespace adit::station
