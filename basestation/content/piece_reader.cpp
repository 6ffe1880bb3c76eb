// SPDX-License-Identifier: Apache-2.0
#include "basestation/content/piece_reader.hpp"

#include <algorithm>

namespace adit::station {

void PieceReader::hear(const std::string& robot, std::uint32_t session) {
  const Time now = now_();
  if (sessions_.size() >= kMaxRobots && !sessions_.contains(robot)) {
    const auto oldest =
        std::min_element(sessions_.begin(), sessions_.end(),
                         [](const auto& a, const auto& b) { return a.second.heard < b.second.heard; });
    if (now - oldest->second.heard <= kSilent) return;
    sessions_.erase(oldest);
  }
  sessions_[robot] = {session, now};
}

void PieceReader::take(const Piece& piece) {
  hear(piece.robot, piece.session);
  const auto stored = [this, robot = piece.robot, session = piece.session, id = piece.id] {
    // The robot may have started again since: its receipt is of its present session.
    const auto present = sessions_.find(robot);
    if (present != sessions_.end() && present->second.number == session)
      (void)receiver_.take(robot, session, id, now_());
  };
  if (taker_(piece, stored)) return;
  ++refused_[piece.kind];
  receiver_.refused(piece.robot);
}

std::uint64_t PieceReader::refused(transfer::Kind kind) const {
  const auto found = refused_.find(static_cast<std::uint8_t>(kind));
  return found == refused_.end() ? 0 : found->second;
}

}  // namespace adit::station
