// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "basestation/content/digest_list.hpp"
#include "basestation/content/piece_reader.hpp"
#include "basestation/findings/book.hpp"
#include "basestation/findings/desk.hpp"
#include "basestation/findings/mark_source.hpp"
#include "basestation/findings/marks.hpp"
#include "basestation/findings/photo_desk.hpp"
#include "basestation/fleet/presence.hpp"
#include "basestation/map/map_replica.hpp"
#include "basestation/model/found.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/world.hpp"
#include "core/findings/photo_source.hpp"
#include "core/transfer/sender.hpp"

namespace adit::wire {
template <class T>
class Writer;
}

namespace adit::perception {
class VoxelImage;
}

namespace adit::station {

class Fleet;

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
  /// Sends other stations the marks, and their photos, that they lack.
  void send_marks();
  /// Sends receipts soon, as a robot was heard for the first time.
  void greet() { pieces_.greet(); }
  /// Sets which place robots send first; holds for some seconds.
  void look_at(const LookedAt& place) { look_ = place, looked_ = strand_.now(); }
  /// Forgets the maps of all robots, and what the crew had before.
  void forget_maps();

  const FindingDesk& desk() const { return desk_; }
  FindingBook& book() { return book_; }
  Marks& marks() { return marks_; }
  findings::PhotoStore& photos() { return photos_.photos(); }
  const findings::PhotoStore& photos() const { return photos_.photos(); }
  /// The findings of the named robots and stations, or of all; see findings_report().
  FoundReport found(const Fleet& fleet, const std::vector<std::string>& robots) const;
  /// Findings whose whole photo is here.
  std::size_t whole_photos() const;
  const FindingBook& book() const { return book_; }
  const PieceReader& pieces() const { return pieces_; }
  FindingCounts finding_counts() const;
  const MapReceiver& maps() const { return map_.receiver(); }
  const ChunkStore& chunks() const { return map_.chunks(); }

  std::shared_ptr<const perception::VoxelImage> prior{};  ///< What the crew had before; null: nothing.
  /// Takes a piece of a single picture that a robot's camera took; empty: none is taken.
  std::function<Result<void>(const std::string& robot, std::span<const std::uint8_t> bytes)> on_shot{};
  std::function<void()> on_findings{};  ///< Called when finding_counts() changed; may be empty.

 private:
  void take(const radio::BulkPiece& sample, const wire::SampleInfo& info);
  Result<void> take(const PieceReader::Piece& piece, PieceReader::Stored stored);
  /// Takes what another station has of this station's pieces.
  void take(const radio::BulkAck& sample, const wire::SampleInfo& info);
  /// Opens the ends of the topics on which marks go out; false after an error.
  bool open_marks();
  /// Whether a robot is heard that carries maps of others.
  bool carrier_heard() const;
  void warn(const std::string& code, const std::string& text);
  FindingDesk::Outputs desk_outputs();
  void findings_changed();
  void revised(const findings::Finding& before, const findings::Finding& now);
  void say_of(const findings::Finding& finding, const char* code, const std::string& text);
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
  PhotoDesk photos_;
  Marks marks_;
  MapReplica map_;
  DigestList digests_{};
  std::optional<LookedAt> look_{};  ///< What an operator looked at last.
  Time looked_{};
  mutable FindingCounts counts_{.changes = 1};
  mutable std::uint64_t counted_{};  ///< FindingCounts::changes when the others were counted.
  MarkSource mark_source_;
  findings::PhotoSources mark_photos_;
  transfer::Sender mark_sender_;
  bool marks_failed_{};               ///< The ends for marks could not be opened.
  std::optional<Id> from_station_{};  ///< The station whose piece is being taken; nothing: a robot's.
  std::unique_ptr<wire::Writer<radio::BulkPiece>> marks_out_;
  std::unique_ptr<wire::RawReader> marks_acknowledged_{};
  std::unique_ptr<wire::Writer<radio::BulkAck>> receipts_;
  std::unique_ptr<wire::RawReader> reader_{};
};

}  // namespace adit::station
