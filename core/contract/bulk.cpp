// SPDX-License-Identifier: Apache-2.0
#include "core/contract/bulk.hpp"

#include "adit/bulk.h"
#include "core/command/words.hpp"

namespace adit::contract {

radio::BulkPiece encode(const BulkPiece& piece) {
  radio::BulkPiece out;
  out.robot(piece.robot);
  out.session(piece.session);
  out.id(piece.id);
  out.kind(piece.kind);
  out.waiting(piece.waiting);
  out.data(piece.data);
  return out;
}

std::optional<BulkPiece> decode(const radio::BulkPiece& sample) {
  if (!command::valid_name(sample.robot()) || sample.data().size() > transfer::kMaxPieceBytes)
    return std::nullopt;
  return BulkPiece{sample.robot(), sample.session(), sample.id(),
                   sample.kind(),  sample.waiting(), sample.data()};
}

transfer::Ack BulkAck::to(const std::string& robot) const {
  transfer::Ack out{.peer = station_id,
                    .start = start,
                    .look = look,
                    .carrier = carrier,
                    .digests = digests,
                    .all_digests = all_digests};
  for (const auto& [sender, receipt] : receipts) {
    if (sender == robot) out.receipt = receipt;
    out.senders.push_back(sender);
  }
  return out;
}

radio::BulkAck encode(const BulkAck& ack) {
  radio::BulkAck out;
  out.station(ack.station);
  out.station_id(ack.station_id);
  out.start(ack.start);
  for (const auto& [robot, receipt] : ack.receipts) {
    radio::BulkReceipt& message = out.receipts().emplace_back();
    message.robot(robot);
    message.session(receipt.session);
    message.newest(receipt.newest);
    message.received(receipt.received);
  }
  if (ack.look) out.look({ack.look->x, ack.look->y, ack.look->radius});
  out.carrier(ack.carrier);
  out.all_digests(ack.all_digests);
  for (const transfer::ContentDigest& digest : ack.digests) {
    radio::BulkDigest& message = out.digests().emplace_back();
    message.robot(digest.robot);
    message.parts(digest.parts);
  }
  return out;
}

std::optional<BulkAck> decode(const radio::BulkAck& sample) {
  if (!command::valid_name(sample.station())) return std::nullopt;
  BulkAck out{.station = sample.station(),
              .station_id = sample.station_id(),
              .start = sample.start(),
              .carrier = sample.carrier(),
              .all_digests = sample.all_digests()};
  for (const radio::BulkReceipt& message : sample.receipts())
    if (command::valid_name(message.robot()) && out.receipts.size() < BulkAck::kMaxReceipts)
      out.receipts.push_back({message.robot(), {message.session(), message.newest(), message.received()}});
  if (sample.look().size() == 3) {
    const transfer::Look look{sample.look()[0], sample.look()[1], sample.look()[2]};
    if (finite(look.x, look.y) && look.radius > 0.0F && look.radius <= transfer::Look::kMaxRadius)
      out.look = look;
  }
  for (const radio::BulkDigest& message : sample.digests())
    if (command::valid_name(message.robot()) && out.digests.size() < BulkAck::kMaxDigests)
      out.digests.push_back({message.robot(), message.parts()});
  return out;
}

}  // namespace adit::contract
