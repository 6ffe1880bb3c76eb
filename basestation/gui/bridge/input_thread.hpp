// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <concepts>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "basestation/gui/bridge/drive_sink.hpp"
#include "basestation/input/drive_session.hpp"

namespace adit::gui {

/// Reads the game controller and drives, in a thread of its own: a window that hangs lets go of the robot,
/// and the stop buttons of the controller work all the same.
class InputThread {
 public:
  /// The game controller; everything of it is called in the thread.
  struct Pad {
    Pad() = default;
    template <std::invocable Read>
    Pad(Read read_state) : read(std::move(read_state)) {}  // NOLINT: a function alone is a controller.
    std::function<station::input::Gamepad::State()> read{};
    /// Vibrates; strength: [0, 1]. May be null.
    std::function<void(double strength, std::chrono::milliseconds duration)> rumble{};
  };

  static constexpr double kStartHeld = 0.5;  ///< How long Start must be held to drive the selection, s.
  static constexpr double kTakeHeld = 0.8;   ///< How long X must be held to take a robot from its holder, s.

  struct Status {
    std::string robot{};  ///< The driven one; empty: none.
    station::StickVelocity asked{};
    std::string why{};    ///< Why the velocity is zero.
    std::string ended{};  ///< Why the last drive ended by itself; until the next one begins.
    bool pad{};           ///< A controller is there.
    bool dead_man{};      ///< Its left shoulder button is held, or a finger or a key is down.
    int starts{};         ///< How often Start of the controller was held for long enough.
    int takes{};          ///< How often X was pressed.
    int takes_held{};     ///< How often X was held for long enough to take a robot from its holder.
    int steps{};  ///< Presses of the directional pad to the right less those to the left, while none drives.
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
  /// Whether the window has the keyboard. Without it no hand drives.
  void focus(bool focused);
  /// Vibrates the controller for a while; strength: [0, 1].
  void rumble(double strength, std::chrono::milliseconds duration);
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
  bool focused_{true};
  double start_since_{}, take_since_{};  ///< When the button went down, s; 0: it is up, or was counted.
  std::optional<std::pair<double, std::chrono::milliseconds>> rumble_{};
  Status status_{};
  std::jthread thread_{};
};

}  // namespace adit::gui
