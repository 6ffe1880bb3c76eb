// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/findings/photo_store.hpp"
#include "core/wire/component_io.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "robot_agent/findings/object_placer.hpp"
#include "robot_agent/findings/report_messages.hpp"
#include "robot_agent/findings/report_rate.hpp"
#include "robot_agent/findings/topic_refusals.hpp"

namespace adit::agent {

/// Reads what programs on the robot report, from the robot domain. Each report waits until the odometry is as
/// new as its stamp, is placed in the map, and becomes a finding, or changes the finding of its namespace and
/// number. Its photo is checked, shrunk and stored first; one that cannot be used costs only the photo. What
/// cannot be used is refused with its reason and counted by topic. Outlives the command component and runs on
/// its strand; photos are decoded as compute work, one at a time.
class ReportInput {
 public:
  static constexpr std::size_t kWaiting = 256;  ///< Reports that wait for odometry.
  static constexpr std::size_t kPhotos = 4;     ///< Photos that wait for their decoding.
  static constexpr Duration kFramesCome = 3s;   ///< After the first message, /tf_static may still come.
  static constexpr double kMoved = 0.3;         ///< Smallest motion that changes a finding, m.

  /// All must outlive it.
  ReportInput(ReportParams params, const Platform& platform, std::shared_ptr<StaticFrames> frames,
              FindingSource& findings, findings::PhotoStore& photos, Executor& home,
              TopicRefusals::Fault fault);

  /// Opens the readers. Errors: those of the participant.
  Result<void> open(const wire::ComponentIo& io);
  void close() { readers_.clear(); }

  /// Takes a message. `topic`: without rt/.
  void take(const visualization_msgs::msg::Marker& message, const std::string& topic, Time received);
  /// Places what need not wait any longer, and reports it. At 10 Hz or more.
  void tick(const RobotPlace& place, Time now);
  /// Reports messages that the wire could not decode. About once a second.
  void look(const wire::Participant& wire);

  /// Messages and photos that were refused, over all topics.
  std::uint64_t refused() const { return refusals_.count(); }

 private:
  struct Waiting {
    Report report{};
    std::string topic{};
    Time received{};
  };
  /// A photo as make_photo() made it.
  struct Made {
    std::optional<findings::Photo> photo{};  ///< Nothing: the same JPEG as before.
    std::uint64_t input{};                   ///< Hash of the JPEG that came.
  };
  void place_and_report(Waiting next, const RobotPlace& place, Time now);
  void withdraw(const Waiting& waiting);
  findings::Finding finding_of(const Report& report, const Eigen::Vector3d& place, Time now) const;
  /// Decodes the report's photo; the finding is reported when that is done.
  void decode(const Waiting& waiting, findings::Finding finding);
  void decoded(std::uint64_t id, const std::string& topic, const Result<Made>& made);
  /// Reports the finding, or changes it if it differs.
  void put(const std::string& topic, findings::Finding finding);

  ReportParams params_;
  ObjectPlacer placer_;
  FindingSource& findings_;
  findings::PhotoStore& photos_;
  Executor& home_;
  TopicRefusals refusals_;
  std::vector<std::string> names_{};  ///< DDS names of the topics.
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::deque<Waiting> waiting_{};
  std::map<std::uint64_t, findings::Finding>
      decoding_{};                                   ///< Findings whose photo is decoded, newest content.
  std::map<std::uint64_t, std::uint64_t> inputs_{};  ///< Hash of the last JPEG of each finding; bounded.
  std::optional<Time> first_{};                      ///< When the first message came.
  ReportRate new_findings_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::agent
