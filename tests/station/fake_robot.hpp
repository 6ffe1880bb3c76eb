// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adit/authority.h"
#include "adit/bulk.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/robot.h"
#include "basestation/station/station.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/typed.hpp"

namespace adit::station {

/// A robot by the contract's letter: it publishes the state that a test sets, and answers each command by a
/// function of the test. The default accepts everything and makes the asker the holder at `take`.
class FakeRobot {
 public:
  struct Heard {
    Duration at{};
    radio::Command command{};
  };
  struct HeardStick {
    Duration at{};
    radio::Joystick sample{};
  };
  /// Nullopt: no answer.
  using Answering = std::function<std::optional<Reason>(const radio::Command&)>;

  FakeRobot(VirtualScheduler& scheduler, wire::SimulatedNetwork& network, std::string name);

  /// States go out at 10 Hz while true.
  bool alive{true};
  std::string holder{};
  Id holder_id{};
  std::uint64_t epoch_start{99};
  std::uint32_t epoch{1};
  radio::BehaviourState behaviour{};
  Answering answering{};
  /// Whether its state changes with a command that it accepts; a test sets it where that comes later.
  std::function<bool(const radio::Command&)> acting{};
  std::optional<radio::PlannedRoute> route{};  ///< Its answer to `plan`.

  /// Authority and behaviour as they are now.
  void publish();
  /// Says what it can do: m/s, rad/s. `step`: of the stairs that it climbs, m; 0: it climbs none.
  void describe(float max_speed, float max_turn, bool holonomic, float step = 0.0F);
  /// A refused stream.
  void refuse_stream(const std::string& station, Id kId, Reason reason);
  /// Sends a piece of content as the robot, or as the one named in it.
  void send(const radio::BulkPiece& piece) { (void)bulk_.write(piece); }
  const std::vector<radio::BulkAck>& piece_acks() const { return piece_acks_; }
  const std::vector<Heard>& commands() const { return commands_; }
  /// Distinct sequence numbers heard, in the order first heard.
  std::vector<std::uint64_t> numbers() const;
  const std::vector<HeardStick>& sticks() const { return sticks_; }

 private:
  void answer(const radio::Command& command);
  void act(const radio::Command& command);

  VirtualScheduler& scheduler_;
  std::string name_;
  std::unique_ptr<Runtime> machine_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_;
  wire::Writer<radio::RobotState> state_{};
  wire::Writer<radio::AuthorityStatus> authority_{};
  wire::Writer<radio::BehaviourState> behaviour_{};
  wire::Writer<radio::Acknowledgement> answers_{};
  wire::Writer<radio::Capabilities> capabilities_{};
  std::vector<std::unique_ptr<wire::RawReader>> readers_{};
  std::vector<Timer> timers_{};
  wire::Writer<radio::BulkPiece> bulk_{};
  std::vector<radio::BulkAck> piece_acks_{};
  std::vector<Heard> commands_{};
  std::vector<HeardStick> sticks_{};
  std::map<std::uint64_t, radio::Acknowledgement> answered_{};
};

/// Robots and one station on a virtual radio.
class StationTest : public testing::Test {
 protected:
  explicit StationTest(wire::LinkProfile link = {}, std::uint64_t seed = 1);
  ~StationTest() override;

  FakeRobot& add(const std::string& name);
  /// Starts the station `name`; the first one is `op`.
  Station& start(const std::string& name = "op1");
  void run_for(Duration span) { scheduler_.run_until(scheduler_.elapsed() + span); }
  /// Runs a line and virtual time until it ends, at most `limit`.
  Outcome execute(const std::string& line, Duration limit = std::chrono::seconds(60));
  /// Starts a line; its outcome appears in `late` under the handle.
  std::uint64_t begin(const std::string& line);

  static constexpr Id kId{1, 2, 3};
  VirtualScheduler scheduler_{7};
  wire::SimulatedNetwork network_;
  std::unique_ptr<Runtime> machine_;
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> wire_{};
  std::unique_ptr<Station> op_{};
  std::vector<std::unique_ptr<FakeRobot>> robots_{};
  std::vector<Outcome> late_{};
};

}  // namespace adit::station
