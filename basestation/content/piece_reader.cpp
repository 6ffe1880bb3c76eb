// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/piece_reader.hpp"

#include <algorithm>

namespace adit::station {

void PieceReader::hear(const std::string& robot, std::uint32_t session) {
  const Time now = now_();
  if (senders_.size() >= kMaxRobots && !senders_.contains(robot)) {
    const auto oldest = std::min_element(senders_.begin(), senders_.end(), [](const auto& a, const auto& b) {
      return a.second.heard < b.second.heard;
    });
    if (now - oldest->second.heard <= kSilent) return;
    senders_.erase(oldest);
  }
  senders_[robot] = {session, now};
}

void PieceReader::take(const Piece& piece) {
  hear(piece.robot, piece.session);
  const auto stored = [this, robot = piece.robot, session = piece.session, id = piece.id] {
    // The robot may have started again since: its receipt is of its present session.
    const auto present = senders_.find(robot);
    if (present != senders_.end() && present->second.session == session)
      (void)receiver_.take(robot, session, id, now_());
  };
  const auto taker = takers_.find(piece.kind);
  const Taker& use = taker == takers_.end() ? otherwise_ : taker->second;
  if (!use || use(piece, stored)) return;
  ++refused_[piece.kind];
  receiver_.refused(piece.robot);
}

std::uint64_t PieceReader::refused(transfer::Kind kind) const {
  const auto found = refused_.find(static_cast<std::uint8_t>(kind));
  return found == refused_.end() ? 0 : found->second;
}

}  // namespace adit::station
