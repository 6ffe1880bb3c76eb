// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QElapsedTimer>
#include <QImage>
#include <QObject>
#include <QPoint>
#include <QProcess>
#include <QQuickWindow>
#include <QTimer>
#include <optional>

namespace adit::gui::film {

/// Films a window: its frames, with the finger that touches it and a caption below, go to ffmpeg.
class CameraMan : public QObject {
 public:
  static constexpr int kFramesPerSecond = 10;
  static constexpr int kCaption = 56;  ///< Height of the caption below the window, pixels.

  /// `file`: .mp4.
  CameraMan(QQuickWindow& window, const QString& file);
  /// Why nothing is filmed; empty: it is.
  const QString& failure() const { return failure_; }
  void set_finger(std::optional<QPoint> at) { finger_ = at; }
  void set_caption(const QString& text) { caption_ = text; }
  /// Ends the film; false if it could not be written.
  bool finish();
  int frames() const { return frames_; }

 private:
  void shoot();

  QQuickWindow& window_;
  QProcess ffmpeg_{};
  QTimer timer_{};
  QElapsedTimer since_{};
  std::optional<QPoint> finger_{};
  QString caption_{}, failure_{};
  int frames_{0};
};

}  // namespace adit::gui::film
