// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "basestation/content/digest_list.hpp"
#include "basestation/content/piece_reader.hpp"
#include "basestation/findings/book.hpp"
#include "basestation/findings/desk.hpp"
#include "basestation/fleet/traffic.hpp"
#include "basestation/flow/arrival.hpp"
#include "basestation/flow/steer.hpp"
#include "basestation/map/map_replica.hpp"
#include "basestation/map/tiles.hpp"
#include "basestation/map/trails.hpp"
#include "basestation/station.hpp"
#include "core/time/random.hpp"

namespace adit::perception {
class VoxelImage;
}

namespace adit::station {

/// Collects the answers of one command line to several robots.
struct Gather {
  command::Request request{};
  std::optional<command::Request> sent{};  ///< What each robot is sent, if not the request itself.
  std::vector<Answer> answers{};           ///< In the order of the robots in the command.
  std::size_t missing{};
  Station::Done done{};
};

class Station::Impl {
 public:
  using MapDone = Station::MapDone;

  Impl(Station& owner, StationParams params, Executor& strand, wire::Participant& radio);
  ~Impl();

  Result<void> start();
  std::uint64_t execute(const command::Request& request, Done done);
  std::uint64_t refuse(const Error& error, const Done& done);
  void cancel(std::uint64_t handle);
  std::uint64_t teleop(const std::string& robot, Done done);
  void stick(std::uint64_t handle, const StickVelocity& velocity);
  Time now() const { return strand_.now(); }
  std::size_t findings() const { return desk_.all().size(); }
  const ChunkStore& chunks() const { return map_.chunks(); }
  void map_since(std::uint64_t revision, std::size_t most, MapDone done);
  void look_at(const LookedAt& place) { look_ = place, looked_ = strand_.now(); }

  Station& owner_;
  StationParams params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet fleet_;
  Sender sender_;
  Stick stick_;
  std::optional<Answer> last_answer_{};
  bool closed_{false};

 private:
  /// A command line that waits for its robots to be discovered.
  struct Waiting {
    std::uint64_t handle{};
    command::Request request{};
    Done done{};
  };
  /// A `stop all` of a station that was just started and has not heard all robots yet.
  struct StopAll {
    std::shared_ptr<Gather> gather{};
    std::set<std::string> asked{};
  };

  // Defined in station.cpp: reception and transmission.
  template <class T>
  Result<void> read(const wire::Topic<T>& topic);
  void changed();
  void announce();
  void announce_often();
  void report_traffic();
  FindingDesk::Outputs desk_outputs();
  std::uint32_t drawn_start();
  void map_trouble(const std::string& code, const std::string& text);
  void tick();
  Result<void> open_content();
  void heard_piece(const radio::BulkPiece& sample, const wire::SampleInfo& info);
  void acknowledge_pieces();
  /// Whether a robot is heard that carries maps.
  bool carrier_heard() const;
  void heard_acknowledgement(const radio::Acknowledgement& sample, const wire::SampleInfo& info);

  // Defined in execute.cpp: command lines.
  bool must_wait(std::uint64_t handle, const command::Request& request) const;
  bool known(const command::Request& request) const;
  /// Whether a peer was heard, and of each peer all messages that `list` shows.
  bool complete() const;
  void run(std::uint64_t handle, const command::Request& request, Done done);
  void answer_query(const command::Request& request, const Done& done);
  // Defined in map_commands.cpp.
  void answer_map(const command::Request& request, const Done& done);
  void save_map(const command::Request& request, const Done& done);
  void load_map(const command::Request& request, const Done& done);
  void draw_map(const command::Request& request, const Done& done);
  void answer_tiles(std::uint64_t revision, std::size_t most, const MapDone& done) const;
  void command_robots(std::uint64_t handle, const command::Request& request, Done done);
  /// Sends the gather's command to every robot of its request.
  void send_to_all(std::uint64_t handle, const std::shared_ptr<Gather>& gather);
  void command_robot(std::uint64_t handle, const std::string& robot, const std::shared_ptr<Gather>& gather,
                     std::size_t index);
  // Defined in convoy.cpp.
  /// Gives each robot its place; if one refuses, the others leave again.
  void start_convoy(std::uint64_t handle, const command::Request& request, Done done);
  void stop_convoy(std::uint64_t handle, const command::Request& request, Done done);
  void stop_all(const command::Request& request, Done done);
  void ask_stop(StopAll& all, const std::string& robot);
  void finish_stop_all();
  void down(Done done);
  // Defined in finding_commands.cpp.
  void judge_finding(const command::Request& request, const Done& done);
  void gathered(const std::shared_ptr<Gather>& gather, std::size_t index, const Answer& answer);
  void finish(Gather& gather);
  void note(const Answer& answer);
  /// Notifies the operator of the end of a stop that was reported as not acknowledged.
  void late_stop(const Answer& answer);
  /// Starts the flow; if too many are running, `ended` gets `queue_full` instead.
  void add_flow(std::uint64_t handle, std::shared_ptr<Flow> flow, const Flow::Done& ended);
  void end_flows(const std::string& robot, Reason reason);
  /// Returns a handler of the robot's answer to a command that requests a mode: if accepted, it ends the
  /// flows that drive the robot now.
  Flow::Done end_drives_when_accepted(const std::string& robot) const;
  FlowDependencies flow_dependencies() { return {strand_, fleet_, sender_, stick_}; }
  bool fresh(Duration span) const { return strand_.now() - started_ < span; }

  Time started_;
  Random random_;
  std::uint64_t starts_{};  ///< How many times a start was drawn.
  TrafficMeter meter_{};
  FindingBook book_;
  PieceReader pieces_;  ///< Of all kinds of content.
  FindingDesk desk_;
  MapReplica map_;
  DigestList digests_{};
  Trails trails_{};
  std::shared_ptr<const perception::VoxelImage> prior_{};  ///< What the crew had; null: nothing.
  /// The map seen from above, for front ends.
  struct View {
    Tiles tiles{};
    std::uint64_t chunks{};                                 ///< Revision of the map that the tiles show.
    std::shared_ptr<const perception::VoxelImage> prior{};  ///< And what the crew had then.
    std::optional<Time> begun{};                            ///< The last time that it was begun.
    bool running{false};
    std::vector<std::function<void()>> waiting{};  ///< Requests that are answered when it is complete.
  };
  View view_{};
  std::optional<LookedAt> look_{};  ///< What an operator looked at last.
  Time looked_{};
  bool change_pending_{false};  ///< on_changed will be called.
  Timer change_timer_{};
  std::uint64_t next_handle_{1};
  std::uint32_t presence_seq_{};
  std::uint64_t report_seq_{};
  std::multimap<std::uint64_t, std::shared_ptr<Flow>> flows_{};
  std::deque<Waiting> waiting_{};
  std::vector<StopAll> stop_alls_{};

  struct Radio;  // The typed writers and readers.
  std::unique_ptr<Radio> topics_;
  std::vector<Timer> timers_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
