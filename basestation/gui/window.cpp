// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/window.hpp"

#include <QtQml/qqmlextensionplugin.h>
#include <QQmlComponent>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/bridge/photo_provider.hpp"

Q_IMPORT_QML_PLUGIN(AditPlugin)

namespace adit::gui {

OperatorWindow::OperatorWindow(Control& control, WindowKind kind) {
  engine_.addImportPath("qrc:/qt/qml");
  engine_.addImageProvider(PhotoProvider::kName, new PhotoProvider(control.tabs()->photos()->loader()));
  QQmlComponent component(&engine_, QUrl(kind == WindowKind::map ? "qrc:/qt/qml/Adit/MapWindow.qml"
                                                                 : "qrc:/qt/qml/Adit/Main.qml"));
  QObject* root = component.createWithInitialProperties({{"control", QVariant::fromValue(&control)}});
  for (const QQmlError& error : component.errors()) qWarning("%s", qPrintable(error.toString()));
  window_.reset(qobject_cast<QQuickWindow*>(root));
  if (!window_) delete root;
}

}  // namespace adit::gui
