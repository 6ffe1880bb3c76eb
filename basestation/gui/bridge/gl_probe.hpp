// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::gui {

/// Whether the machine draws by a GPU: false without OpenGL 3.3, or where the processor computes it. For
/// a program with a QGuiApplication, before its first window.
bool has_gpu();

}  // namespace adit::gui
