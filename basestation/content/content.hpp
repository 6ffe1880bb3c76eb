// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "basestation/content/digest_list.hpp"
#include "basestation/content/piece_reader.hpp"
#include "basestation/findings/book.hpp"
#include "basestation/findings/desk.hpp"
#include "basestation/fleet/presence.hpp"
#include "basestation/map/map_replica.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::wire {
template <class T>
class Writer;
}

namespace adit::perception {
class VoxelImage;
}

namespace adit::station {

/// The findings and maps of all robots: takes them by radio, stores them on disk and acknowledges them.
class Content {
 public:
  Content(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
          const Presence& presence);
  ~Content();

  /// Loads the findings from disk.
  void load_findings();
  /// Loads the maps from disk and opens the topics, if the station takes content. Error: wire_failed.
  Result<void> open();
  /// Sends the receipts that are due.
  void acknowledge();
  /// Sends receipts soon, as a robot was heard for the first time.
  void greet() { pieces_.greet(); }
  /// Sets which place robots send first; holds for some seconds.
  void look_at(const LookedAt& place) { look_ = place, looked_ = strand_.now(); }
  /// Forgets the maps of all robots, and what the crew had before.
  void forget_maps();

  const FindingDesk& desk() const { return desk_; }
  FindingBook& book() { return book_; }
  const PieceReader& pieces() const { return pieces_; }
  const MapReceiver& maps() const { return map_.receiver(); }
  const ChunkStore& chunks() const { return map_.chunks(); }

  std::shared_ptr<const perception::VoxelImage> prior{};  ///< What the crew had before; null: nothing.

 private:
  void take(const radio::BulkPiece& sample, const wire::SampleInfo& info);
  /// Whether a robot is heard that carries maps of others.
  bool carrier_heard() const;
  void warn(const std::string& code, const std::string& text);
  FindingDesk::Outputs desk_outputs();
  std::uint32_t drawn_start();

  const StationParams& params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet& fleet_;
  const Presence& presence_;
  std::uint64_t starts_{};  ///< How many times a start was drawn.
  FindingBook book_;
  PieceReader pieces_;  ///< Of all kinds of content.
  FindingDesk desk_;
  MapReplica map_;
  DigestList digests_{};
  std::optional<LookedAt> look_{};  ///< What an operator looked at last.
  Time looked_{};
  std::unique_ptr<wire::Writer<radio::BulkAck>> receipts_;
  std::unique_ptr<wire::RawReader> reader_{};
};

}  // namespace adit::station
