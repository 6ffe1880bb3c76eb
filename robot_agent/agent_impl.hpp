// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>

#include "robot_agent/camera/camera_part.hpp"
#include "robot_agent/command_component.hpp"
#include "robot_agent/motion/scans.hpp"
#include "robot_agent/objects/objects_part.hpp"

namespace adit::agent {

// Random sequences drawn from the seed beside the epoch's.
inline constexpr std::uint64_t kIdentitySalt = 1;
inline constexpr std::uint64_t kFindingsSalt = 2;
inline constexpr std::uint64_t kMapSalt = 3;
inline constexpr std::uint64_t kContentSalt = 4;
inline constexpr std::uint64_t kCarrySalt = 5;
inline constexpr std::uint64_t kCameraSalt = 6;

/// The implementation of Agent: its units, each on a strand of its own, their shared context, and the
/// supervisor. Private to agent.cpp.
struct Agent::Impl {
  Impl(const AgentParams& agent_params, Runtime& agent_runtime);
  /// Stops all strands before it destroys the parts.
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<void> open(wire::Participant& radio, wire::Participant& robot);
  /// Whether this robot has that component.
  bool has(const Unit& unit) const;
  Unit* find(const std::string& component);
  Executor& command_strand() { return *command.slot()->strand; }
  /// Runs `work` on the command strand; all operators are notified of its error.
  void with_findings(std::function<Result<void>(FindingSource& source, Time now)> work);

  const AgentParams& params;
  Runtime& runtime;
  wire::Participant* robot_wire{};
  std::unique_ptr<Context> context{};
  Unit command, planner, router, sensors, map, stairs, cameras, objects;
  /// The ends of the component `cameras` on both domains, for its present strand.
  std::unique_ptr<CameraEnds> camera_ends{};
  std::unique_ptr<wire::ComponentIo> objects_io{};  ///< The same of the component `objects`, robot domain.
  std::shared_ptr<Strand> watch_strand;
  std::shared_ptr<Strand> disk_strand{};  ///< Null: there is no disk, or its writes take no time.
  std::unique_ptr<AgentSupervisor> watch{};

 private:
  /// Completes queued disk writes, for a bounded time.
  void end_disk();
  /// Makes the robot's map, with what the disk has of it.
  void open_map();
  std::mutex mutex_{};  // Guards library_: a planner that hangs may still be computing it.
  std::shared_ptr<const nav::PlannerLibrary> library_{};

  StateKeeper::Outputs keeper_outputs();
  std::shared_ptr<const nav::PlannerLibrary> library();
  FindingSource::Outputs findings_outputs();
  findings::PhotoStore::Outputs photos_outputs();
  /// Where a place (map frame, m) is in this robot's newest submap.
  std::optional<findings::Anchor> anchor_of(const std::array<double, 3>& place) const;
  std::function<void(const contract::BulkPiece&, const wire::ParticipantId&)> pieces_to_carry();
  std::function<void(const contract::CameraViews&, const wire::ParticipantId&)> views_of_cameras();
  UnitParams command_unit();
  UnitParams planner_unit();
  UnitParams router_unit();
  UnitParams sensors_unit();
  UnitParams map_unit();
  UnitParams stairs_unit();
  UnitParams cameras_unit();
  UnitParams objects_unit();
};

}  // namespace adit::agent
