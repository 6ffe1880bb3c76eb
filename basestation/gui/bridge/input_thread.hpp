// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "basestation/gui/bridge/drive_sink.hpp"
#include "basestation/input/drive_session.hpp"

namespace adit::gui {

/// Reads the game controller and drives, in a thread of its own: a window that hangs lets go of the robot,
/// and the stop buttons of the controller work all the same.
class InputThread {
 public:
  /// Reads the controller; called in the thread.
  using Pad = std::function<station::input::Gamepad::State()>;

  struct Status {
    std::string robot{};  ///< The driven one; empty: none.
    station::StickVelocity asked{};
    std::string why{};      ///< Why the velocity is zero.
    std::string ended{};    ///< Why the last drive ended by itself; until the next one begins.
    bool pad{};             ///< A controller is there.
    bool dead_man{};        ///< Its left shoulder button is held, or a finger or a key is down.
    int starts{}, takes{};  ///< How often Start and X of the controller were pressed.
    bool operator==(const Status&) const = default;
  };

  /// `make_pad`: called in the thread, as the library of the controllers wants.
  InputThread(DriveSink& sink, std::function<Pad()> make_pad);
  ~InputThread();

  /// The window's thread is alive. Call it ten times a second or more often.
  void beat();
  void drive(const std::string& robot);
  /// Zero, and the end of the drive.
  void let_go();
  /// A finger on the stick of the screen; axes as in Hands.
  void touch(bool touching, const std::array<double, 3>& axes);
  void keys(const std::array<double, 3>& axes);
  Status status() const;

 private:
  void run(const std::stop_token& stop);
  void step(const station::input::Gamepad::State& pad, double now);
  void end_drive(const std::string& why);

  DriveSink& sink_;
  std::function<Pad()> make_pad_;
  mutable std::mutex mutex_{};
  std::condition_variable_any wake_{};
  station::input::Hands hands_{};
  station::input::Gamepad::State last_pad_{};
  std::optional<station::input::DriveSession> session_{};
  std::int64_t request_{};
  int drives_{};  ///< Begun so far: an outcome of an earlier one ends nothing.
  double beat_{};
  Status status_{};
  std::jthread thread_{};
};

}  // namespace adit::gui
