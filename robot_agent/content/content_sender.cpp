// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/content/content_sender.hpp"

#include "core/time/random.hpp"

namespace adit::agent {

ContentSender::ContentSender(std::uint64_t seed, FindingSource& findings, findings::PhotoSources& photos,
                             MapKeeper* map, Carrier* carrier, ShotSource* shots)
    : findings_(findings),
      photos_(photos),
      map_(map),
      carrier_(carrier),
      shots_(shots),
      sender_({.session = static_cast<std::uint32_t>(Random(seed).next()) | 1U}) {
  sender_.add(findings_);
  sender_.add(photos_.thumbnails);
  if (shots_ != nullptr) sender_.add(*shots_);
  if (map_ != nullptr)
    for (transfer::Source* source : map_->sources()) sender_.add(*source);
  if (carrier_ != nullptr)
    for (transfer::Source* source : carrier_->sources()) sender_.add(*source);
  sender_.add(photos_.pictures);
}

void ContentSender::acknowledged(const transfer::Ack& ack, Time now) {
  if (!sender_.acknowledged(ack, now) || ack.carrier) return;
  findings_.heard(ack.peer, now);
  photos_.ledger.heard(ack.peer, now);
  if (map_ != nullptr) map_->heard(ack);
  if (carrier_ != nullptr) carrier_->heard(ack, now);
}

std::vector<transfer::Piece> ContentSender::due(Time now, const wire::SenderState& link) {
  findings_.tick(now);
  photos_.ledger.offer(
      findings::photos_of(findings_.finding_store().all(), [](const auto&) { return true; }));
  photos_.ledger.tick(now);
  if (map_ != nullptr) map_->tick(now);
  if (carrier_ != nullptr) carrier_->tick(now);
  if (shots_ != nullptr) shots_->tick(now);
  return sender_.due(now, link);
}

}  // namespace adit::agent
