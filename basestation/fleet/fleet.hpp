// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "basestation/fleet/views.hpp"
#include "core/contract/discovery.hpp"
#include "core/exec/executor.hpp"
#include "core/wire/link/peer_meter.hpp"
#include "core/wire/topics.hpp"

namespace adit::station {

/// The fleet model: one station's knowledge of robots and other stations. Plain data without I/O: the caller
/// passes received messages and the time. Invalid names and robots beyond the bound are ignored and counted.
class Fleet {
 public:
  static constexpr std::size_t kMaxRobots = 64;
  static constexpr std::size_t kMaxStations = 64;
  static constexpr std::size_t kMaxNotices = 200;
  static constexpr Duration kLostAfter = std::chrono::milliseconds(2500);  // Detected within 3 s.

  Fleet(std::string own_name, Id own_id) : own_name_(std::move(own_name)), own_id_(own_id) {}

  void hear(const radio::Capabilities& sample, const wire::SampleInfo& info);
  void hear(const radio::Presence& sample, const wire::SampleInfo& info);
  void hear(const radio::RobotState& sample, const wire::SampleInfo& info);
  void hear(const radio::AuthorityStatus& sample, const wire::SampleInfo& info);
  void hear(const radio::BehaviourState& sample, const wire::SampleInfo& info);
  void hear(const radio::Route& sample, const wire::SampleInfo& info);
  void hear(const radio::Notification& sample, const wire::SampleInfo& info);
  void hear(const radio::Health& sample, const wire::SampleInfo& info);
  void hear(const radio::LinkReport& sample, const wire::SampleInfo& info);
  /// Updates holder and epoch from an acknowledgement; an empty holder: none.
  void learn_authority(const std::string& robot, const std::string& holder, const Epoch& epoch);
  /// Sets the position of this station, map frame, m.
  void stand_at(const std::array<float, 3>& place) { own_place_ = place; }
  const std::optional<std::array<float, 3>>& own_place() const { return own_place_; }
  /// Sets this station's own traffic report.
  void own_traffic(TrafficView traffic);
  /// Marks silent robots lost, and forgets stations and reports that were silent for a minute.
  void check(Time now);
  /// Adds a notice of this station itself.
  void say(contract::Notification said, Time at) { notice({{std::move(said)}, at, {}}); }

  /// Whether messages of this participant count as that robot's: false for another robot of the same name.
  bool speaks_for(const std::string& robot, const wire::ParticipantId& participant) const;

  /// The robot of that name; null if it is unknown.
  const RobotView* robot(const std::string& name) const;
  std::vector<std::string> robot_names() const;
  const std::map<std::string, RobotView>& robots() const { return robots_; }
  const std::map<std::string, StationView>& stations() const { return stations_; }
  const std::map<std::string, TrafficView>& traffic() const { return traffic_; }
  /// Quality of the link from each agent, measured with its heartbeats.
  const wire::PeerMeter& links() const { return links_; }
  /// Updates the rates from the counters of this station's participant for each peer.
  void carried(const std::vector<wire::PeerState>& peers, Time now) { peer_rates_.read(peers, now); }
  const PeerRates& peer_rates() const { return peer_rates_; }
  /// Records that this station's own heartbeat with that number was sent.
  void said_present(std::uint32_t number, Time now) { links_.sent(number, now); }
  /// The last 200 notices, oldest first.
  const std::deque<StoredNotice>& notices() const { return notices_; }
  const std::string& own_name() const { return own_name_; }
  std::uint64_t ignored() const { return ignored_; }

  std::function<void(const StoredNotice&)> on_notice{};
  /// Called once per robot, when it is heard for the first time.
  std::function<void(const RobotView&)> on_robot{};

 private:
  /// Another participant that uses a robot's name, and its view.
  struct Namesake {
    RobotView view{};
    std::optional<Time> displaced{};  ///< It was shown until this time.
    bool rival{};                     ///< It was shown until the previous participant was heard again.
  };
  static constexpr std::size_t kMaxNamesakes = 16;

  void hear(const contract::Presence& presence, const wire::SampleInfo& info);
  RobotView* touch(const std::string& name, const wire::SampleInfo& info);
  /// The view that a message is about; null for a malformed message and for a robot that is ignored.
  template <class Message>
  RobotView* touch(const std::optional<Message>& message, const wire::SampleInfo& info);
  /// Returns the view for a sample of a participant that is not the shown one.
  RobotView* touch_namesake(RobotView& shown, const wire::SampleInfo& info);
  static bool replaces(const Namesake& namesake, const RobotView& shown, Time now);
  void notice(StoredNotice notice);
  void date(StoredNotice& notice, const RobotView& robot) const;

  std::string own_name_;
  Id own_id_;
  std::optional<std::array<float, 3>> own_place_{};
  std::map<std::string, RobotView> robots_{};
  std::map<std::pair<std::string, wire::ParticipantId>, Namesake> namesakes_{};
  std::map<std::string, StationView> stations_{};
  std::map<std::string, TrafficView> traffic_{};
  wire::PeerMeter links_{};
  PeerRates peer_rates_{};
  std::deque<StoredNotice> notices_{};
  std::uint64_t last_notice_{};  ///< Id of the last notice.
  Time last_clash_{};
  bool clashed_{false};
  std::uint64_t ignored_{};
};

}  // namespace adit::station
