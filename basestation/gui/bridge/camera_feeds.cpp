// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/camera_feeds.hpp"

#include <QPointer>
#include <bit>
#include <cstring>
#include <utility>

#include "basestation/gui/bridge/row_model.hpp"
#include "basestation/model/camera_bytes.hpp"
#include "perception/camera/stripe_store.hpp"

namespace adit::gui {
namespace {

constexpr std::uint32_t kMaxShownSide = 1920;

perception::Picture pixels_of(const QImage& image) {
  perception::Picture out;
  if (image.isNull()) return out;
  const QImage rgb = image.convertToFormat(QImage::Format_RGB888);
  out = {.width = static_cast<std::uint32_t>(rgb.width()),
         .height = static_cast<std::uint32_t>(rgb.height()),
         .channels = 3};
  for (int y = 0; y < rgb.height(); ++y)
    out.bytes.insert(out.bytes.end(), rgb.constScanLine(y), rgb.constScanLine(y) + 3 * rgb.width());
  return out;
}

QImage image_of(const perception::Picture& picture) {
  const auto width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
  const auto format = picture.channels == 1 ? QImage::Format_Grayscale8 : QImage::Format_RGB888;
  // The conversion copies the pixels.
  return QImage(picture.bytes.data(), width, height, qsizetype{picture.channels} * width, format)
      .convertToFormat(QImage::Format_RGB32);
}

ShownPicture shown(const station::CommandOutcome& outcome, const QImage& former) {
  const auto received = station::camera_picture_of(outcome);
  if (!received) return {.problem = text_of(received.error().text).trimmed()};
  if (received->number == 0) return {};
  auto pixels = perception::decode_jpeg_tolerant(received->jpeg, kMaxShownSide, kMaxShownSide);
  if (!pixels) return {.number = received->number, .problem = text_of(pixels.error().text)};
  ShownPicture out{.number = received->number, .age = received->age};
  out.unmarked = image_of(*pixels);
  if (!received->missing.empty()) {
    const perception::PictureFormat format{.width = static_cast<std::uint16_t>(received->width),
                                           .height = static_cast<std::uint16_t>(received->height),
                                           .colour = received->colour,
                                           .span = static_cast<std::uint8_t>(received->span)};
    if (format.is_valid())
      perception::mark_missing(*pixels, format, received->missing, received->absent, pixels_of(former));
    for (const std::uint8_t bits : received->missing) out.missing += std::popcount(bits);
  }
  out.image = received->missing.empty() ? out.unmarked : image_of(*pixels);
  return out;
}

}  // namespace

CameraFeeds::CameraFeeds(CommandSink& sink, QObject* parent) : QObject(parent), sink_(sink) {
  pool_.setMaxThreadCount(1);
}

void CameraFeeds::next(const station::CameraRequest& request, const QImage& former, Done done) {
  sink_.camera(request, [self = QPointer(this), former,
                         done = std::move(done)](const station::CommandOutcome& outcome) {
    if (!self) return;
    self->pool_.start([self, former, done, outcome] {
      const ShownPicture picture = shown(outcome, former);
      QMetaObject::invokeMethod(
          self.data(), [done, picture] { done(picture); }, Qt::QueuedConnection);
    });
  });
}

}  // namespace adit::gui
