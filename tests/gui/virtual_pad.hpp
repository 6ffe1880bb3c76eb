// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <SDL2/SDL.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

namespace adit::gui {

/// A function of SDL, which is loaded at run time as the program does it; null if it is not installed.
template <class F>
F* sdl_symbol(const char* name) {
  static void* library = ::dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
  return library ? reinterpret_cast<F*>(::dlsym(library, name)) : nullptr;
}
#define ADIT_SDL(function) adit::gui::sdl_symbol<decltype(function)>(#function)

/// A game controller without hardware. It is plugged in while it exists.
class VirtualPad {
 public:
  static bool available() { return ADIT_SDL(SDL_JoystickAttachVirtualEx) != nullptr; }
  static void start() {
    ::setenv("SDL_VIDEODRIVER", "dummy", 0);
    ADIT_SDL(SDL_SetHint)(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    ADIT_SDL(SDL_SetHint)(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    ASSERT_EQ(ADIT_SDL(SDL_InitSubSystem)(SDL_INIT_GAMECONTROLLER), 0);
  }
  static void end() {
    if (const auto quit = ADIT_SDL(SDL_QuitSubSystem)) quit(SDL_INIT_GAMECONTROLLER);
  }

  VirtualPad() {
    SDL_VirtualJoystickDesc desc{};
    desc.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    desc.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
    desc.naxes = SDL_CONTROLLER_AXIS_MAX;
    desc.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
    desc.axis_mask = (1U << SDL_CONTROLLER_AXIS_MAX) - 1;  // Without masks it may not open.
    desc.button_mask = (1U << SDL_CONTROLLER_BUTTON_MAX) - 1;
    desc.name = "virtual pad";
    desc.userdata = this;
    desc.Rumble = [](void* pad, Uint16 low, Uint16) {
      static_cast<VirtualPad*>(pad)->rumble_ = low;
      return 0;
    };
    const int index = ADIT_SDL(SDL_JoystickAttachVirtualEx)(&desc);
    EXPECT_GE(index, 0);
    joystick_ = ADIT_SDL(SDL_JoystickOpen)(index);
    id_ = ADIT_SDL(SDL_JoystickInstanceID)(joystick_);
    axis(SDL_CONTROLLER_AXIS_TRIGGERLEFT, 0.0);
    axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0.0);
  }
  VirtualPad(const VirtualPad&) = delete;
  VirtualPad& operator=(const VirtualPad&) = delete;
  ~VirtualPad() { unplug(); }

  void unplug() {
    if (!joystick_) return;
    for (int i = 0; i < ADIT_SDL(SDL_NumJoysticks)(); ++i)
      if (ADIT_SDL(SDL_JoystickGetDeviceInstanceID)(i) == id_) ADIT_SDL(SDL_JoystickDetachVirtual)(i);
    ADIT_SDL(SDL_JoystickClose)(joystick_);
    joystick_ = nullptr;
  }
  /// `value`: [-1, 1], to the right and downwards; a trigger: [0, 1].
  void axis(int which, double value) {
    const bool trigger = which >= SDL_CONTROLLER_AXIS_TRIGGERLEFT;
    const double raw = trigger ? 2.0 * value - 1.0 : value;
    ADIT_SDL(SDL_JoystickSetVirtualAxis)(joystick_, which, static_cast<Sint16>(raw * 32767));
  }
  void button(int which, bool down) {
    ADIT_SDL(SDL_JoystickSetVirtualButton)(joystick_, which, static_cast<Uint8>(down));
  }
  void push_forward() { axis(SDL_CONTROLLER_AXIS_LEFTY, -1.0); }
  void hold_dead_man(bool held = true) { button(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, held); }
  /// The last strength of its vibration, [0, 65535].
  int rumble() const { return rumble_; }

 private:
  SDL_Joystick* joystick_{};
  SDL_JoystickID id_{};
  std::atomic<int> rumble_{0};
};

}  // namespace adit::gui
