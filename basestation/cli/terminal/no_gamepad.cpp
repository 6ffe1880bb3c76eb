#include "basestation/cli/terminal/gamepad.hpp"

namespace adit::station::cli {

// What is built instead of gamepad.cpp where SDL2's headers are missing: there is never a controller.
struct Gamepad::Sdl {};

Gamepad::Gamepad() = default;
Gamepad::~Gamepad() = default;
Gamepad::State Gamepad::read() { return {}; }
std::string Gamepad::name() const { return "none (built without SDL2)"; }

}  // namespace adit::station::cli
