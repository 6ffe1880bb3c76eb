// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::gui {

/// The program `adit_gui`; returns its exit status.
int run_program(int argc, char** argv);

}  // namespace adit::gui
