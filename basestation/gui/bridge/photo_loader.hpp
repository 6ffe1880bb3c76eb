// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QImage>
#include <QObject>
#include <QThreadPool>
#include <deque>
#include <memory>
#include <stop_token>
#include <string>

#include "basestation/gui/bridge/command_sink.hpp"
#include "core/findings/photo_file.hpp"

namespace adit::gui {

/// A part of a photo that is to be shown.
class PhotoJob : public QObject {
  Q_OBJECT

 public:
  PhotoJob(std::string id_, findings::PhotoPart part_) : id(std::move(id_)), part(part_) {}

  const std::string id;  ///< FoundPhoto::id.
  const findings::PhotoPart part;
  std::stop_source stop{};  ///< Requested once the picture is not wanted any more.

 signals:
  /// Comes once, from any thread. `image` is null if it could not be had; `why`: for the operator.
  void done(const QImage& image, const QString& why);
};

/// Asks the station for photos, and decodes them on a thread of its own. It stores none: a job ends with its
/// picture. At most kMaxAsked jobs are asked for or decoded at a time, and kMaxWaiting wait; the oldest of
/// them ends for a new one.
///
/// The bytes came by radio. They are decoded by findings::decode_photo(), which bounds their size, pixels,
/// scans and memory.
class PhotoLoader : public QObject {
  Q_OBJECT

 public:
  static constexpr int kMaxAsked = 4;
  static constexpr std::size_t kMaxWaiting = 64;

  PhotoLoader(CommandSink& sink, QObject* parent);
  ~PhotoLoader() override { pool_.waitForDone(); }

  /// Takes a job, from any thread.
  void fetch(std::shared_ptr<PhotoJob> job);

 signals:
  /// A part of a photo could not be shown.
  void failed(const QString& id, findings::PhotoPart part, const QString& why);

 private:
  using Job = std::shared_ptr<PhotoJob>;
  void add(Job job);
  void ask();
  void decode(const Job& job, const station::CommandOutcome& outcome);
  void ended(const Job& job, const QString& why);

  CommandSink& sink_;
  std::deque<Job> waiting_{};
  int asked_{0};  ///< Jobs that are asked for or decoded.
  QThreadPool pool_{};
};

}  // namespace adit::gui
