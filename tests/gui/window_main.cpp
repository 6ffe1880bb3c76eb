// SPDX-License-Identifier: Apache-2.0
// Qt's program around the tests of the window: no screen, no GPU.
#include "tests/gui/fingers.hpp"

int main(int argc, char** argv) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  qputenv("QT_QUICK_BACKEND", "software");
  testing::InitGoogleTest(&argc, argv);
  qInstallMessageHandler(adit::gui::collect);
  const QGuiApplication app(argc, argv);
  return RUN_ALL_TESTS();
}
