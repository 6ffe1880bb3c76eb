// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/gamepad.hpp"

#include <SDL2/SDL.h>
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>

#include "basestation/input/shaping.hpp"

namespace adit::station::input {
namespace {

double share(Sint16 raw) { return std::clamp(raw / 32767.0, -1.0, 1.0); }

}  // namespace

/// Loads the library at run time: it brings audio and video libraries, which would delay every other command.
struct Gamepad::Sdl {
  void* library{};
  SDL_GameController* controller{};
  decltype(&SDL_InitSubSystem) init{};
  decltype(&SDL_QuitSubSystem) quit{};
  decltype(&SDL_SetHint) set_hint{};
  decltype(&SDL_NumJoysticks) count{};
  decltype(&SDL_IsGameController) is_controller{};
  decltype(&SDL_GameControllerOpen) open{};
  decltype(&SDL_GameControllerClose) close{};
  decltype(&SDL_GameControllerUpdate) update{};
  decltype(&SDL_GameControllerGetAttached) attached{};
  decltype(&SDL_GameControllerGetAxis) get_axis{};
  decltype(&SDL_GameControllerGetButton) get_button{};
  decltype(&SDL_GameControllerName) get_name{};
  decltype(&SDL_GameControllerRumble) rumble{};  ///< Null in versions before 2.0.9.
  decltype(&SDL_TLSCleanup) end_thread{};        ///< Null in versions before 2.0.16.

  template <class F>
  bool load(F& function, const char* symbol) {
    function = reinterpret_cast<F>(::dlsym(library, symbol));
    return function != nullptr;
  }
  bool load_all() {
    load(rumble, "SDL_GameControllerRumble");
    load(end_thread, "SDL_TLSCleanup");
    return load(init, "SDL_InitSubSystem") && load(quit, "SDL_QuitSubSystem") &&
           load(set_hint, "SDL_SetHint") && load(count, "SDL_NumJoysticks") &&
           load(is_controller, "SDL_IsGameController") && load(open, "SDL_GameControllerOpen") &&
           load(close, "SDL_GameControllerClose") && load(update, "SDL_GameControllerUpdate") &&
           load(attached, "SDL_GameControllerGetAttached") && load(get_axis, "SDL_GameControllerGetAxis") &&
           load(get_button, "SDL_GameControllerGetButton") && load(get_name, "SDL_GameControllerName");
  }
  void find() {
    for (int i = 0; i < count() && !controller; ++i)
      if (is_controller(i) == SDL_TRUE) controller = open(i);
  }
};

Gamepad::Gamepad(const PadMapping& mapping) : mapping_(mapping) {
  auto sdl = std::make_unique<Sdl>();
  sdl->library = ::dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
  if (!sdl->library) return;
  ::setenv("SDL_VIDEODRIVER", "dummy", 0);  // No display is needed.
  if (!sdl->load_all()) return;
  sdl->set_hint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  sdl->set_hint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
  if (sdl->init(SDL_INIT_GAMECONTROLLER) != 0) return;
  sdl_ = std::move(sdl);
  sdl_->find();
}

Gamepad::~Gamepad() {
  if (!sdl_) return;
  if (sdl_->controller) sdl_->close(sdl_->controller);
  sdl_->quit(SDL_INIT_GAMECONTROLLER);
  if (sdl_->end_thread)
    sdl_->end_thread();  // SDL frees this memory by itself only for threads that it started.
  // The library stays loaded: its threads may not have ended yet.
}

Gamepad::State Gamepad::read() {
  State state;
  if (!sdl_) return state;
  sdl_->update();
  if (sdl_->controller && sdl_->attached(sdl_->controller) == SDL_FALSE) {
    sdl_->close(sdl_->controller);
    sdl_->controller = nullptr;
    return state;  // That it is gone is seen before another one takes its place.
  }
  if (!sdl_->controller) sdl_->find();
  if (!sdl_->controller) return state;
  const auto raw = [&](const PadInput& input) {
    const double value = share(sdl_->get_axis(sdl_->controller, SDL_GameControllerAxis(input.index)));
    return input.reversed ? -value : value;
  };
  // SDL counts axes to the right and downwards, robots to the left and upwards.
  const auto axis = [&](PadAction action) {
    const PadInput& input = mapping_.of(action);
    return input.kind == PadInput::Kind::axis ? -shaped(raw(input)) : 0.0;
  };
  const auto pressed = [&](PadAction action) {
    const PadInput& input = mapping_.of(action);
    if (input.kind == PadInput::Kind::axis) return raw(input) > 0.5;
    return input.kind == PadInput::Kind::button &&
           sdl_->get_button(sdl_->controller, SDL_GameControllerButton(input.index)) != 0;
  };
  state.present = true;
  state.stick = {axis(PadAction::forward), axis(PadAction::sideways), axis(PadAction::turn)};
  state.shoulder = pressed(PadAction::dead_man);
  state.stop = pressed(PadAction::stop);
  state.quit = pressed(PadAction::let_go);
  state.take = pressed(PadAction::take);
  state.stop_all = pressed(PadAction::stop_all);
  state.start = pressed(PadAction::drive);
  state.fast = pressed(PadAction::fast);
  state.precise = pressed(PadAction::precise);
  state.next = pressed(PadAction::next);
  state.previous = pressed(PadAction::previous);
  return state;
}

void Gamepad::rumble(double strength, std::chrono::milliseconds duration) {
  if (!sdl_ || !sdl_->controller || !sdl_->rumble) return;
  const auto force = static_cast<Uint16>(std::clamp(strength, 0.0, 1.0) * 65535.0);
  sdl_->rumble(sdl_->controller, force, force, static_cast<Uint32>(std::max<long>(0, duration.count())));
}

std::string Gamepad::name() const {
  if (!sdl_) return "none (SDL2 is not installed)";
  const char* text = sdl_->controller ? sdl_->get_name(sdl_->controller) : nullptr;
  return text ? text : "none";
}

}  // namespace adit::station::input
