// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "basestation/camera/shot_desk.hpp"
#include "basestation/fleet/presence.hpp"
#include "basestation/model/camera.hpp"
#include "core/exec/executor.hpp"
#include "core/wire/participant.hpp"
#include "perception/camera/stripe_store.hpp"

namespace adit::radio {
class CameraPiece;
class CameraViews;
}  // namespace adit::radio

namespace adit::station {

/// The cameras of all robots, as this station looks at them: what it asks robots for, and the newest live
/// picture of each camera. The ends of the topics exist while something is looked at, so that a station
/// that shows no pictures causes no traffic.
class Cameras {
 public:
  static constexpr std::size_t kMost = 16;      ///< Cameras that are looked at, as many as a message names.
  static constexpr Duration kFrontEnd{3s};      ///< A front end that looks says so at least this often.
  static constexpr Duration kWaits{1s};         ///< The longest wait for a newer picture.
  static constexpr std::uint16_t kWidth = 640;  ///< Of a camera that was switched on and that none shows.
  static constexpr float kRate = 15.0F;

  using Robot = std::string;
  using Taken = std::function<void(const CameraPicture& picture)>;

  Cameras(const StationParams& params, Executor& strand, wire::Participant& radio, Fleet& fleet,
          const Presence& presence);
  ~Cameras();

  /// The cameras of a robot: that of `camera`, or with an empty name its first one. Errors: unknown_robot,
  /// not_supported (it has none, or none of that name).
  Result<std::string> named(const Robot& robot, const std::string& camera) const;
  /// Switches the live pictures of a camera on or off. Errors: as of named(); queue_full, wire_failed.
  Result<void> set_on(const Robot& robot, const std::string& camera, bool on);
  /// A front end shows the camera's pictures, at most so wide and often; holds for kFrontEnd. While any
  /// looks, robots are asked for the largest of these sizes and rates, also of a camera that was switched on.
  /// Errors: as of set_on().
  Result<void> look(const Robot& robot, const std::string& camera, std::uint16_t width, float rate);
  /// Calls `taken` once: with the newest picture that has a higher number than `after`, as soon as there is
  /// one, or after kWaits with an empty one.
  void next(const Robot& robot, const std::string& camera, std::uint64_t after, Taken taken);
  /// Asks for one good picture. `done` is called once. Errors: as of set_on(), and of ShotDesk.
  Result<void> shoot(const Robot& robot, const std::string& camera, ShotDesk::Done done);
  /// Takes a piece of such a picture.
  Result<void> take_shot(const Robot& robot, std::span<const std::uint8_t> bytes);
  /// How the robot's cameras are, in the order in which it names them.
  std::vector<CameraStatus> status(const RobotView& robot) const;
  /// Number of live pictures that arrived since the start, in part or whole.
  std::uint64_t pictures() const { return pictures_; }
  /// Sends robots what is looked at. Every 100 ms.
  void tick();

  std::function<void()> on_change{};  ///< status() changed; may be empty.

 private:
  using Key = std::pair<Robot, std::string>;
  struct Waiting {
    std::uint64_t after{};
    Time until{};
    Taken taken{};
  };
  /// A size and a rate that a front end shows.
  struct Demand {
    std::uint16_t width{};
    float rate{};
    Time until{};
  };
  struct View {
    bool on{};
    std::vector<Demand> demands{};  ///< Of front ends, at most kMaxDemands.
    Time ends{};                    ///< It is sent once more that no one looks.
    perception::StripeStore store{};
    CameraPicture newest{};
    Time exposed{}, arriving{};                         ///< Of `newest`, and of the picture that is arriving.
    std::uint32_t shown{}, shown_run{};                 ///< Frame and run of which `newest` was made.
    std::deque<std::pair<Time, std::size_t>> lately{};  ///< Pieces of the last seconds, with their bytes.
    std::deque<Time> pictures{};                        ///< When the pictures of the last seconds came.
    std::vector<Waiting> waiting{};
  };
  static constexpr std::size_t kMaxDemands = 8;
  /// The largest size and rate that is wanted now; a width of 0: no one looks.
  Demand demand_of(const View& view) const;
  bool is_looked_at(const View& view) const { return demand_of(view).width > 0; }
  Result<View*> view_of(const Robot& robot, const std::string& camera);
  Result<void> open();
  void take(const radio::CameraPiece& sample, const wire::SampleInfo& info);
  /// Makes the newest picture of what has come of it, and gives it to those who wait.
  void show(const Key& key, View& view);
  void send();

  const StationParams& params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet& fleet_;
  const Presence& presence_;
  std::map<Key, View> views_{};
  ShotDesk shots_;
  std::uint64_t pictures_{};
  bool changed_{};
  Time sent_{};
  struct Ends;
  std::unique_ptr<Ends> ends_;
};

}  // namespace adit::station
