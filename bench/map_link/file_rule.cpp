// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>
#include <set>

#include "bench/map_link/rule.hpp"
#include "core/wire/cost.hpp"

namespace adit::bench {
namespace {

using perception::CoarseBlock;

constexpr Duration kFilePeriod = 10s;
constexpr Duration kFileHeartbeat = 1s;  ///< While the station lacks frames of the file.
constexpr std::size_t kAhead = 2;        ///< Frames in the radio's queue.

/// A file on its way.
struct File {
  std::uint32_t number{};
  std::vector<CoarseBlock> map{};
  std::size_t bytes{}, frames{};
  std::deque<std::size_t> queue{};  ///< Frames to send.
};

struct FileRobot {
  LatticeMap merged{};
  bool changed{false};  ///< Since the file on its way, or the last one.
  std::optional<File> file{};
  std::uint32_t files{};
  Time due{}, heartbeat{}, answered{};
  std::uint64_t content{};
  // At the station.
  std::uint32_t receives{};
  std::set<std::size_t> received{};
};

class FileRule final : public Rule {
 public:
  explicit FileRule(const Mission& mission) : mission_(mission), robots_(mission.robots.size()) {
    for (FileRobot& r : robots_) r.due = mission.air.now() + kFilePeriod;
  }

  void update(std::size_t robot, const MapUpdate& update) override {
    FileRobot& r = robots_[robot];
    const perception::BlockIndex offset = lattice_offset(update.step.T_odom_submap);
    for (const CoarseBlock& block : update.step.blocks)
      mission_.watch.robot_has(robot, r.merged.set(update.step.submap, block, offset), mission_.air.now());
    r.changed = r.changed || !update.step.blocks.empty();
  }

  void tick() override {
    for (std::size_t i = 0; i < robots_.size(); ++i) tick(i);
  }

  bool settled() const override {
    return std::all_of(robots_.begin(), robots_.end(),
                       [](const FileRobot& r) { return !r.file && !r.changed; });
  }

  Account account() const override {
    Account out;
    for (const FileRobot& r : robots_) out.content += r.content;
    return out;
  }

 private:
  void tick(std::size_t robot) {
    FileRobot& r = robots_[robot];
    const Time now = mission_.air.now();
    if (now >= r.due) {
      r.due += kFilePeriod;
      // Finished first; but one that reaches no station is replaced by the newest.
      if (r.changed && (!r.file || now - r.answered > kFilePeriod)) begin(r);
    }
    if (!r.file) return;
    while (!r.file->queue.empty() && mission_.air.backlog(Air::robot(robot)) < kAhead) {
      const std::size_t frame = r.file->queue.front();
      r.file->queue.pop_front();
      const std::size_t room = mission_.air.room();
      mission_.air.send(Air::robot(robot), Air::kStation, std::min(room, r.file->bytes - frame * room),
                        [this, robot, number = r.file->number, frame, frames = r.file->frames] {
                          arrived(robot, number, frame, frames);
                        });
      r.heartbeat = now + kFileHeartbeat;
    }
    if (!r.file->queue.empty() || now < r.heartbeat) return;
    r.heartbeat = now + kFileHeartbeat;
    mission_.air.control(
        Air::robot(robot), Air::kStation, wire::WireCost::kHeartbeat,
        [this, robot, number = r.file->number, frames = r.file->frames] { answer(robot, number, frames); });
  }

  void begin(FileRobot& r) {
    File& file = r.file.emplace();
    file.number = ++r.files;
    for (const auto& [at, block] : r.merged.shown()) file.map.push_back(block);
    file.bytes = octree_file_bytes(file.map);
    file.frames = (file.bytes + mission_.air.room() - 1) / mission_.air.room();
    for (std::size_t i = 0; i < file.frames; ++i) file.queue.push_back(i);
    r.changed = false;
    r.content += file.bytes;
    r.answered = mission_.air.now();
  }

  void arrived(std::size_t robot, std::uint32_t number, std::size_t frame, std::size_t frames) {
    FileRobot& r = robots_[robot];
    if (number < r.receives) return;
    if (number > r.receives) r.received.clear();
    r.receives = number;
    r.received.insert(frame);
    if (r.received.size() < frames) return;
    if (r.file && r.file->number == number)
      for (const CoarseBlock& block : r.file->map)
        mission_.watch.station_shows(robot, block, mission_.air.now());
    answer(robot, number, frames);
  }

  /// The station says what it lacks.
  void answer(std::size_t robot, std::uint32_t number, std::size_t frames) {
    FileRobot& r = robots_[robot];
    std::vector<std::size_t> lacks;
    for (std::size_t i = 0; i < frames; ++i)
      if (number > r.receives || (number == r.receives && !r.received.contains(i))) lacks.push_back(i);
    const auto bitmap = static_cast<std::uint32_t>(4 * ((frames + 31) / 32));
    mission_.air.control(Air::kStation, Air::robot(robot), wire::WireCost::kAcknack + bitmap,
                         [this, robot, number, lacks] { answered(robot, number, lacks); });
  }

  void answered(std::size_t robot, std::uint32_t number, const std::vector<std::size_t>& lacks) {
    FileRobot& r = robots_[robot];
    if (!r.file || r.file->number != number) return;
    r.answered = mission_.air.now();
    if (lacks.empty())
      r.file.reset();
    else if (r.file->queue.empty())
      r.file->queue.assign(lacks.begin(), lacks.end());
  }

  Mission mission_;
  std::vector<FileRobot> robots_;
};

}  // namespace

std::unique_ptr<Rule> make_file_rule(const Mission& mission) { return std::make_unique<FileRule>(mission); }

}  // namespace adit::bench
