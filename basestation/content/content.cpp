// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/content.hpp"

#include <algorithm>
#include <utility>

#include "adit/bulk.h"
#include "core/command/words.hpp"
#include "core/contract/bulk.hpp"
#include "core/wire/typed.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::station {
namespace {

constexpr Duration kCarrierHeard{std::chrono::seconds(30)};
constexpr Duration kLookHolds{std::chrono::seconds(5)};  // Front ends say every second what they show.
constexpr std::uint64_t kStartSalt = 1;                  // Beside the sequence of the phases.

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
                if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::findings))
                  return desk_.hear(piece.robot, piece.data, std::move(stored));
                return map_.take(piece.robot, piece.kind, piece.waiting, piece.data, std::move(stored));
              }),
      desk_({}, params.disk, strand, desk_outputs()),
      map_(drawn_start(), params.disk, strand,
           [this](const std::string& text) { warn("map_not_stored", text); }) {}

Content::~Content() = default;

void Content::load_findings() {
  if (const std::string lost = desk_.load().text(); !lost.empty()) warn("findings_damaged", lost);
  if (const std::string lost = book_.load(); !lost.empty()) warn("findings_damaged", lost);
  for (const auto& [key, finding] : desk_.all()) book_.add(key);
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
  // is not known yet.
  const RobotView* robot = presence_.up() ? fleet_.robot(sample.robot()) : nullptr;
  if (!robot || robot->participant != info.sender) return;
  if (const auto piece = contract::decode(sample)) pieces_.take(*piece);
}

void Content::acknowledge() {
  if (!presence_.up() || !params_.content || fleet_.robots().empty()) return;
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

FindingDesk::Outputs Content::desk_outputs() {
  return {[this](const findings::Finding& f) {
            book_.add(f.key);
            fleet_.say(
                {.code = "found",
                 .text = f.key.robot + " found " + command::clean(f.kind, findings::Finding::kKind) +
                         (f.text.empty() ? "" : ": " + command::clean(f.text, findings::Finding::kText)),
                 .robot = f.key.robot},
                strand_.now());
          },
          [this](const std::string& code, const std::string& text) { warn(code, text); }};
}

}  // namespace adit::station
