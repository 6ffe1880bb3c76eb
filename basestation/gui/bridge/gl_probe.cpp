// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/gl_probe.hpp"

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

namespace adit::gui {

bool has_gpu() {
  QOffscreenSurface surface;
  surface.create();
  QOpenGLContext context;
  if (!surface.isValid() || !context.create() || !context.makeCurrent(&surface)) return false;
  const auto* name = reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
  const QString renderer = QString::fromUtf8(name ? name : "unknown");
  const std::pair<int, int> version = context.format().version();
  context.doneCurrent();
  for (const char* processor : {"llvmpipe", "softpipe", "SwiftShader"})
    if (renderer.contains(processor, Qt::CaseInsensitive)) return false;
  constexpr std::pair kOldest{3, 3};
  return version >= kOldest || context.isOpenGLES();
}

}  // namespace adit::gui
