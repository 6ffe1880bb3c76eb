// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "core/contract/bulk.hpp"
#include "core/result/result.hpp"
#include "core/transfer/receiver.hpp"

namespace adit::station {

/// Takes the pieces of content of all robots as they come by radio, genuine or not, and hands each to a
/// taker. A piece is acknowledged once its taker says that its content is stored. While 64 robots are heard,
/// pieces of further ones are not acknowledged.
class PieceReader {
 public:
  using Piece = contract::BulkPiece;
  /// Acknowledges the piece: called once, now or later, when its content is stored, or will never be
  /// understood. If it is not called, the content comes again.
  using Stored = std::function<void()>;
  /// Errors: the piece was refused, which is counted.
  using Taker = std::function<Result<void>(const Piece& piece, Stored stored)>;

  /// `now`: the time at which content is stored.
  PieceReader(std::function<Time()> now, Taker taker) : now_(std::move(now)), taker_(std::move(taker)) {}

  void take(const Piece& piece);
  /// Receipts to send now, by robot; see transfer::Receiver::due.
  std::optional<std::vector<std::pair<std::string, transfer::Receipt>>> due(double bandwidth) {
    return receiver_.due(now_(), bandwidth);
  }
  void greet() { receiver_.greet(); }
  /// Pieces of a kind that were refused.
  std::uint64_t refused(transfer::Kind kind) const;

 private:
  static constexpr std::size_t kMaxRobots = 64;
  static constexpr Duration kSilent{30s};  ///< A robot that was silent for longer makes room for another one.
  struct Session {
    std::uint32_t number{};  ///< Of the last one that was heard.
    Time heard{};
  };
  void hear(const std::string& robot, std::uint32_t session);

  std::function<Time()> now_;
  Taker taker_;
  transfer::Receiver receiver_{};
  std::map<std::string, Session> sessions_{};
  std::map<std::uint8_t, std::uint64_t> refused_{};
};

}  // namespace adit::station
