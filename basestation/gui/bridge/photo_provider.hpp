// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QQuickAsyncImageProvider>

#include "basestation/gui/bridge/photo_loader.hpp"

namespace adit::gui {

/// The source of a part of a photo for an Image of QML; empty without an id. Another `attempt` makes another
/// source, so that it is loaded again.
QString photo_source(const std::string& id, findings::PhotoPart part, int attempt);

/// Gives QML's images the photos of photo_source(). One that cannot be shown is an empty picture: the reason
/// comes by PhotoLoader::failed().
class PhotoProvider : public QQuickAsyncImageProvider {
 public:
  static constexpr const char* kName = "photo";

  /// `loader` must outlive the engine that has the provider.
  explicit PhotoProvider(PhotoLoader& loader) : loader_(loader) {}
  /// Called on a thread of the engine.
  QQuickImageResponse* requestImageResponse(const QString& id, const QSize& size) override;

 private:
  PhotoLoader& loader_;
};

}  // namespace adit::gui
