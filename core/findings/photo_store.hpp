// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/findings/photo.hpp"
#include "core/findings/photo_piece.hpp"
#include "core/store/disk.hpp"

namespace adit::findings {

/// Parameters of PhotoStore.
struct PhotoStoreParams {
  std::size_t max_bytes{24 << 20};  ///< Of all photos, in memory and on the disk.
  std::size_t max_incoming{32};     ///< Photos of one sender of which a part of the picture is missing.
  Duration write{3ms};              ///< Duration of a batch in rehearsal.
  Duration retry{1s};               ///< Delay after a batch that failed.
};

/// How much of a photo is stored.
struct PhotoState {
  bool thumbnail{};        ///< It is complete.
  bool whole{};            ///< The picture is complete.
  std::uint8_t percent{};  ///< Of the picture, [0, 100].
};

/// Stores photos of findings in memory and on disk, by the hash of their pictures. A photo is one file; one
/// that arrives in blocks is a file to which blocks are appended, so that it goes on after a restart. When
/// there is no room, the least important complete photo goes, and of equal ones the oldest; one that still
/// arrives never goes, because its sender does not repeat what was acknowledged.
///
/// No file that cannot be read is deleted: it is renamed to NAME.corrupt, NAME.newer and so on (at most eight
/// of a name). Writes run in batches in parallel to the home strand.
class PhotoStore {
 public:
  /// Callbacks of the store, on its strand; each may be empty.
  struct Outputs {
    std::function<void(bool failing, const std::string& text)> failing{};
    /// A photo had no room, or made room for another one: once.
    std::function<void(const std::string& text)> full{};
    /// A part of a photo that came in blocks is complete.
    std::function<void(std::uint64_t content, PhotoPart part)> completed{};
  };

  /// `disk` and `writer`: as of FindingStore.
  PhotoStore(PhotoStoreParams params, std::shared_ptr<store::Disk> disk, Executor& home,
             std::shared_ptr<Executor> writer, Outputs outputs);
  ~PhotoStore();
  PhotoStore(const PhotoStore&) = delete;
  PhotoStore& operator=(const PhotoStore&) = delete;

  /// Loads the photos. Returns a text for operators; empty when all files were good.
  std::string load();
  /// Adds a complete photo; one that is here already stays. Returns false if there is no room.
  bool put(const Photo& photo, std::uint8_t importance);
  /// Adds blocks that came from `sender`, for a finding with that photo. `stored` is called once they are on
  /// the disk. Errors: malformed (other sizes, or what is complete now is no JPEG or has another hash),
  /// queue_full (no room, or too many photos of that sender arrive).
  Result<void> add(const PhotoPiece& piece, const PhotoRef& ref, std::uint8_t importance,
                   const std::string& sender, std::function<void()> stored);
  /// Hands what is not on the disk to the writer's strand, at a clean end; see FindingStore::flush().
  void flush();

  /// A part, if it is complete; null: it is not.
  const store::Bytes* find(std::uint64_t content, PhotoPart part) const;
  PhotoState state(std::uint64_t content) const;
  /// Whether the photo is on the disk as it is in memory.
  bool is_stored(std::uint64_t content) const;
  std::size_t bytes() const { return used_; }
  std::size_t size() const { return all_.size(); }
  /// Photos that were dropped or refused for lack of room, since the start.
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Batch;
  struct Entry {
    StoredPhoto photo{};
    std::string sender{};  ///< Empty: it is from this computer.
    std::uint64_t order{};
  };
  /// Changes of a photo that are not on the disk.
  struct Work {
    bool failed{};          ///< The last attempt.
    bool rewrite{};         ///< The whole file, else `append` behind it.
    store::Bytes append{};  ///< Records.
    std::vector<std::function<void()>> stored{};
  };
  using Pending = std::map<std::uint64_t, Work>;

  void load_file(const std::string& name, std::map<std::string, std::size_t>& bad);
  bool insert(Entry entry);
  bool make_room(std::size_t bytes, std::uint8_t importance);
  void full();
  Result<void> finish(Entry& entry, PhotoPart part);
  void changed(std::uint64_t content, store::Bytes append, std::function<void()> stored);
  void write();
  Batch batch_of(const Pending& work) const;
  void start(const std::shared_ptr<Batch>& batch);
  void written(const Batch& batch);
  void restore(const Batch* batch);

  PhotoStoreParams params_;
  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::shared_ptr<Executor> writer_;
  Outputs outputs_;
  std::map<std::uint64_t, Entry> all_{};
  std::size_t used_{};
  std::uint64_t order_{}, dropped_{};
  bool reported_full_{}, failing_{};
  Pending pending_{}, running_{};  ///< `running_`: in the batch that is being written.
  std::weak_ptr<Batch> writing_{};
  Timer modelled_{}, retry_{};
  std::shared_ptr<PhotoStore*> self_;
};

}  // namespace adit::findings
