// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "basestation/host/server.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "tests/folders/folders.hpp"

namespace adit::station::host {

/// A station of op1 whose robots are silent, and its socket in a folder of its own ($XDG_RUNTIME_DIR).
class ServerBench : public testing::Test {
 protected:
  /// `grace`: how long a command waits for a robot that the station has not heard.
  explicit ServerBench(Duration grace = Duration{});
  ~ServerBench() override;

  std::string path() const { return folder_ + "/adit/op1.sock"; }
  const std::string& folder() const { return folder_; }
  void on_strand(const std::function<void()>& work);
  /// Ends the station; its socket goes.
  void end_station();
  /// Starts it as after a restart of its process.
  void start_station();

 private:
  std::array<int, 2> never_{};
  std::string folder_{scratch_folder()};
  Duration grace_;
  VirtualScheduler scheduler_{1};
  wire::SimulatedNetwork network_{scheduler_, {}};
  std::unique_ptr<wire::Participant> wire_{network_.join(77, "op1")};
  LiveRuntime runtime_{};

 protected:
  std::shared_ptr<Executor> strand_{runtime_.strand("station")};
  std::unique_ptr<Server> server_{};
  std::unique_ptr<Station> station_{};

 private:
  std::thread thread_{};
};

}  // namespace adit::station::host
