// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/content.hpp"

#include <algorithm>
#include <utility>

#include "adit/bulk.h"
#include "basestation/findings/report.hpp"
#include "core/command/words.hpp"
#include "core/contract/bulk.hpp"
#include "core/wire/typed.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::station {
namespace {

constexpr Duration kCarrierHeard{std::chrono::seconds(30)};
constexpr Duration kLookHolds{std::chrono::seconds(5)};  // Front ends say every second what they show.
// Beside the sequence of the phases. Those of starts rise from kStartSalt.
constexpr std::uint64_t kMarkSalt = 0, kSessionSalt = std::uint64_t{1} << 32, kStartSalt = 1;

/// Kind and text of a finding for the log.
std::string words_of(const findings::Finding& f) {
  return command::clean(f.kind, findings::Finding::kKind) +
         (f.text.empty() ? "" : ": " + command::clean(f.text, findings::Finding::kText));
}

}  // namespace

Content::Content(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
                 const Presence& presence)
    : params_(params),
      strand_(strand),
      radio_(radio),
      fleet_(fleet),
      presence_(presence),
      book_(params.disk, strand),
      pieces_([&strand] { return strand.now(); },
              [this](const PieceReader::Piece& piece, PieceReader::Stored stored) {
                return take(piece, std::move(stored));
              }),
      desk_({}, params.disk, strand, desk_outputs()),
      photos_(
          desk_, params.disk, strand,
          [this](const std::string& code, const std::string& text) { warn(code, text); },
          [this] { findings_changed(); }),
      marks_(params.name, params.id, Random(params.seed).fork(kMarkSalt).next(), desk_, strand),
      map_(drawn_start(), params.disk, strand,
           [this](const std::string& text) { warn("map_not_stored", text); }),
      mark_source_(params.name, desk_, marks_),
      mark_photos_(photos_.photos(), params.disk, strand, nullptr),
      mark_sender_(
          {.session = static_cast<std::uint32_t>(Random(params.seed).fork(kSessionSalt).next()) | 1U}) {
  mark_sender_.add(mark_source_);
  mark_sender_.add(mark_photos_.thumbnails);
  mark_sender_.add(mark_photos_.pictures);
  book_.on_change = [this] { findings_changed(); };
}

Content::~Content() = default;

void Content::load_findings() {
  if (const std::string lost = desk_.load().text(); !lost.empty()) warn("findings_damaged", lost);
  if (const std::string lost = book_.load(); !lost.empty()) warn("findings_damaged", lost);
  for (const auto& [key, finding] : desk_.all()) book_.add(key);
  if (const std::string lost = photos_.load(); !lost.empty()) warn("findings_damaged", lost);
  mark_photos_.ledger.load();
}

Result<void> Content::open() {
  if (!params_.content) return {};
  if (const std::string lost = map_.load(); !lost.empty()) warn("map_damaged", lost);
  auto receipts = wire::Writer<radio::BulkAck>::make(radio_, wire::topics::kBulkAck);
  if (!receipts) return receipts.error();
  receipts_ = std::make_unique<wire::Writer<radio::BulkAck>>(std::move(*receipts));
  auto reader = wire::make_reader(
      radio_, wire::topics::kBulk, strand_,
      [this](const radio::BulkPiece& sample, const wire::SampleInfo& info) { take(sample, info); });
  if (!reader) return reader.error();
  reader_ = std::move(*reader);
  return {};
}

void Content::take(const radio::BulkPiece& sample, const wire::SampleInfo& info) {
  // Only the robot itself adds to its map and findings: Fleet::speaks_for would also take a participant that
  // is not known yet. The same holds for another station and its marks.
  if (!presence_.up()) return;
  const auto piece = contract::decode(sample);
  if (!piece) return;
  const RobotView* robot = fleet_.robot(piece->robot);
  if (robot) {  // A station of its name would end its session.
    if (robot->participant == info.sender) pieces_.take(*piece);
    return;
  }
  const auto station = fleet_.stations().find(piece->robot);
  if (station == fleet_.stations().end() || station->second.participant != info.sender) return;
  from_station_ = station->second.id;
  pieces_.take(*piece);
  from_station_.reset();
}

Result<void> Content::take(const PieceReader::Piece& piece, PieceReader::Stored stored) {
  const bool has_findings = piece.kind == static_cast<std::uint8_t>(transfer::Kind::findings);
  if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::photos))
    return photos_.hear(piece.robot, from_station_, piece.data, std::move(stored));
  if (from_station_ && has_findings)
    return desk_.hear_station(piece.robot, *from_station_, piece.data, std::move(stored));
  if (from_station_) return {Reason::malformed, "a station sends marks and their photos only"};
  if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::shots)) {
    Result<void> taken = on_shot ? on_shot(piece.robot, piece.data) : Result<void>();
    if (taken) stored();
    return taken;
  }
  if (has_findings) return desk_.hear(piece.robot, piece.data, std::move(stored));
  return map_.take(piece.robot, piece.kind, piece.waiting, piece.data, std::move(stored));
}

void Content::take(const radio::BulkAck& sample, const wire::SampleInfo& info) {
  const auto ack = contract::decode(sample);
  if (!ack || ack->carrier || !presence_.up()) return;
  const auto station = fleet_.stations().find(ack->station);
  if (station == fleet_.stations().end() || station->second.participant != info.sender ||
      station->second.id != ack->station_id)
    return;
  if (mark_sender_.acknowledged(ack->to(params_.name), strand_.now()))
    mark_photos_.ledger.heard(ack->station_id, strand_.now());
}

bool Content::open_marks() {
  if (marks_out_ || marks_failed_) return !marks_failed_;
  auto writer = wire::Writer<radio::BulkPiece>::make(radio_, wire::topics::kBulk);
  auto reader = wire::make_reader(
      radio_, wire::topics::kBulkAck, strand_,
      [this](const radio::BulkAck& sample, const wire::SampleInfo& info) { take(sample, info); });
  marks_failed_ = !writer || !reader;
  if (marks_failed_) {
    warn("finding_refused", "marks do not reach other stations: a topic could not be opened");
    return false;
  }
  marks_out_ = std::make_unique<wire::Writer<radio::BulkPiece>>(std::move(*writer));
  marks_acknowledged_ = std::move(*reader);
  return true;
}

void Content::send_marks() {
  if (!presence_.up() || !params_.content || fleet_.stations().empty()) return;
  mark_source_.refresh();
  mark_photos_.ledger.offer(findings::photos_of(desk_.all(), [this](const findings::Finding& finding) {
    return marks_.is_own(finding) && desk_.is_stored(finding.key);
  }));
  mark_photos_.ledger.tick(strand_.now());
  if (mark_source_.empty() || !open_marks()) return;
  for (transfer::Piece& piece : mark_sender_.due(strand_.now(), radio_.sender())) {
    const contract::BulkPiece out{params_.name,  mark_sender_.session(),
                                  piece.id,      static_cast<std::uint8_t>(piece.kind),
                                  piece.waiting, std::move(piece.data)};
    (void)marks_out_->write(encode(out));  // Best effort: core/transfer repairs what is lost.
  }
}

void Content::acknowledge() {
  const bool alone = fleet_.robots().empty() && fleet_.stations().empty();
  if (!presence_.up() || !params_.content || alone) return;
  const wire::LinkProfile* link = radio_.sender().link;
  const double bandwidth = link ? link->bandwidth : 0.0;
  const auto receipts = pieces_.due(bandwidth);
  if (!receipts) return;
  contract::BulkAck ack{
      .station = params_.name, .station_id = params_.id, .start = map_.start(), .receipts = *receipts};
  if (look_ && strand_.now() - looked_ < kLookHolds)
    ack.look = {static_cast<float>(look_->x), static_cast<float>(look_->y),
                static_cast<float>(look_->radius)};
  if (carrier_heard())
    if (auto digests = digests_.due(map_.chunks(), receipts->size(), bandwidth, strand_.now())) {
      ack.all_digests = digests->all;
      ack.digests = std::move(digests->list);
    }
  (void)receipts_->write(encode(ack));  // Best effort: a receipt has what those before it had.
}

bool Content::carrier_heard() const {
  const auto& robots = fleet_.robots();
  return std::any_of(robots.begin(), robots.end(), [this](const auto& entry) {
    const RobotView& robot = entry.second;
    return strand_.now() - robot.last_heard < kCarrierHeard &&
           contract::offers(robot.services, contract::service::kCarryMap);
  });
}

void Content::forget_maps() {
  map_.forget(drawn_start());
  prior.reset();
}

std::uint32_t Content::drawn_start() {
  return static_cast<std::uint32_t>(Random(params_.seed).fork(kStartSalt + starts_++).next()) | 1U;
}

void Content::warn(const std::string& code, const std::string& text) {
  fleet_.say({.severity = Severity::warning, .code = code, .text = command::clean(text, contract::kMaxText)},
             strand_.now());
}

FindingCounts Content::finding_counts() const {
  if (counts_.changes == counted_) return counts_;
  counted_ = counts_.changes;
  counts_.listed = static_cast<std::uint32_t>(desk_.all().size());
  counts_.open = 0;
  for (const auto& [key, finding] : desk_.all()) {
    const FindingBook::Judgement* entry = book_.find(key);
    if (!finding.withdrawn && (!entry || entry->verdict == Verdict::open)) ++counts_.open;
  }
  return counts_;
}

FoundReport Content::found(const Fleet& fleet, const std::vector<std::string>& robots) const {
  return findings_report(desk_, book_, marks_, photos(), chunks(), fleet, robots);
}

std::size_t Content::whole_photos() const {
  return static_cast<std::size_t>(std::ranges::count_if(desk_.all(), [this](const auto& entry) {
    const auto& photo = entry.second.photo;
    return photo && photos().state(photo->content).whole;
  }));
}

void Content::findings_changed() {
  ++counts_.changes;
  if (on_findings) on_findings();
}

void Content::say_of(const findings::Finding& f, const char* code, const std::string& text) {
  contract::Notification said{.code = code, .text = text};
  if (!findings::marked_by(f)) said.robot = f.key.robot;
  fleet_.say(std::move(said), strand_.now());
}

/// Robots refine what they found up to every two seconds: a new place or other data is no line in the log.
void Content::revised(const findings::Finding& before, const findings::Finding& now) {
  findings_changed();
  const FindingBook::Judgement* entry = book_.find(now.key);
  const std::string which = "finding " + std::to_string(entry ? entry->number : 0);
  if (now.withdrawn && !before.withdrawn)
    say_of(now, "finding_withdrawn", now.key.robot + " withdrew " + which + ", " + words_of(now));
  else if (before.withdrawn && !now.withdrawn)
    say_of(now, "found", now.key.robot + " found " + which + " again: " + words_of(now));
  else if (!now.withdrawn && (before.kind != now.kind || before.text != now.text))
    say_of(now, "finding_changed", which + " of " + now.key.robot + " is now " + words_of(now));
}

FindingDesk::Outputs Content::desk_outputs() {
  return {[this](const findings::Finding& f) {
            book_.add(f.key);
            const char* did = findings::marked_by(f) ? " marked " : " found ";
            say_of(f, "found", f.key.robot + did + words_of(f));
          },
          [this](const std::string& code, const std::string& text) { warn(code, text); },
          [this](const findings::Finding& before, const findings::Finding& now) { revised(before, now); }};
}

}  // namespace adit::station
