// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/map_keeper.hpp"

#include <algorithm>
#include <cmath>

#include "core/time/random.hpp"

namespace adit::agent {
namespace {

using perception::BlockIndex;

constexpr Duration kMaxInsertion = 3s;
constexpr std::uint64_t kStoredGroup = std::uint64_t{1} << 62;  // Groups of submaps of earlier starts.
constexpr std::uint32_t kRevisionSkip = 1U << 20U;  // More than a robot sends between two writes to the disk.
constexpr int kMaxDropped = 8;                      // Submaps, each time that the map is stored.
constexpr std::size_t kLookedAtOnce = 3;            // Less than 1 ms each.
constexpr std::uint32_t kPrunedAtOnce = 4;
constexpr double kRouteRadius = 3.2;      // m around the route whose map stations get first.
constexpr double kRouteStep = 3.2;        // m between two points of the route.
constexpr std::size_t kRoutePoints = 10;  // So 30 m of it.
constexpr double kRouteHeight = 1.6;      // m above and below.
constexpr double kAnyHeight = 1000.0;     // m
constexpr std::size_t kGroups = 8;        // The newest ones, in which the focus is looked for.

/// The integer next to a coordinate, in blocks.
std::int32_t rounded(double blocks) {
  return static_cast<std::int32_t>(std::clamp(std::round(blocks), -1e9, 1e9));
}

/// Index of the block of the odometry frame's lattice at a submap's origin.
BlockIndex lattice(const Pose3& T_odom_submap) {
  const Eigen::Vector3d at = T_odom_submap.position / BlockIndex::kSize;
  return {rounded(at.x()), rounded(at.y()), rounded(at.z())};
}

/// The block of a lattice that contains a point (lattice frame, m).
BlockIndex block_of(const Eigen::Vector3d& point) {
  const Eigen::Array3d at = (point / BlockIndex::kSize).array().floor();
  return {rounded(at.x()), rounded(at.y()), rounded(at.z())};
}

}  // namespace

MapKeeper::MapKeeper(MapKeeperParams params, std::unique_ptr<MapDisk> disk)
    : params_(std::move(params)),
      disk_(std::move(disk)),
      poses_(params_.robot, Random(params_.seed).fork(1).next()),
      blocks_([this] {
        BlockSourceParams blocks = params_.blocks;
        blocks.robot = params_.robot;
        blocks.start = Random(params_.seed).fork(1).next();
        return blocks;
      }()),
      start_(perception::map_start(1, params_.owner, Random(params_.seed).fork(1).next())) {}

LoadedMap MapKeeper::load() {
  if (!disk_) return {};
  LoadedMap loaded = disk_->load();
  blocks_.tick(Time(Duration::min() / 2));  // What is loaded does not change any more.
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::uint64_t> groups;
  std::uint64_t newest = 0;
  for (perception::StoredSubmap& stored : loaded.submaps) {
    const auto number = static_cast<std::uint32_t>(submaps_.size());
    // Poses of different moments may differ by a correction: then no two submaps share a lattice.
    const std::uint64_t next = kStoredGroup + number;
    const std::uint64_t group =
        loaded.places ? groups.try_emplace({stored.key.start, stored.odom_epoch}, next).first->second : next;
    const SubmapPlace place{stored.key.start, stored.key.index, group, stored.offset};
    submaps_.push_back({{}, stored.odom_epoch, place, true});
    blocks_.open(number, place);
    poses_.open(number, place.start, place.index, stored.pose_revision);
    if (stored.placed) poses_.update(number, stored.T_map_submap);
    std::sort(stored.blocks.begin(), stored.blocks.end(),
              [](const auto& a, const auto& b) { return a.revision < b.revision; });
    for (const perception::BlockUpdate& update : stored.blocks)
      blocks_.update(number, update.block, update.revision);
    newest = std::max(newest, perception::count_of(place.start));
  }
  for (const perception::StoredPlaces::Peer& peer : loaded.peers)
    stored_stations_[peer.id] = {peer.start, {peer.has.begin(), peer.has.end()}, 0};
  if (!submaps_.empty()) blocks_.skip_revisions(kRevisionSkip);
  first_ = static_cast<std::uint32_t>(submaps_.size());
  // Stations merge submaps by key: those of a later start must come later.
  start_ = perception::map_start(newest + 1, params_.owner, start_);
  loaded.submaps.clear();
  return loaded;
}

std::vector<BlockRegion> MapKeeper::regions_around(std::span<const Eigen::Vector3d> points, double radius,
                                                   double height) const {
  std::map<std::uint64_t, Pose3> lattices;  // T_lattice_map by group.
  for (auto submap = submaps_.rbegin(); submap != submaps_.rend() && lattices.size() < kGroups; ++submap) {
    if (lattices.contains(submap->place.group)) continue;
    const auto pose = poses_.pose(static_cast<std::uint32_t>(submaps_.rend() - submap - 1));
    if (!pose) continue;
    const BlockIndex& offset = submap->place.offset;
    const Pose3 T_lattice_submap{Eigen::Vector3d(offset.x, offset.y, offset.z) * BlockIndex::kSize,
                                 Eigen::Quaterniond::Identity()};
    lattices[submap->place.group] = T_lattice_submap * pose->T_map_submap.inverse();
  }
  std::vector<BlockRegion> out;
  for (const Eigen::Vector3d& point : points)
    for (const auto& [group, T_lattice_map] : lattices) {
      const Eigen::Vector3d at = T_lattice_map * point;
      const Eigen::Vector3d reach(radius, radius, height);
      out.push_back({group, block_of(at - reach), block_of(at + reach)});
    }
  return out;
}

std::optional<PlaceInSubmap> MapKeeper::place_in_submap(const Eigen::Vector3d& place) const {
  if (submaps_.empty()) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(submaps_.size() - 1);
  const auto pose = poses_.pose(number);
  if (!pose) return std::nullopt;
  const Submap& submap = submaps_[number];
  return PlaceInSubmap{submap.place.start, submap.place.index, pose->T_map_submap.inverse() * place,
                       pose->T_map_submap.yaw()};
}

std::optional<Pose3> MapKeeper::submap_pose(std::uint64_t start, std::uint32_t index) const {
  const auto found = std::ranges::find_if(submaps_, [&](const Submap& submap) {
    return submap.place.start == start && submap.place.index == index;
  });
  if (found == submaps_.end()) return std::nullopt;
  const auto pose = poses_.pose(static_cast<std::uint32_t>(found - submaps_.begin()));
  return pose ? std::optional(pose->T_map_submap) : std::nullopt;
}

void MapKeeper::look_ahead(std::span<const Eigen::Vector3d> route) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < route.size() && points.size() < kRoutePoints; ++i) {
    points.push_back(route[i]);
    if (i + 1 == route.size()) break;
    const Eigen::Vector3d leg = route[i + 1] - route[i];
    for (double along = kRouteStep; along < leg.norm() && points.size() < kRoutePoints; along += kRouteStep)
      points.emplace_back(route[i] + leg.normalized() * along);
  }
  blocks_.focus(regions_around(points, kRouteRadius, kRouteHeight));
}

void MapKeeper::anchor() {
  for (Submap& submap : submaps_) submap.fixed = true;
}

void MapKeeper::heard(const transfer::Ack& ack) {
  const auto& id = ack.peer;
  const auto& look = ack.look;
  const std::uint32_t start = ack.start;
  if (!blocks_.knows(id)) {
    stations_.erase(id);
    return;
  }
  if (is_behind()) {
    std::vector<BlockRegion> regions;
    if (look)
      regions =
          regions_around(std::vector<Eigen::Vector3d>{{look->x, look->y, 0.0}}, look->radius, kAnyHeight);
    blocks_.focus(id, std::move(regions));
  }
  const auto known = stations_.find(id);
  if (known != stations_.end() && known->second.start == start) return;
  if (stations_.size() >= BlockSource::kMaxPeers)
    std::erase_if(stations_, [this](const auto& station) { return !blocks_.knows(station.first); });
  Station& station = stations_[id] = {start, {}, 0};
  const auto stored = stored_stations_.find(id);
  if (stored == stored_stations_.end()) return;
  // It was not started again since, and still has what it had.
  if (stored->second.start == start) blocks_.has(id, station.has = stored->second.has);
  stored_stations_.erase(stored);
}

void MapKeeper::save_submap(std::uint32_t number) {
  const Submap& submap = submaps_[number];
  perception::StoredSubmap stored{.key = {params_.robot, submap.place.start, submap.place.index},
                                  .odom_epoch = submap.odom_epoch,
                                  .offset = submap.place.offset};
  if (const auto pose = poses_.pose(number)) {
    stored.T_map_submap = pose->T_map_submap;
    stored.placed = true;
    stored.pose_revision = pose->revision;
  }
  blocks_.for_each(number, [&](const perception::CoarseBlock& block, std::uint32_t revision) {
    if (stored.blocks.size() < perception::kMaxStoredBlocks) stored.blocks.push_back({block, revision});
  });
  disk_->save(std::move(stored));
}

void MapKeeper::save_places() {
  perception::StoredPlaces places;
  std::map<std::uint32_t, std::uint32_t> positions;  // By number of the submap.
  for (auto& [submap, pose] : poses_.poses()) {
    positions[submap] = static_cast<std::uint32_t>(places.poses.size());
    places.poses.push_back(std::move(pose));
  }
  const auto add = [&](const transfer::PeerId& id, const Station& station) {
    perception::StoredPlaces::Peer peer{id, station.start, {}};
    for (const std::uint32_t submap : station.has)
      if (const auto at = positions.find(submap); at != positions.end()) peer.has.push_back(at->second);
    if (places.peers.size() < perception::kMaxStoredPeers) places.peers.push_back(std::move(peer));
  };
  for (const auto& [id, station] : stations_) add(id, station);
  for (const auto& [id, station] : stored_stations_) add(id, station);
  disk_->save(std::move(places));
}

void MapKeeper::make_room() {
  for (int dropped = 0; disk_->is_full() && dropped < kMaxDropped; ++dropped) {
    const auto submap = blocks_.oldest_to_drop();
    if (!submap) return;
    const SubmapPlace& place = submaps_[*submap].place;
    disk_->remove({params_.robot, place.start, place.index});
    blocks_.drop(*submap);
    ++dropped_submaps_;
    submaps_[*submap].dropped = true;
    if (!blocks_.is_first(*submap)) poses_.drop(*submap);
    for (auto& [id, station] : stations_) station.has.erase(*submap);
    for (auto& [id, station] : stored_stations_) station.has.erase(*submap);
    places_changed_ = true;
  }
}

void MapKeeper::save_pruned() {
  const auto closed = static_cast<std::uint32_t>(submaps_.empty() ? 0 : submaps_.size() - 1);
  for (std::uint32_t looked = 0; looked < std::min(kPrunedAtOnce, closed); ++looked) {
    next_pruned_ = (next_pruned_ + 1) % closed;
    if (blocks_.take_pruned(next_pruned_) > 0 && poses_.pose(next_pruned_)) save_submap(next_pruned_);
  }
}

void MapKeeper::note_complete() {
  // A closed submap does not change: what a station has of it stays complete. The open one is looked at, too.
  const auto count = static_cast<std::uint32_t>(submaps_.size());
  for (auto& [id, station] : stations_) {
    std::size_t looked = 0;
    for (std::uint32_t i = 0; i < count && looked < kLookedAtOnce; ++i) {
      station.next = station.next > 0 && station.next <= count ? station.next - 1 : count - 1;
      if (station.has.contains(station.next)) continue;
      ++looked;
      if (!blocks_.complete(id, station.next)) continue;
      station.has.insert(station.next);
      places_changed_ = true;
    }
  }
}

void MapKeeper::save_changed() {
  // In this order: a station never counts as having all of a submap whose file has more than it has.
  if (places_changed_) save_places();
  if (open_changed_ && !submaps_.empty()) save_submap(static_cast<std::uint32_t>(submaps_.size() - 1));
  open_changed_ = places_changed_ = false;
}

void MapKeeper::tick(Time now) {
  blocks_.tick(now);
  if (!disk_) return;
  disk_->tick();
  if (saved_ && now - *saved_ < params_.save_period) return;
  const bool first = !saved_;
  saved_ = now;
  if (first) return;
  make_room();
  save_pruned();
  note_complete();
  save_changed();
}

void MapKeeper::flush() {
  if (!disk_) return;
  save_changed();
  disk_->flush();
}

std::shared_ptr<const MapJob> MapKeeper::job(const std::shared_ptr<const Scan>& scan,
                                             std::vector<TeamRobot> team, std::uint32_t odom_epoch,
                                             Time now) {
  // The completion is lost when the command component ends meanwhile.
  if (busy_ && now - *inserted_ < kMaxInsertion) return nullptr;
  const bool moved = (scan->located.position - inserted_at_.position).norm() >= params_.min_move ||
                     scan->located.orientation.angularDistance(inserted_at_.orientation) >= params_.min_turn;
  if (inserted_ && inserted_epoch_ == odom_epoch && !moved && now - *inserted_ < params_.min_period)
    return nullptr;
  auto job = std::make_shared<MapJob>();
  job->scan = scan;
  job->origin = params_.origin;
  job->team = std::move(team);
  job->odom_epoch = odom_epoch;
  job->next_submap = static_cast<std::uint32_t>(submaps_.size());
  if (!submaps_.empty()) job->known_submap = job->next_submap - 1;
  job->known_revision = revision_;
  job->made = now;
  busy_ = true;
  inserted_ = now;
  inserted_at_ = scan->located;
  inserted_epoch_ = odom_epoch;
  return job;
}

void MapKeeper::open_submap(const MapStep& step, const MapFrame& frame) {
  // The one before is closed: it is written a last time.
  if (disk_ && open_changed_ && submaps_.size() > first_) {
    if (places_changed_) save_places();
    save_submap(static_cast<std::uint32_t>(submaps_.size() - 1));
  }
  const SubmapPlace place{start_, step.submap - first_, step.odom_epoch, lattice(step.T_odom_submap)};
  submaps_.push_back({step.T_odom_submap, step.odom_epoch, place, false});
  blocks_.open(step.submap, place);
  poses_.open(step.submap, place.start, place.index, 0);
  if (step.odom_epoch == frame.odom_epoch) poses_.update(step.submap, frame.T_map_odom * step.T_odom_submap);
  places_changed_ = true;
  if (!frame_) frame_ = frame;
}

void MapKeeper::taken(const Result<MapStep>& step, const MapFrame& frame) {
  busy_ = false;
  if (!step || step->submap > submaps_.size() || step->submap < first_) return;
  if (step->submap == submaps_.size()) open_submap(*step, frame);
  for (const perception::CoarseBlock& block : step->blocks) blocks_.update(step->submap, block);
  if (!step->blocks.empty()) {
    open_changed_ = true;
    for (auto& [id, station] : stations_)
      if (station.has.erase(step->submap) != 0) places_changed_ = true;
  }
  if (step->submap + 1 == submaps_.size()) revision_ = step->revision;
}

void MapKeeper::follow(const MapFrame& frame) {
  if (!frame_ || (frame_->map_epoch == frame.map_epoch && frame_->odom_epoch == frame.odom_epoch)) return;
  frame_ = frame;
  // Submaps of an earlier odometry frame stay where they were in the map.
  for (std::size_t i = 0; i < submaps_.size(); ++i) {
    if (submaps_[i].fixed || submaps_[i].odom_epoch != frame.odom_epoch) continue;
    if (submaps_[i].dropped && !blocks_.is_first(static_cast<std::uint32_t>(i))) continue;
    places_changed_ = true;
    poses_.update(static_cast<std::uint32_t>(i), frame.T_map_odom * submaps_[i].T_odom_submap);
  }
}

}  // namespace adit::agent
