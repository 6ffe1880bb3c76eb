// SPDX-License-Identifier: Apache-2.0
// Rules of the window that a build can break on purpose (-DADIT_GUI_BREAK=RULE), to see that a test notices
// it: tools/gui_breaks.sh. In every other build all of these are false, and no code of them is in the
// program.
#pragma once

namespace adit::gui {

/// A stop of all waits for a confirmation.
#ifdef ADIT_GUI_BREAK_stop_confirm
inline constexpr bool kBreakStopConfirm = true;
#else
inline constexpr bool kBreakStopConfirm = false;
#endif

/// The stick follows the selection from the driven robot to another one.
#ifdef ADIT_GUI_BREAK_bound_stick
inline constexpr bool kBreakBoundStick = true;
#else
inline constexpr bool kBreakBoundStick = false;
#endif

/// Old values look like new ones.
#ifdef ADIT_GUI_BREAK_stale_fade
inline constexpr bool kBreakStaleFade = true;
#else
inline constexpr bool kBreakStaleFade = false;
#endif

/// Commands to the selected robots say "all" instead of their names.
#ifdef ADIT_GUI_BREAK_all_implied
inline constexpr bool kBreakAllImplied = true;
#else
inline constexpr bool kBreakAllImplied = false;
#endif

}  // namespace adit::gui
