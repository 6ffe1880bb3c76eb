// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/piece_reader.hpp"

namespace adit::station {

void PieceReader::take(const Piece& piece) {
  if (sessions_.size() >= kMaxRobots && !sessions_.contains(piece.robot)) sessions_.clear();
  sessions_[piece.robot] = piece.session;
  const auto stored = [this, robot = piece.robot, session = piece.session, id = piece.id] {
    // The robot may have started again since: its receipt is of its present session.
    const auto present = sessions_.find(robot);
    if (present != sessions_.end() && present->second == session)
      (void)receiver_.take(robot, session, id, now_());
  };
  const auto taker = takers_.find(piece.kind);
  const Taker& use = taker == takers_.end() ? otherwise_ : taker->second;
  if (use && !use(piece, stored)) ++refused_[piece.kind];
}

std::uint64_t PieceReader::refused(transfer::Kind kind) const {
  const auto found = refused_.find(static_cast<std::uint8_t>(kind));
  return found == refused_.end() ? 0 : found->second;
}

}  // namespace adit::station
