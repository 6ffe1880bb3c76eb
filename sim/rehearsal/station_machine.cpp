// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/station_machine.hpp"

#include "basestation/map/merged_map.hpp"
#include "sim/rehearsal/stick_stream.hpp"

namespace adit::sim {
namespace {

constexpr Duration kRestartAfter{500ms};
constexpr double kHeadroom = 0.3;  // m

}  // namespace

struct StationMachine::Process {
  std::unique_ptr<Runtime> runtime{};
  std::shared_ptr<Executor> strand{};
  std::unique_ptr<wire::Participant> radio{};
  std::unique_ptr<station::Station> station{};
  std::unique_ptr<StickStream> stuck{};
};

StationMachine::StationMachine(Stage& stage, const StationSpec& spec, Random random)
    : stage_(stage),
      spec_(spec),
      random_(random),
      clock_offset_(from_seconds(random_.uniform(10.0, 100000.0))) {
  for (std::uint8_t& byte : id_) byte = static_cast<std::uint8_t>(random_.next());
  Random of_the_disk = random_;
  disk_ = std::make_shared<store::MemoryDisk>(of_the_disk.fork(1).next());
}

StationMachine::~StationMachine() = default;

Result<void> StationMachine::start() {
  const Eigen::Vector2d& at = spec_.position;
  const auto floor = stage_.simulation.world().ground_height(at.x(), at.y(), kHeadroom);
  place_ = {at.x(), at.y(), floor ? *floor : 0.0};  // none: beside the map
  stage_.network.set_position(spec_.id, place_.x(), place_.y(), place_.z());
  return start_process();
}

Result<void> StationMachine::start_process() {
  auto process = std::make_unique<Process>();
  process->runtime = stage_.scheduler.machine(spec_.id, clock_offset_);
  process->strand = process->runtime->strand("station");
  process->radio = stage_.network.join(Witness::kRadioDomain, spec_.id);
  station::StationParams params;
  params.name = spec_.id;
  params.id = id_;
  params.seed = random_.next();
  params.software = "rehearsal";
  params.link = stage_.scenario.link.name;
  params.bandwidth = stage_.scenario.link.bandwidth;
  params.place = {static_cast<float>(place_.x()), static_cast<float>(place_.y()),
                  static_cast<float>(place_.z())};
  params.disk = disk_;
  process->station = std::make_unique<station::Station>(params, *process->strand, *process->radio);
  if (auto started = process->station->start(); !started) return started;
  process_ = std::move(process);
  return {};
}

void StationMachine::type(const std::string& line) {
  if (!process_) return;
  process_->strand->post([this, line, station = process_->station.get()] {
    // The line was typed into a station that has crashed since.
    if (!process_ || process_->station.get() != station) return;
    station->execute(line, [](const station::Outcome&) {});
  });
}

Result<void> StationMachine::stick_hangs(const std::string& robot, Duration duration) {
  if (!process_) return {};
  auto& stuck = process_->stuck;
  stuck = std::make_unique<StickStream>(*process_->radio, process_->strand, robot, id_);
  stage_.scheduler.at(stage_.scheduler.elapsed() + duration, [this] {
    if (process_) process_->stuck.reset();
  });
  return stuck->start();
}

void StationMachine::crash() {
  if (!process_) return;
  answer_before_crash_ = last_answer();
  stage_.network.crash(spec_.id);
  process_->stuck.reset();
  process_->station.reset();
  process_.reset();
  merged_.reset();
  stage_.scheduler.at(stage_.scheduler.elapsed() + kRestartAfter, [this] { health_ = start_process(); });
}

void StationMachine::jump_clock(Duration by) {
  clock_offset_ += by;
  if (process_) stage_.scheduler.jump_clock(*process_->runtime, by);
}

const station::Station* StationMachine::station() const {
  return process_ ? process_->station.get() : nullptr;
}

std::optional<std::size_t> StationMachine::findings() const {
  if (!process_) return std::nullopt;
  return process_->station->findings();
}

const station::ChunkStore* StationMachine::chunks() const {
  return process_ ? &process_->station->map() : nullptr;
}

std::shared_ptr<const MapVoxels> StationMachine::map() const {
  const station::ChunkStore* store = chunks();
  if (!store || store->empty()) return nullptr;
  if (merged_ && merged_revision_ == store->revision()) return merged_;
  const perception::VoxelImage image =
      station::merged(station::parts_of(*store), nullptr, perception::CoarseBlock::kVoxel);
  MapVoxels voxels{.edge = image.resolution(), .occupied = {}, .free = {}};
  image.for_each([&](const perception::VoxelIndex& index, perception::Voxel voxel) {
    (voxel == perception::Voxel::occupied ? voxels.occupied : voxels.free)
        .push_back(image.centre(index).cast<float>());
  });
  merged_ = std::make_shared<const MapVoxels>(std::move(voxels));
  merged_revision_ = store->revision();
  return merged_;
}

std::optional<Reason> StationMachine::last_answer() const {
  if (!process_ || !process_->station->last_answer()) return answer_before_crash_;
  return process_->station->last_answer()->reason;
}

}  // namespace adit::sim
