// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/photo_provider.hpp"

#include <QQuickImageResponse>
#include <QQuickTextureFactory>
#include <utility>

#include "basestation/gui/bridge/row_model.hpp"
#include "basestation/model/photo_bytes.hpp"

namespace adit::gui {
namespace {

using findings::PhotoPart;

/// A picture without a pixel that is seen. QML would write a warning for an image that failed.
QImage no_picture() {
  QImage image(1, 1, QImage::Format_ARGB32_Premultiplied);
  image.fill(Qt::transparent);
  return image;
}

/// The answer to one image of QML. It lives on the thread of the engine that asked.
class PhotoResponse : public QQuickImageResponse {
 public:
  PhotoResponse(PhotoLoader& loader, std::shared_ptr<PhotoJob> job) : job_(std::move(job)) {
    // Queued to this thread: the job may outlive the response.
    connect(job_.get(), &PhotoJob::done, this, &PhotoResponse::take, Qt::QueuedConnection);
    loader.fetch(job_);
  }
  QQuickTextureFactory* textureFactory() const override {
    return QQuickTextureFactory::textureFactoryForImage(image_.isNull() ? no_picture() : image_);
  }
  void cancel() override {
    job_->stop.request_stop();
    // The engine deletes a response once it has finished, also a cancelled one.
    QMetaObject::invokeMethod(
        this, [this] { take({}, {}); }, Qt::QueuedConnection);
  }

 private:
  void take(const QImage& image, const QString&) {
    if (std::exchange(finished_, true)) return;
    image_ = image;
    emit finished();
  }

  std::shared_ptr<PhotoJob> job_;
  QImage image_{};
  bool finished_{false};
};

}  // namespace

QString photo_source(const std::string& id, PhotoPart part, int attempt) {
  if (id.empty()) return {};
  const std::string which(station::word_of(part));
  return QString("image://%1/%2/%3/%4").arg(PhotoProvider::kName, text_of(id), text_of(which)).arg(attempt);
}

QQuickImageResponse* PhotoProvider::requestImageResponse(const QString& id, const QSize&) {
  const auto part = station::photo_part_from(id.section('/', 1, 1).toStdString());
  return new PhotoResponse(loader_, std::make_shared<PhotoJob>(id.section('/', 0, 0).toStdString(),
                                                               part.value_or(PhotoPart::thumbnail)));
}

}  // namespace adit::gui
