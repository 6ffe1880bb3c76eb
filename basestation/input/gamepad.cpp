// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/gamepad.hpp"

#include <SDL2/SDL.h>
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>

#include "basestation/input/shaping.hpp"

namespace adit::station::input {
namespace {

double axis(Sint16 raw) { return shaped(std::clamp(raw / 32767.0, -1.0, 1.0)); }

}  // namespace

/// Loads the library at run time: it brings audio and video libraries, which would delay every other command.
struct Gamepad::Sdl {
  void* library{};
  SDL_GameController* controller{};
  decltype(&SDL_Init) init{};
  decltype(&SDL_Quit) quit{};
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

  template <class F>
  bool load(F& function, const char* symbol) {
    function = reinterpret_cast<F>(::dlsym(library, symbol));
    return function != nullptr;
  }
  bool load_all() {
    return load(init, "SDL_Init") && load(quit, "SDL_Quit") && load(set_hint, "SDL_SetHint") &&
           load(count, "SDL_NumJoysticks") && load(is_controller, "SDL_IsGameController") &&
           load(open, "SDL_GameControllerOpen") && load(close, "SDL_GameControllerClose") &&
           load(update, "SDL_GameControllerUpdate") && load(attached, "SDL_GameControllerGetAttached") &&
           load(get_axis, "SDL_GameControllerGetAxis") && load(get_button, "SDL_GameControllerGetButton") &&
           load(get_name, "SDL_GameControllerName");
  }
  void find() {
    for (int i = 0; i < count() && !controller; ++i)
      if (is_controller(i) == SDL_TRUE) controller = open(i);
  }
};

Gamepad::Gamepad() {
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
  sdl_->quit();
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
  const auto value = [&](SDL_GameControllerAxis which) {
    return axis(sdl_->get_axis(sdl_->controller, which));
  };
  const auto pressed = [&](SDL_GameControllerButton which) {
    return sdl_->get_button(sdl_->controller, which) != 0;
  };
  state.present = true;
  state.stick = {-value(SDL_CONTROLLER_AXIS_LEFTY), -value(SDL_CONTROLLER_AXIS_LEFTX),
                 -value(SDL_CONTROLLER_AXIS_RIGHTX)};
  state.shoulder = pressed(SDL_CONTROLLER_BUTTON_LEFTSHOULDER);
  state.stop = pressed(SDL_CONTROLLER_BUTTON_A);
  state.quit = pressed(SDL_CONTROLLER_BUTTON_B);
  state.take = pressed(SDL_CONTROLLER_BUTTON_X);
  state.stop_all = pressed(SDL_CONTROLLER_BUTTON_BACK);
  state.start = pressed(SDL_CONTROLLER_BUTTON_START);
  state.fast = pressed(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER);
  state.precise = sdl_->get_axis(sdl_->controller, SDL_CONTROLLER_AXIS_TRIGGERLEFT) > 16384;
  return state;
}

std::string Gamepad::name() const {
  if (!sdl_) return "none (SDL2 is not installed)";
  const char* text = sdl_->controller ? sdl_->get_name(sdl_->controller) : nullptr;
  return text ? text : "none";
}

}  // namespace adit::station::input
