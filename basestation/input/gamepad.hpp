// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "basestation/input/pad_mapping.hpp"

namespace adit::station::input {

/// The first game controller, read with SDL2, which is loaded at run time if it is installed: without SDL2 or
/// a controller, no gamepad is available. A second controller is read only after the first one is gone, and
/// after a read() without one. One thread creates, reads and destroys it.
///
/// The comments name the inputs of the usual layout; a PadMapping changes them.
class Gamepad {
 public:
  struct State {
    bool present{false};
    std::array<double, 3> stick{};  ///< Forward, left, turn left; [-1, 1], shaped().
    bool shoulder{false};           ///< The left shoulder button, the dead man's switch.
    bool fast{false};               ///< The right shoulder button.
    bool precise{false};            ///< The left trigger.
    bool stop{false};               ///< A
    bool quit{false};               ///< B
    bool take{false};               ///< X
    bool stop_all{false};           ///< Back
    bool start{false};
    bool next{false}, previous{false};  ///< The directional pad, right and left.
  };

  explicit Gamepad(const PadMapping& mapping = {});
  ~Gamepad();
  State read();
  /// Vibrates, if the controller can. `strength`: [0, 1].
  void rumble(double strength, std::chrono::milliseconds duration);
  /// The controller's name, or why none is available.
  std::string name() const;

 private:
  struct Sdl;
  PadMapping mapping_;
  std::unique_ptr<Sdl> sdl_;
};

}  // namespace adit::station::input
