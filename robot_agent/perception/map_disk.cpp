// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/map_disk.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "core/store/preserve.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

constexpr store::StateFormat kSubmapFormat{{'S', 'M', 'A', 'P'}, 1, perception::kMaxStoredBytes};
constexpr store::StateFormat kPlacesFormat{{'M', 'P', 'L', 'C'}, 1, perception::kMaxStoredBytes};
constexpr std::size_t kPrefix = 21;        // "map-", sixteen digits, "-"
constexpr std::size_t kMaxAside = 64;      // Files that were renamed; more stay as they are.
constexpr std::uint32_t kPoseSkip = 1024;  // Revisions that stations may have seen after the last write.

/// Whether it is the name of a submap's file, and not of one that was renamed.
bool is_submap_file(const std::string& name) {
  if (name.size() <= kPrefix || !name.starts_with("map-") || name[kPrefix - 1] != '-') return false;
  const auto hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return std::all_of(name.begin() + 4, name.begin() + kPrefix - 1, hex) &&
         std::all_of(name.begin() + kPrefix, name.end(), digit);
}

/// Reads the files of one load().
class MapLoader {
 public:
  MapLoader(store::Disk& disk, const std::string& robot, std::map<std::string, std::size_t>& sizes)
      : disk_(disk), robot_(robot), sizes_(sizes) {}

  LoadedMap read() {
    const auto names = disk_.list();
    if (!names) {
      note(loaded_.unreadable, Reason::cannot_read);
      return std::move(loaded_);
    }
    aside_ = static_cast<std::size_t>(std::count_if(names->begin(), names->end(), [](const std::string& n) {
      return n.starts_with("map-") && n.find('.') != std::string::npos;
    }));
    for (const std::string& name : *names)
      if (is_submap_file(name)) read_submap(name);
    std::sort(loaded_.submaps.begin(), loaded_.submaps.end(),
              [](const auto& a, const auto& b) { return a.key < b.key; });
    if (loaded_.submaps.size() > perception::kMaxStoredSubmaps)
      loaded_.submaps.erase(loaded_.submaps.begin(), loaded_.submaps.end() - perception::kMaxStoredSubmaps);
    for (perception::StoredSubmap& submap : loaded_.submaps) submap.pose_revision += kPoseSkip;
    read_places();
    return std::move(loaded_);
  }

 private:
  void note(std::size_t& counter, Reason reason) {
    ++counter;
    if (loaded_.reason == Reason::none) loaded_.reason = reason;
  }

  void put_aside(const std::string& name, std::string_view why) {
    if (aside_ < kMaxAside && !store::set_aside(disk_, name, why).empty()) ++aside_;
  }

  /// The payload of a file; counts and renames one that cannot be used.
  std::optional<store::Bytes> payload(const std::string& name, const store::StateFormat& format) {
    const auto bytes = disk_.read(name, perception::kMaxStoredBytes + 64);
    if (!bytes) {
      note(loaded_.unreadable, Reason::cannot_read);
      return std::nullopt;
    }
    if (!*bytes) return std::nullopt;
    store::State state = store::decode_envelope(format, **bytes);
    if (state.found == store::LoadStatus::good) {
      sizes_[name] = (*bytes)->size();
      return std::move(state.payload);
    }
    const bool version = state.found == store::LoadStatus::newer || state.found == store::LoadStatus::older;
    note(version ? loaded_.other_version : loaded_.damaged,
         version ? Reason::wrong_protocol : Reason::malformed);
    put_aside(name, store::name(state.found));
    return std::nullopt;
  }

  void read_submap(const std::string& name) {
    const auto bytes = payload(name, kSubmapFormat);
    if (!bytes) return;
    auto submap = perception::decode_stored_submap(*bytes);
    if (submap && submap->key.robot == robot_ && MapDisk::file_name(submap->key) == name) {
      loaded_.submaps.push_back(std::move(*submap));
      return;
    }
    const bool foreign = submap.ok() && submap->key.robot != robot_;
    note(foreign ? loaded_.foreign : loaded_.damaged, foreign ? Reason::wrong_robot : Reason::malformed);
    sizes_.erase(name);
    put_aside(name, foreign ? "foreign" : "corrupt");
  }

  void read_places() {
    const auto bytes = payload(MapDisk::kPlacesFile, kPlacesFormat);
    if (!bytes) return;
    const auto places = perception::decode_stored_places(*bytes);
    if (!places) {
      note(loaded_.damaged, Reason::malformed);
      put_aside(MapDisk::kPlacesFile, "corrupt");
      return;
    }
    constexpr std::uint32_t kGone = UINT32_MAX;
    std::vector<std::uint32_t> positions;
    std::size_t found = 0;
    for (const perception::SubmapPose& pose : places->poses) {
      const auto at = std::lower_bound(loaded_.submaps.begin(), loaded_.submaps.end(), pose.key,
                                       [](const auto& submap, const auto& key) { return submap.key < key; });
      const bool known = at != loaded_.submaps.end() && at->key == pose.key;
      positions.push_back(known ? static_cast<std::uint32_t>(at - loaded_.submaps.begin()) : kGone);
      if (!known) continue;
      ++found;
      at->T_map_submap = pose.T_map_submap;
      at->placed = true;
      at->pose_revision = std::max(at->pose_revision, pose.revision + kPoseSkip);
    }
    loaded_.places = found == loaded_.submaps.size();
    for (const perception::StoredPlaces::Peer& peer : places->peers) {
      perception::StoredPlaces::Peer known{peer.id, peer.start, {}};
      for (const std::uint32_t position : peer.has)
        if (positions[position] != kGone) known.has.push_back(positions[position]);
      loaded_.peers.push_back(std::move(known));
    }
  }

  store::Disk& disk_;
  const std::string& robot_;
  std::map<std::string, std::size_t>& sizes_;
  std::size_t aside_{};
  LoadedMap loaded_{};
};

}  // namespace

std::string LoadedMap::text() const {
  std::string out;
  const auto add = [&out](std::size_t count, const char* what) {
    if (count > 0) out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(damaged, "damaged");
  add(other_version, "of another version");
  add(foreign, "of another robot");
  add(unreadable, "unreadable");
  return out.empty() ? out : "files of the map on the disk: " + out + "; none was deleted";
}

/// Shared with the pending writes, which outlive the object.
struct MapDisk::Writer : std::enable_shared_from_this<MapDisk::Writer> {
  /// What to do with one file: write what `make` gives, or remove it.
  struct Job {
    std::function<store::Bytes()> make{};
  };

  MapDiskParams params;
  std::shared_ptr<store::Disk> disk;
  Executor& command;
  std::shared_ptr<Executor> strand;
  Failing failing;
  std::map<std::string, Job> waiting{};
  std::map<std::string, std::size_t> sizes{};
  bool writing{false}, failed{false};
  std::optional<Time> retry{};
  Timer modelled{};

  Writer(MapDiskParams p, std::shared_ptr<store::Disk> d, Executor& c, std::shared_ptr<Executor> s, Failing f)
      : params(std::move(p)), disk(std::move(d)), command(c), strand(std::move(s)), failing(std::move(f)) {}

  /// Writes one file; returns its size. Runs on the disk's strand.
  static Result<std::size_t> write(store::Disk& disk, const std::string& name, const Job& job,
                                   std::size_t min_free) {
    if (!job.make) {
      const auto removed = disk.remove(name);
      if (!removed) return removed.error();
      return std::size_t{0};
    }
    const store::Bytes bytes = job.make();
    if (disk.free() < min_free + bytes.size())
      return {Reason::cannot_write, disk.where() + " has no room for the map beside the robot's state"};
    const auto written = disk.replace(name, bytes);
    if (!written) return written.error();
    return bytes.size();
  }

  void add(const std::string& name, Job job) {
    waiting[name] = std::move(job);
    if (!retry) start();
  }

  void start() {
    if (writing || waiting.empty()) return;
    writing = true;
    retry.reset();
    const auto first = waiting.begin();
    const std::string name = first->first;
    const auto job = std::make_shared<const Job>(std::move(first->second));
    waiting.erase(first);
    const auto work = [disk = disk, name, job, min_free = params.min_free] {
      return write(*disk, name, *job, min_free);
    };
    const std::weak_ptr<Writer> back = weak_from_this();
    if (disk->instant() || !strand) {
      modelled = command.after(params.write, [back, work, name, job] {
        if (const auto self = back.lock()) self->finished(name, *job, work());
      });
      return;
    }
    const bool taken = strand->post([back, work, name, job, to = command.inbox()] {
      auto result = std::make_shared<Result<std::size_t>>(work());
      if (back.expired()) return;
      to->post_control([back, name, job, result] {
        if (const auto self = back.lock()) self->finished(name, *job, *result);
      });
    });
    if (!taken) finished(name, *job, Error{Reason::queue_full, "the disk's queue is full"});
  }

  void finished(const std::string& name, const Job& job, const Result<std::size_t>& result) {
    writing = false;
    if (result) {
      if (*result > 0)
        sizes[name] = *result;
      else
        sizes.erase(name);
      set_failed(false, "the map is kept again");
      return start();
    }
    waiting.try_emplace(name, job);  // A newer state of the file may wait already.
    retry = command.now() + params.retry;
    set_failed(true, result.error().text);
  }

  void set_failed(bool now_failing, const std::string& text) {
    if (failed == now_failing) return;
    failed = now_failing;
    if (failing) failing(failed, text);
  }
};

MapDisk::MapDisk(MapDiskParams params, std::shared_ptr<store::Disk> disk, Executor& command,
                 std::shared_ptr<Executor> writer, Failing failing)
    : writer_(std::make_shared<Writer>(std::move(params), std::move(disk), command, std::move(writer),
                                       std::move(failing))) {}

MapDisk::~MapDisk() = default;

LoadedMap MapDisk::load() { return MapLoader(*writer_->disk, writer_->params.robot, writer_->sizes).read(); }

void MapDisk::save(perception::StoredSubmap submap) {
  const std::string name = file_name(submap.key);
  auto content = std::make_shared<const perception::StoredSubmap>(std::move(submap));
  writer_->add(name, {[content] {
                 return store::encode_envelope(kSubmapFormat, 1, perception::encode_stored(*content));
               }});
}

void MapDisk::save(perception::StoredPlaces places) {
  auto content = std::make_shared<const perception::StoredPlaces>(std::move(places));
  writer_->add(kPlacesFile, {[content] {
                 return store::encode_envelope(kPlacesFormat, 1, perception::encode_stored(*content));
               }});
}

void MapDisk::remove(const perception::SubmapKey& key) { writer_->add(file_name(key), {}); }

std::size_t MapDisk::bytes() const {
  std::size_t sum = 0;
  for (const auto& [name, size] : writer_->sizes) {
    const auto job = writer_->waiting.find(name);
    if (job == writer_->waiting.end() || job->second.make) sum += size;  // Not to be removed.
  }
  return sum;
}

bool MapDisk::is_full() const { return bytes() > writer_->params.max_bytes; }
bool MapDisk::failing() const { return writer_->failed; }

void MapDisk::flush() {
  Writer& w = *writer_;
  if (w.disk->instant() || !w.strand) return;
  for (auto& [name, job] : w.waiting)
    w.strand->post([disk = w.disk, name = name, job = std::move(job), min_free = w.params.min_free] {
      (void)Writer::write(*disk, name, job, min_free);  // No strand is left to report an error to.
    });
  w.waiting.clear();
}

void MapDisk::tick() {
  if (writer_->retry && writer_->command.now() >= *writer_->retry) writer_->start();
}

std::string MapDisk::file_name(const perception::SubmapKey& key) {
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "map-%016llx-%u", static_cast<unsigned long long>(key.start),
                static_cast<unsigned>(key.index));
  return name.data();
}

}  // namespace adit::agent
