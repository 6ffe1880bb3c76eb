// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/film/camera_man.hpp"

#include <QPainter>

namespace adit::gui::film {

CameraMan::CameraMan(QQuickWindow& window, const QString& file) : window_(window) {
  const QString size = QString("%1x%2").arg(window.width()).arg(window.height() + kCaption);
  ffmpeg_.setProcessChannelMode(QProcess::ForwardedErrorChannel);
  ffmpeg_.start("ffmpeg", {"-loglevel",
                           "error",
                           "-y",
                           "-f",
                           "rawvideo",
                           "-pixel_format",
                           "bgra",
                           "-video_size",
                           size,
                           "-framerate",
                           QString::number(kFramesPerSecond),
                           "-i",
                           "-",
                           "-c:v",
                           "libx264",
                           "-preset",
                           "veryfast",
                           "-crf",
                           "24",
                           "-pix_fmt",
                           "yuv420p",
                           file});
  if (!ffmpeg_.waitForStarted(5000)) failure_ = "cannot start ffmpeg: " + ffmpeg_.errorString();
  connect(&timer_, &QTimer::timeout, this, [this] { shoot(); });
  timer_.setTimerType(Qt::PreciseTimer);
  since_.start();
  timer_.start(1000 / kFramesPerSecond);
}

void CameraMan::shoot() {
  QImage frame(window_.width(), window_.height() + kCaption, QImage::Format_RGB32);
  frame.fill(Qt::black);
  QPainter painter(&frame);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.drawImage(0, 0, window_.grabWindow());
  if (finger_) {
    painter.setPen(QPen(Qt::white, 3));
    painter.setBrush(QColor(255, 255, 255, 110));
    painter.drawEllipse(*finger_, 22, 22);
  }
  QFont font = painter.font();
  font.setPixelSize(26);
  painter.setFont(font);
  painter.setPen(Qt::white);
  painter.drawText(QRect(0, window_.height(), window_.width(), kCaption), Qt::AlignCenter, caption_);
  painter.end();
  // A processor that is too slow for the film must not fill the memory with it.
  constexpr qint64 kMost = 100'000'000;  // bytes
  if (ffmpeg_.bytesToWrite() > kMost) return;
  // A frame that comes late stands for those that were missed, so that the film has the time that it took.
  const auto wanted = static_cast<int>(since_.elapsed() * kFramesPerSecond / 1000) + 1;
  for (; frames_ < wanted; ++frames_)
    ffmpeg_.write(reinterpret_cast<const char*>(frame.constBits()), frame.sizeInBytes());
}

bool CameraMan::finish() {
  timer_.stop();
  ffmpeg_.closeWriteChannel();
  constexpr int kPatience = 120'000;  // ms
  return ffmpeg_.waitForFinished(kPatience) && ffmpeg_.exitStatus() == QProcess::NormalExit &&
         ffmpeg_.exitCode() == 0;
}

}  // namespace adit::gui::film
