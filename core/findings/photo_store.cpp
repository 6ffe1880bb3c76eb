// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo_store.hpp"

#include <algorithm>
#include <utility>

#include "core/store/background.hpp"
#include "core/store/preserve.hpp"

namespace adit::findings {
namespace {

constexpr std::size_t kPhotosAtOnce = 8;  // In a batch.

Error refused_photo(const char* what) { return {Reason::malformed, std::string("a photo: ") + what}; }

}  // namespace

/// Writes that run on another strand.
struct PhotoStore::Batch {
  enum class Kind : std::uint8_t { replace, append, remove };
  struct Step {
    std::uint64_t content{};
    std::string file{};
    Kind kind{};
    store::Bytes bytes{};
  };
  std::vector<Step> steps{};
  bool ran{};
  std::set<std::uint64_t> failed{};
  std::string error{};  ///< The first one.

  void run(store::Disk& disk) {
    ran = true;
    for (const Step& step : steps) {
      const auto done = step.kind == Kind::replace  ? disk.replace(step.file, step.bytes)
                        : step.kind == Kind::append ? disk.append(step.file, step.bytes)
                                                    : disk.remove(step.file);
      if (done) continue;
      failed.insert(step.content);
      if (error.empty()) error = done.error().text;
    }
  }
};

PhotoStore::PhotoStore(PhotoStoreParams params, std::shared_ptr<store::Disk> disk, Executor& home,
                       std::shared_ptr<Executor> writer, Outputs outputs)
    : params_(params),
      disk_(std::move(disk)),
      home_(home),
      writer_(std::move(writer)),
      outputs_(std::move(outputs)),
      self_(std::make_shared<PhotoStore*>(this)) {}

PhotoStore::~PhotoStore() { *self_ = nullptr; }

std::string PhotoStore::load() {
  if (!disk_) return {};
  const auto names = disk_->list();
  if (!names) return names.error().text;
  std::map<std::string, std::size_t> bad;
  for (const std::string& name : *names) load_file(name, bad);
  write();
  std::string out;
  for (const auto& [what, count] : bad)
    out += (out.empty() ? "photos on the disk: " : ", ") + std::to_string(count) + " " + what;
  return out.empty() ? out : out + "; no file was deleted";
}

void PhotoStore::load_file(const std::string& name, std::map<std::string, std::size_t>& bad) {
  std::uint64_t content = 0;
  bool complete = false;
  if (!is_photo_file(name, content, complete)) return;
  const auto bytes = disk_->read(name, kMaxPhotoFile);
  if (!bytes || !*bytes) {
    ++bad["unreadable"];
    return;
  }
  Entry entry;
  bool all = true;
  store::LoadStatus found = store::LoadStatus::good;
  if (complete)
    found = read_photo_file(**bytes, entry.photo, entry.order);
  else if (!read_photo_records(**bytes, entry.photo, all) ||
           (entry.photo.picture.complete() && photo_hash(entry.photo.picture.bytes()) != content))
    found = store::LoadStatus::corrupt;
  if (found != store::LoadStatus::good || entry.photo.ref.content != content) {
    const std::string why(found == store::LoadStatus::good ? "corrupt" : store::name(found));
    ++bad[why];
    (void)store::set_aside(*disk_, name, why);
    return;
  }
  order_ = std::max(order_, entry.order + 1);
  if (!insert(std::move(entry))) {
    ++bad["more than there is room for"];
    return;
  }
  // Behind a record that was cut nothing can be appended; a complete photo has a file of another name.
  if (!complete && (!all || all_.at(content).photo.complete())) pending_[content].rewrite = true;
}

bool PhotoStore::insert(Entry entry) {
  const std::uint64_t content = entry.photo.ref.content;
  if (const auto known = all_.find(content); known != all_.end()) {
    // Both files exist after a power cut between two steps.
    if (known->second.photo.complete()) return true;
    used_ -= known->second.photo.cost();
    all_.erase(known);
  }
  if (!make_room(entry.photo.cost(), entry.photo.importance)) return false;
  used_ += entry.photo.cost();
  all_.insert_or_assign(content, std::move(entry));
  return true;
}

bool PhotoStore::make_room(std::size_t bytes, std::uint8_t importance) {
  while (used_ + bytes > params_.max_bytes) {
    auto least = all_.end();
    for (auto at = all_.begin(); at != all_.end(); ++at) {
      const auto rank = [](const Entry& entry) { return std::pair(entry.photo.importance, entry.order); };
      if (at->second.photo.complete() && (least == all_.end() || rank(at->second) < rank(least->second)))
        least = at;
    }
    if (least == all_.end() || least->second.photo.importance > importance) {
      full();
      return false;
    }
    full();
    used_ -= least->second.photo.cost();
    if (disk_) pending_[least->first] = {.rewrite = true};  // It is not in all_: its files are removed.
    all_.erase(least);
  }
  return true;
}

void PhotoStore::full() {
  ++dropped_;
  if (!reported_full_ && outputs_.full)
    outputs_.full("no room for more photos: the least important, then the oldest ones are dropped");
  reported_full_ = true;
}

bool PhotoStore::put(const Photo& photo, std::uint8_t importance) {
  if (const auto known = all_.find(photo.hash); known != all_.end() && known->second.photo.complete())
    return true;
  Entry entry{.order = order_++};
  entry.photo = {ref_of(photo), importance, BlockBuffer(photo.thumbnail), BlockBuffer(photo.picture)};
  if (!insert(std::move(entry))) return false;
  changed(photo.hash, {}, {});
  return true;
}

Result<void> PhotoStore::add(const PhotoPiece& piece, const PhotoRef& ref, std::uint8_t importance,
                             const std::string& sender, std::function<void()> stored) {
  const bool picture = piece.part == PhotoPart::picture;
  if (piece.content != ref.content || ref.thumbnail == 0 ||
      piece.bytes != (picture ? ref.bytes : ref.thumbnail))
    return refused_photo("the sizes of its pieces are not those of its finding");
  auto known = all_.find(ref.content);
  if (known != all_.end() &&
      (known->second.photo.ref.bytes != ref.bytes || known->second.photo.ref.thumbnail != ref.thumbnail))
    return refused_photo("another one with this hash has other sizes");
  if (known == all_.end()) {
    Entry entry{.sender = sender, .order = order_++};
    entry.photo = {ref, importance, BlockBuffer(ref.thumbnail), {}};
    if (!insert(std::move(entry))) return {Reason::queue_full, "no room for more photos"};
    known = all_.find(ref.content);
    changed(ref.content, photo_head_record(known->second.photo), {});
  }
  Entry& entry = known->second;
  if (picture && entry.photo.picture.blocks() == 0) {
    const auto incoming = std::ranges::count_if(all_, [&](const auto& other) {
      return other.second.sender == sender && other.second.photo.picture.blocks() > 0 &&
             !other.second.photo.picture.complete();
    });
    if (static_cast<std::size_t>(incoming) >= params_.max_incoming)
      return {Reason::queue_full, "too many photos of " + sender + " arrive at once"};
    if (!make_room(ref.bytes, importance)) return {Reason::queue_full, "no room for more photos"};
    entry.photo.picture = BlockBuffer(ref.bytes);
    used_ += ref.bytes;
  }
  BlockBuffer& buffer = picture ? entry.photo.picture : entry.photo.thumbnail;
  if (buffer.has(piece.first, piece.data.size())) {
    // While it is being written, its first copy is acknowledged, or the next one that comes.
    if (stored && is_stored(ref.content)) stored();
    return {};
  }
  if (!buffer.add(piece.first, piece.data)) return refused_photo("a block lies outside of it");
  if (auto finished = finish(entry, piece.part); !finished) return finished;
  const bool complete = buffer.complete();
  changed(ref.content, photo_block_record(piece.part, piece.first, piece.data), std::move(stored));
  if (complete && outputs_.completed) outputs_.completed(ref.content, piece.part);
  return {};
}

/// Checks a part that may be complete now; one that is wrong is forgotten.
Result<void> PhotoStore::finish(Entry& entry, PhotoPart part) {
  BlockBuffer& buffer = part == PhotoPart::picture ? entry.photo.picture : entry.photo.thumbnail;
  if (!buffer.complete()) return {};
  Result<void> good = check_photo_header(
      buffer.bytes(), part == PhotoPart::picture ? Photo::kMaxSide : Photo::kThumbnailSide);
  if (good && part == PhotoPart::picture && photo_hash(buffer.bytes()) != entry.photo.ref.content)
    good = refused_photo("its bytes have another hash");
  if (good) return {};
  if (part == PhotoPart::picture) {
    used_ -= buffer.bytes().size();
    buffer = {};
  } else {
    buffer = BlockBuffer(std::size_t{entry.photo.ref.thumbnail});
  }
  if (disk_) pending_[entry.photo.ref.content].rewrite = true;
  write();
  return good;
}

void PhotoStore::changed(std::uint64_t content, store::Bytes append, std::function<void()> stored) {
  if (!disk_) {
    if (stored) stored();
    return;
  }
  Work& work = pending_[content];
  // A whole file is written at once, and of one whose photo has become complete, the records are replaced.
  work.rewrite |= append.empty() || all_.at(content).photo.complete();
  work.append.insert(work.append.end(), append.begin(), append.end());
  if (stored) work.stored.push_back(std::move(stored));
  write();
}

const store::Bytes* PhotoStore::find(std::uint64_t content, PhotoPart part) const {
  const auto found = all_.find(content);
  if (found == all_.end()) return nullptr;
  const BlockBuffer& buffer =
      part == PhotoPart::picture ? found->second.photo.picture : found->second.photo.thumbnail;
  return buffer.complete() ? &buffer.bytes() : nullptr;
}

PhotoState PhotoStore::state(std::uint64_t content) const {
  const auto found = all_.find(content);
  if (found == all_.end()) return {};
  const BlockBuffer& picture = found->second.photo.picture;
  const std::size_t blocks = std::max<std::size_t>(picture.blocks(), 1);
  return {found->second.photo.thumbnail.complete(), picture.complete(),
          static_cast<std::uint8_t>(100 * picture.blocks_here() / blocks)};
}

bool PhotoStore::is_stored(std::uint64_t content) const {
  return all_.contains(content) && !pending_.contains(content) && !running_.contains(content);
}

PhotoStore::Batch PhotoStore::batch_of(const Pending& work) const {
  using Kind = Batch::Kind;
  Batch batch;
  for (const auto& [content, one] : work) {
    const std::string whole = photo_file_name(content, true), part = photo_file_name(content, false);
    const auto found = all_.find(content);
    if (found == all_.end()) {
      batch.steps.push_back({content, whole, Kind::remove, {}});
      batch.steps.push_back({content, part, Kind::remove, {}});
    } else if (found->second.photo.complete()) {
      batch.steps.push_back(
          {content, whole, Kind::replace, to_photo_file(found->second.photo, found->second.order)});
      batch.steps.push_back({content, part, Kind::remove, {}});
    } else if (one.rewrite) {
      batch.steps.push_back({content, part, Kind::replace, photo_records(found->second.photo)});
    } else {
      batch.steps.push_back({content, part, Kind::append, one.append});
    }
  }
  return batch;
}

void PhotoStore::write() {
  if (!disk_ || (pending_.empty() && running_.empty())) return;
  // The timer also covers a batch that is lost, for example because its strand's queue is full.
  if (!retry_.active()) retry_ = home_.after(params_.retry, [this] { write(); });
  if (!writing_.expired()) return;
  restore(nullptr);
  running_.clear();
  // A file that cannot be written delays no other one.
  for (const bool failed : {false, true})
    for (auto at = pending_.begin(); at != pending_.end() && running_.size() < kPhotosAtOnce;) {
      const auto next = std::next(at);
      if (at->second.failed == failed) running_.insert(pending_.extract(at));
      at = next;
    }
  const auto batch = std::make_shared<Batch>(batch_of(running_));
  writing_ = batch;
  start(batch);
}

/// What a batch did not write is to be written as a whole: a record may be cut. Null: the batch was lost.
void PhotoStore::restore(const Batch* batch) {
  for (auto& [content, work] : running_) {
    if (batch != nullptr && !batch->failed.contains(content)) continue;
    Work& next = pending_[content];
    next.rewrite = true;
    next.failed = batch != nullptr;
    next.append.clear();
    next.stored.insert(next.stored.end(), std::move_iterator(work.stored.begin()),
                       std::move_iterator(work.stored.end()));
    work.stored.clear();
  }
}

void PhotoStore::flush() {
  if (!disk_ || disk_->instant() || !writer_) return;
  restore(nullptr);
  running_.clear();
  if (pending_.empty()) return;
  const auto batch = std::make_shared<Batch>(batch_of(pending_));
  writer_->post([disk = disk_, batch] { batch->run(*disk); });
}

void PhotoStore::start(const std::shared_ptr<Batch>& batch) {
  const auto back = [self = self_, batch] {
    if (*self) (*self)->written(*batch);
  };
  modelled_ = store::run_in_background(
      *disk_, home_, writer_,
      {.name = "photos", .modelled = params_.write, .watchdog = 60s, .pool = PoolKind::io},
      [disk = disk_, batch] { batch->run(*disk); }, back);
}

void PhotoStore::written(const Batch& batch) {
  writing_.reset();
  if (!batch.ran) return;  // The retry timer still runs.
  const bool failing = !batch.error.empty();
  if (failing != failing_ && outputs_.failing)
    outputs_.failing(failing, failing ? batch.error : "photos are stored again");
  failing_ = failing;
  restore(&batch);
  const Pending done = std::exchange(running_, {});
  for (const auto& [content, work] : done)
    for (const auto& stored : work.stored) stored();
  if (batch.failed.size() < done.size() || done.empty()) write();  // Else the retry timer decides.
}

}  // namespace adit::findings
