// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/gamepad.hpp"

namespace adit::station::input {

// Built instead of gamepad.cpp if SDL2's headers are missing: a controller is never available.
struct Gamepad::Sdl {};

Gamepad::Gamepad(const PadMapping& mapping) : mapping_(mapping) {}
Gamepad::~Gamepad() = default;
Gamepad::State Gamepad::read() { return {}; }
void Gamepad::rumble(double, std::chrono::milliseconds) {}
std::string Gamepad::name() const { return "none (built without SDL2)"; }

}  // namespace adit::station::input
