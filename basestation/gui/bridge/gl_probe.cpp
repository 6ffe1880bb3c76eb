// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/gl_probe.hpp"

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

namespace adit::gui {

bool has_gpu(std::string& why) {
  QOffscreenSurface surface;
  surface.create();
  QOpenGLContext context;
  if (!surface.isValid() || !context.create() || !context.makeCurrent(&surface)) {
    why = "no OpenGL";
    return false;
  }
  const auto* name = reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
  const QString renderer = QString::fromUtf8(name ? name : "unknown");
  const std::pair<int, int> version = context.format().version();
  context.doneCurrent();
  for (const char* processor : {"llvmpipe", "softpipe", "SwiftShader"})
    if (renderer.contains(processor, Qt::CaseInsensitive)) {
      why = renderer.toStdString();
      return false;
    }
  constexpr std::pair kOldest{3, 3};
  if (version < kOldest && !context.isOpenGLES()) {
    why = "OpenGL older than 3.3";
    return false;
  }
  return true;
}

}  // namespace adit::gui
