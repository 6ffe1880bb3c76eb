// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/photo_loader.hpp"

#include <QPointer>

#include "basestation/gui/bridge/row_model.hpp"
#include "basestation/model/photo_bytes.hpp"
#include "core/findings/photo.hpp"

namespace adit::gui {
namespace {

Result<QImage> decoded_image(const station::CommandOutcome& outcome, findings::PhotoPart part,
                             const std::stop_token& stop) {
  const auto jpeg = station::photo_of(outcome);
  if (!jpeg) return jpeg.error();
  // A thumbnail has no hash: a large one of few bytes would take a second to decode.
  if (part == findings::PhotoPart::thumbnail)
    if (const auto small = findings::check_photo_header(*jpeg, findings::Photo::kThumbnailSide); !small)
      return small.error();
  const auto pixels = findings::decode_photo(*jpeg, stop);
  if (!pixels) return pixels.error();
  const auto width = static_cast<int>(pixels->width), height = static_cast<int>(pixels->height);
  // The conversion copies the pixels.
  return QImage(pixels->rgb.data(), width, height, qsizetype{3} * width, QImage::Format_RGB888)
      .convertToFormat(QImage::Format_RGB32);
}

}  // namespace

PhotoLoader::PhotoLoader(CommandSink& sink, QObject* parent) : QObject(parent), sink_(sink) {
  pool_.setMaxThreadCount(1);
}

void PhotoLoader::fetch(std::shared_ptr<PhotoJob> job) {
  QMetaObject::invokeMethod(
      this, [this, job = std::move(job)] { add(job); }, Qt::QueuedConnection);
}

void PhotoLoader::add(Job job) {
  if (waiting_.size() >= kMaxWaiting) {
    emit waiting_.front()->done({}, "too many photos are to be shown at once");
    waiting_.pop_front();
  }
  waiting_.push_back(std::move(job));
  ask();
}

void PhotoLoader::ask() {
  while (asked_ < kMaxAsked && !waiting_.empty()) {
    const Job job = std::move(waiting_.front());
    waiting_.pop_front();
    if (job->stop.stop_requested()) {
      emit job->done({}, "cancelled");
      continue;
    }
    ++asked_;
    sink_.photo(job->id, job->part, [self = QPointer(this), job](const station::CommandOutcome& outcome) {
      if (self) self->decode(job, outcome);
    });
  }
}

void PhotoLoader::decode(const Job& job, const station::CommandOutcome& outcome) {
  pool_.start([this, job, outcome] {
    const auto image = decoded_image(outcome, job->part, job->stop.get_token());
    const QString why = image ? QString() : text_of(image.error().text).trimmed();
    emit job->done(image ? *image : QImage(), why);
    QMetaObject::invokeMethod(
        this, [this, job, why] { ended(job, why); }, Qt::QueuedConnection);
  });
}

void PhotoLoader::ended(const Job& job, const QString& why) {
  --asked_;
  if (!why.isEmpty() && !job->stop.stop_requested()) emit failed(text_of(job->id), job->part, why);
  ask();
}

}  // namespace adit::gui
