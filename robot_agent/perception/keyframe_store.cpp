// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/keyframe_store.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include "core/store/preserve.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

constexpr store::StateFormat kFormat{{'K', 'E', 'Y', 'F'}, perception::Keyframe::kVersion, 64 * 1024};

std::string file_of(std::size_t slot) {
  char name[24];
  std::snprintf(name, sizeof name, "keyframe-%02zu", slot);
  return name;
}

}  // namespace

KeyframeStore::KeyframeStore(std::shared_ptr<store::Disk> disk, Executor& home,
                             std::shared_ptr<Executor> writer)
    : disk_(std::move(disk)), home_(home), writer_(std::move(writer)), slots_(kMax) {}

void KeyframeStore::load() {
  if (!disk_) return;
  std::uint64_t newest = 0;
  for (std::size_t slot = 0; slot < kMax; ++slot) {
    const store::State state = store::StateFile(disk_, file_of(slot), kFormat).load();
    auto keyframe = read(slot, state);
    if (!keyframe) continue;
    slots_[slot] = std::move(*keyframe);
    if (state.generation < newest) continue;
    newest = state.generation;
    next_ = (slot + 1) % kMax;
  }
  generation_ = newest;
}

std::optional<perception::Keyframe> KeyframeStore::read(std::size_t slot, const store::State& state) {
  switch (state.found) {
    case store::LoadStatus::nothing:
      return std::nullopt;
    case store::LoadStatus::newer:
      ++newer_;
      left_alone_.insert(slot);
      return std::nullopt;
    case store::LoadStatus::unreadable:
      ++unreadable_;
      left_alone_.insert(slot);
      return std::nullopt;
    case store::LoadStatus::good:
    case store::LoadStatus::older:
      if (auto keyframe = perception::decode_keyframe(state.payload, state.version))
        return std::move(*keyframe);
      [[fallthrough]];
    case store::LoadStatus::torn:
    case store::LoadStatus::corrupt:
    case store::LoadStatus::foreign:
      break;
  }
  ++damaged_;
  const bool intact = state.found == store::LoadStatus::good || state.found == store::LoadStatus::older;
  if (store::set_aside(*disk_, file_of(slot), intact ? "corrupt" : store::name(state.found)).empty())
    left_alone_.insert(slot);
  return std::nullopt;
}

std::string KeyframeStore::text() const {
  std::string out;
  const auto add = [&out](std::size_t count, const char* what) {
    if (count > 0) out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(damaged_, "damaged");
  add(newer_, "of a newer version");
  add(unreadable_, "unreadable");
  return out.empty() ? out : "files of what its lidar saw before the restart: " + out + "; none was deleted";
}

bool KeyframeStore::wants(const Eigen::Vector3d& position, std::uint32_t odom_epoch) const {
  return !last_ || last_epoch_ != odom_epoch || (position - *last_).norm() >= kSpacing;
}

void KeyframeStore::add(perception::Keyframe keyframe) {
  const Eigen::Vector3d here = keyframe.T_odom_base.position;
  const std::uint32_t odom_epoch = keyframe.odom_epoch;
  if (keyframe.points.empty() || !wants(here, odom_epoch)) return;
  last_ = here;
  last_epoch_ = odom_epoch;
  // A robot that comes back replaces what it saw there.
  std::size_t slot = next_;
  for (std::size_t n = 0; n < kMax; ++n)
    if (slots_[n] && slots_[n]->odom_epoch == odom_epoch &&
        (slots_[n]->T_odom_base.position - here).norm() < kSpacing / 2)
      slot = n;
  if (slot == next_) next_ = (next_ + 1) % kMax;
  slots_[slot] = std::move(keyframe);
  write(slot);
}

void KeyframeStore::write(std::size_t slot) {
  if (!disk_ || left_alone_.contains(slot)) return;
  auto save = [file = store::StateFile(disk_, file_of(slot), kFormat), generation = ++generation_,
               bytes = perception::encode(*slots_[slot])] { (void)file.save(generation, bytes); };
  run(std::move(save));
}

void KeyframeStore::run(Task task) {
  if (disk_->instant())
    task();
  else if (writer_)
    writer_->post(std::move(task));
  else
    home_.compute({.name = "keyframe", .modelled = 3ms, .pool = PoolKind::io, .lane = "keyframe"},
                  std::move(task), [](const Result<void>&) {});
}

std::vector<perception::Keyframe> KeyframeStore::of(std::uint32_t odom_epoch) const {
  std::vector<perception::Keyframe> found;
  for (const auto& slot : slots_)
    if (slot && slot->odom_epoch == odom_epoch) found.push_back(*slot);
  return found;
}

}  // namespace adit::agent
