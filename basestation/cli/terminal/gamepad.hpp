#pragma once
#include <array>
#include <memory>
#include <string>

namespace adit::station::cli {

/// The first game controller, by SDL2, which is loaded when it is there: without it, or without a controller,
/// there is just none. Left stick: forward and sideways; right stick: turn; A: software stop; B: let go.
class Gamepad {
 public:
  struct State {
    bool present{false};
    std::array<double, 3> stick{};  ///< forward, left, turn left; -1..1, dead zone taken out
    bool shoulder{false};           ///< the left one: the dead man's switch
    bool stop{false};
    bool quit{false};
  };

  Gamepad();
  ~Gamepad();
  State read();
  /// The controller's name, or why there is none.
  std::string name() const;

 private:
  struct Sdl;
  std::unique_ptr<Sdl> sdl_;
};

}  // namespace adit::station::cli
