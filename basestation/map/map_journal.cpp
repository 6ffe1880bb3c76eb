// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_journal.hpp"

#include <array>
#include <span>
#include <utility>

#include "core/store/background.hpp"
#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"
#include "core/store/preserve.hpp"
#include "core/transfer/piece.hpp"

namespace adit::station {
namespace {

// A header: kind and version, start (0: it has ended), CRC-32C of both. Then batches: u32 length, CRC-32C of
// the length, CRC-32C of the content, content. The content is pieces. One without a robot's name is a mark:
// the start has ended; its data is the name of a robot of which nothing that comes before it counts, or
// empty.
constexpr std::array<std::uint8_t, 4> kKind{'A', 'M', 'P', 1};
constexpr std::size_t kHeaderBytes = 12, kBatchHeader = 12;
constexpr std::size_t kMaxName = 64;
constexpr std::size_t kLongest = std::size_t{48} << 20;  // Files that are longer are not read.

JournalPiece mark(const std::string& forgotten) { return {.data = {forgotten.begin(), forgotten.end()}}; }
bool is_mark(const JournalPiece& piece) { return piece.robot.empty(); }

store::Bytes header(std::uint32_t start) {
  store::Packer out;
  out.put(kKind).put(start);
  out.put(crc32c(out.bytes()));
  return out.bytes();
}

void add_piece(store::Packer& content, const JournalPiece& piece) {
  content.text(piece.robot)
      .put(piece.kind)
      .put(static_cast<std::uint16_t>(piece.data.size()))
      .raw(piece.data);
}

void add_batch(store::Bytes& out, std::span<const std::uint8_t> content) {
  store::Packer head;
  head.put(static_cast<std::uint32_t>(content.size()));
  head.put(crc32c(head.bytes())).put(crc32c(content));
  out.insert(out.end(), head.bytes().begin(), head.bytes().end());
  out.insert(out.end(), content.begin(), content.end());
}

store::Bytes complete_file(std::uint32_t start, const std::vector<JournalPiece>& pieces) {
  store::Bytes out = header(start);
  store::Packer content;
  for (const JournalPiece& piece : pieces) add_piece(content, piece);
  if (!pieces.empty()) add_batch(out, content.bytes());
  return out;
}

enum class Read { good, damaged, unfinished };

/// Reads one batch off the front of `left`.
Read take_batch(std::span<const std::uint8_t>& left, std::vector<JournalPiece>& pieces) {
  store::Unpacker head(left);
  const auto length = head.get<std::uint32_t>(), length_sum = head.get<std::uint32_t>(),
             sum = head.get<std::uint32_t>();
  // Each write is waited for, so that only the last one can be cut off.
  if (!head.good()) return Read::unfinished;
  if (length_sum != crc32c(left.first(4))) return Read::damaged;
  if (length > left.size() - kBatchHeader) return Read::unfinished;
  const auto content = left.subspan(kBatchHeader, length);
  if (crc32c(content) != sum) return Read::damaged;
  store::Unpacker in(content);
  std::vector<JournalPiece> read;
  while (in.good() && !in.rest().empty()) {
    JournalPiece piece{.robot = in.text(kMaxName)};
    piece.kind = in.get<std::uint8_t>();
    const auto bytes = in.bytes(UINT16_MAX);
    piece.data.assign(bytes.begin(), bytes.end());
    if (in.good()) read.push_back(std::move(piece));
  }
  if (!in.good()) return Read::damaged;
  for (JournalPiece& piece : read) pieces.push_back(std::move(piece));
  left = left.subspan(kBatchHeader + length);
  return Read::good;
}

/// Removes the marks, and what they make void.
void apply_marks(LoadedJournal& journal) {
  std::vector<JournalPiece> pieces;
  for (JournalPiece& piece : journal.pieces) {
    if (!is_mark(piece)) {
      pieces.push_back(std::move(piece));
      continue;
    }
    journal.start = 0;
    const std::string forgotten(piece.data.begin(), piece.data.end());
    if (!forgotten.empty())
      std::erase_if(pieces, [&](const JournalPiece& before) { return before.robot == forgotten; });
  }
  journal.pieces = std::move(pieces);
}

}  // namespace

/// One access to the disk.
struct MapJournal::Batch {
  enum class Kind { append, replace, remove };

  Kind kind{Kind::append};
  std::vector<Waiting> pieces{};
  store::Bytes bytes{};
  std::function<store::Bytes()> pack{};  ///< Of `replace`: makes `bytes`.
  std::size_t max_bytes{};               ///< Of `replace`.
  bool ran{false};
  Result<void> result{};

  void run(store::Disk& disk) {
    if (kind == Kind::append) {
      result = disk.append(kFile, bytes);
    } else if (kind == Kind::remove) {
      result = disk.remove(kFile);
    } else {
      bytes = std::exchange(pack, nullptr)();
      if (bytes.size() > max_bytes)
        result = {Reason::cannot_write, "it takes " + std::to_string(bytes.size() >> 10) + " KiB"};
      else
        result = disk.replace(kFile, bytes);
    }
    ran = true;
  }
};

MapJournal::MapJournal(MapJournalParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                       std::function<void(const std::string& text)> trouble,
                       std::function<PackMap()> copy_map)
    : params_(params),
      disk_(std::move(disk)),
      home_(home),
      trouble_(std::move(trouble)),
      copy_map_(std::move(copy_map)),
      self_(std::make_shared<MapJournal*>(this)) {}

MapJournal::~MapJournal() { *self_ = nullptr; }

LoadedJournal MapJournal::load() {
  LoadedJournal out;
  if (!disk_) return out;
  const auto read = disk_->read(kFile, kLongest);
  if (!read) {
    out.lost = read.error().text;
    return out;
  }
  if (!*read) return out;
  std::span<const std::uint8_t> left(**read);
  out.bytes = left.size();
  store::Unpacker head(left);
  const auto kind = head.array<4>();
  const auto start = head.get<std::uint32_t>(), sum = head.get<std::uint32_t>();
  const bool good = head.good() && kind == kKind && sum == crc32c(left.first(kHeaderBytes - 4));
  if (good) {
    left = left.subspan(kHeaderBytes);
    Read batch = Read::good;
    while (!left.empty() && batch == Read::good) batch = take_batch(left, out.pieces);
    if (batch != Read::damaged) {
      out.start = start;
      out.unfinished = batch == Read::unfinished;
      apply_marks(out);
      return out;
    }
    apply_marks(out);
  }
  const std::string aside = copy_aside();
  out.lost = std::string("the map on the disk is damaged, and robots send it again") +
             (aside.empty() ? "" : "; a copy is " + aside);
  return out;
}

std::string MapJournal::copy_aside() {
  return disk_ ? store::copy_aside(*disk_, kFile, "corrupt") : std::string{};
}

void MapJournal::begin(std::uint32_t start, const std::vector<JournalPiece>& pieces) {
  start_ = start;
  ended_ = Ended::no;
  if (!disk_) return;
  waiting_.clear();
  waiting_bytes_ = 0;
  begin_ = complete_file(start, pieces);
  if (!writing_) replace();
}

void MapJournal::replace() {
  const store::Bytes bytes = *std::exchange(begin_, std::nullopt);
  bytes_ = bytes.size();
  useless_.clear();
  if (const auto written = disk_->replace(kFile, bytes); written)
    return;
  else
    useless_ = written.error().text;
  schedule(params_.period);  // The old file must go, also if no piece comes.
}

void MapJournal::schedule(Duration delay) {
  timer_ = home_.after(delay, [this] { write(); });
}

void MapJournal::add(JournalPiece piece, std::function<void()> stored) {
  if (!disk_) return stored();
  if (waiting_bytes_ + piece.data.size() > params_.max_waiting) return;
  waiting_bytes_ += piece.data.size();
  waiting_.push_back({std::move(piece), std::move(stored)});
  if (!writing_ && !timer_.active()) schedule(params_.period);
}

void MapJournal::end_start(std::function<void()> stored) {
  if (!disk_ || ended_ == Ended::written) return stored();
  if (ended_ == Ended::waiting) return;
  ended_ = Ended::waiting;
  waiting_.push_back({mark(""), std::move(stored)});
  if (!writing_ && !timer_.active()) schedule(params_.period);
}

void MapJournal::forget(const std::string& robot) {
  if (!disk_) return;
  if (ended_ == Ended::no) ended_ = Ended::waiting;
  waiting_.push_back({mark(robot), [] {}});
  if (!writing_ && !timer_.active()) schedule(params_.period);
}

void MapJournal::write() {
  if (writing_ || !disk_) return;
  auto batch = std::make_shared<Batch>();
  if (useless_.empty()) {
    store::Packer content;
    for (const Waiting& waiting : waiting_) add_piece(content, waiting.piece);
    add_batch(batch->bytes, content.bytes());
    if (bytes_ + batch->bytes.size() > params_.max_bytes) {
      // Of a file that was written again there is nothing to gain.
      if (copy_map_ && bytes_ > params_.max_bytes / 2) return write_again();
      useless_ = "it would take more than " + std::to_string(params_.max_bytes >> 20) + " MiB";
    }
  }
  if (!useless_.empty()) {
    batch->kind = Batch::Kind::remove;
    batch->bytes.clear();
  }
  batch->pieces = std::exchange(waiting_, {});
  waiting_bytes_ = 0;
  start(batch);
}

/// The copy of the map has the pieces that wait, too. Behind it they could not be read, as they may be
/// changes of what was before them.
void MapJournal::write_again() {
  auto batch = std::make_shared<Batch>();
  batch->kind = Batch::Kind::replace;
  batch->max_bytes = params_.max_bytes / 2;
  batch->pack = [start = ended_ != Ended::no ? 0 : start_, pack = copy_map_()] {
    return complete_file(start, pack());
  };
  batch->pieces = std::exchange(waiting_, {});
  waiting_bytes_ = 0;
  start(batch);
}

void MapJournal::start(const std::shared_ptr<Batch>& batch) {
  writing_ = true;
  const auto back = [self = self_, batch] {
    if (*self) (*self)->written(*batch);
  };
  timer_ = store::run_in_background(
      *disk_, home_, nullptr, {.name = "map journal", .modelled = params_.write, .pool = PoolKind::io},
      [disk = disk_, batch] { batch->run(*disk); }, back);
}

void MapJournal::written(const Batch& batch) {
  writing_ = false;
  const bool removal = batch.kind == Batch::Kind::remove, done = batch.ran && batch.result;
  if (begin_) {
    replace();  // Meanwhile all of it was forgotten.
  } else if (done && removal) {
    disk_.reset();
    trouble_("the map is not kept on the disk: " + useless_);
    report_stored(batch.pieces);
    report_stored(std::exchange(waiting_, {}));
    return;
  } else if (done) {
    bytes_ = batch.bytes.size() + (batch.kind == Batch::Kind::append ? bytes_ : 0);
    for (const Waiting& waiting : batch.pieces)
      if (is_mark(waiting.piece)) ended_ = Ended::written;
    report_stored(batch.pieces);
  } else if (!batch.ran) {
    for (const Waiting& waiting : batch.pieces) waiting_bytes_ += waiting.piece.data.size();
    waiting_.insert(waiting_.begin(), batch.pieces.begin(), batch.pieces.end());  // Its turn comes again.
  } else {
    // What was written of it may be anything, and its pieces are not acknowledged: they come again.
    useless_ = batch.result.error().text;
    if (removal && !stuck_)
      trouble_("the map can be neither kept nor removed on the disk, robots send it again: " + useless_);
    stuck_ = stuck_ || removal;
  }
  if (waiting_.empty() && useless_.empty()) return;
  schedule(removal ? params_.retry : params_.period);
}

void MapJournal::report_stored(const std::vector<Waiting>& pieces) {
  for (const Waiting& waiting : pieces) waiting.stored();
}

}  // namespace adit::station
