// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <string>

namespace adit::station::input {

/// The first game controller, read with SDL2, which is loaded at run time if it is installed: without SDL2 or
/// a controller, no gamepad is available. Left stick: forward and sideways; right stick: turn; A: software
/// stop; B: end driving.
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
  };

  Gamepad();
  ~Gamepad();
  State read();
  /// The controller's name, or why none is available.
  std::string name() const;

 private:
  struct Sdl;
  std::unique_ptr<Sdl> sdl_;
};

}  // namespace adit::station::input
