#pragma once
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "basestation/fleet/views.hpp"
#include "core/exec/executor.hpp"
#include "core/wire/link/peer_meter.hpp"
#include "core/wire/topics.hpp"

namespace adit::station {

/// What one station knows of robots and other stations. Plain data: it is told what was heard and what time
/// it is. Names that are none and robots beyond the bound are ignored and counted.
class Fleet {
 public:
  static constexpr std::size_t kMaxRobots = 64;
  static constexpr std::size_t kMaxStations = 64;
  static constexpr std::size_t kMaxNotices = 200;
  static constexpr Duration kLostAfter = std::chrono::milliseconds(2500);  // it shows within 3 s

  Fleet(std::string own_name, Id own_id) : own_name_(std::move(own_name)), own_id_(own_id) {}

  void hear(const radio::Capabilities& sample, const wire::SampleInfo& info);
  void hear(const radio::Presence& sample, const wire::SampleInfo& info);
  void hear(const radio::RobotState& sample, const wire::SampleInfo& info);
  void hear(const radio::AuthorityStatus& sample, const wire::SampleInfo& info);
  void hear(const radio::BehaviourState& sample, const wire::SampleInfo& info);
  void hear(const radio::Notification& sample, const wire::SampleInfo& info);
  void hear(const radio::Health& sample, const wire::SampleInfo& info);
  void hear(const radio::LinkReport& sample, const wire::SampleInfo& info);
  /// What an acknowledgement says of the holder and the epoch in force.
  void learn_authority(const std::string& robot, const std::string& holder, const Epoch& epoch);
  /// Where this station stands, map frame, m.
  void stand_at(const std::array<float, 3>& place) { own_place_ = place; }
  const std::optional<std::array<float, 3>>& own_place() const { return own_place_; }
  /// This station's own report.
  void own_traffic(TrafficView traffic);
  /// Marks silent robots lost, and forgets stations and reports that were silent for a minute.
  void check(Time now);
  /// Something that this station itself has to say.
  void say(Notice said) { notice(std::move(said)); }

  /// Whether what this participant says as that robot counts: false for another robot of the same name.
  bool speaks_for(const std::string& robot, const wire::ParticipantId& participant) const;

  /// Null when the robot is not known.
  const RobotView* robot(const std::string& name) const;
  std::vector<std::string> robot_names() const;
  const std::map<std::string, RobotView>& robots() const { return robots_; }
  const std::map<std::string, StationView>& stations() const { return stations_; }
  const std::map<std::string, TrafficView>& traffic() const { return traffic_; }
  /// What the link from each agent gives, by its signs of life.
  const wire::PeerMeter& links() const { return links_; }
  /// What this station's wire counted for each peer, by participant.
  void carried(const std::vector<wire::PeerState>& peers, Time now) { peer_rates_.read(peers, now); }
  const PeerRates& peer_rates() const { return peer_rates_; }
  /// This station's own sign of life went out under that number.
  void said_present(std::uint32_t number, Time now) { links_.sent(number, now); }
  /// Oldest first, the last 200.
  const std::deque<Notice>& notices() const { return notices_; }
  /// True when this very station (name and id) holds the robot.
  bool held_by_me(const RobotView& robot) const {
    return robot.holder == own_name_ && robot.holder_id == own_id_;
  }
  const std::string& own_name() const { return own_name_; }
  std::uint64_t ignored() const { return ignored_; }

  std::function<void(const Notice&)> on_notice{};
  /// Called once per robot, when it is first heard of.
  std::function<void(const RobotView&)> on_robot{};

 private:
  /// Another participant that speaks as a robot, and what it says.
  struct Namesake {
    RobotView view{};
    std::optional<Time> displaced{};  ///< It was shown until then.
    bool rival{};                     ///< It was shown, and then the one before it spoke again.
  };
  static constexpr std::size_t kMaxNamesakes = 16;

  RobotView* touch(const std::string& name, const wire::SampleInfo& info);
  /// The view that a sample of another participant than the one that is shown goes into.
  RobotView* touch_namesake(RobotView& shown, const wire::SampleInfo& info);
  static bool replaces(const Namesake& namesake, const RobotView& shown, Time now);
  void notice(Notice notice);
  void date(Notice& notice, const RobotView& robot) const;

  std::string own_name_;
  Id own_id_;
  std::optional<std::array<float, 3>> own_place_{};
  std::map<std::string, RobotView> robots_{};
  std::map<std::pair<std::string, wire::ParticipantId>, Namesake> namesakes_{};
  std::map<std::string, StationView> stations_{};
  std::map<std::string, TrafficView> traffic_{};
  wire::PeerMeter links_{};
  PeerRates peer_rates_{};
  std::deque<Notice> notices_{};
  std::uint64_t last_notice_{};  ///< its id
  Time last_clash_{};
  bool clashed_{false};
  std::uint64_t ignored_{};
};

}  // namespace adit::station
