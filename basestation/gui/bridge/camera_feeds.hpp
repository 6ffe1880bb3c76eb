// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QImage>
#include <QObject>
#include <QThreadPool>
#include <functional>
#include <memory>
#include <string>

#include "basestation/gui/bridge/command_sink.hpp"

namespace adit::gui {

/// A picture of a camera as the window shows it.
struct ShownPicture {
  QImage image{};          ///< Null: there is no newer one.
  QImage unmarked{};       ///< The same without marks of what is missing, for the next picture.
  std::uint64_t number{};  ///< Of the picture; 0: none.
  double age{};            ///< From its exposure, when the station sent it, s.
  int missing{};           ///< Stripes that are not of this picture.
  QString problem{};       ///< Why there is none, for the operator.
};

/// Asks the station for live pictures of cameras and decodes them on a thread of its own. Stripes that were
/// lost show the former picture, grey and darker. The bytes came by radio: the decoder bounds them.
class CameraFeeds : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")

 public:
  using Done = std::function<void(const ShownPicture& picture)>;

  CameraFeeds(CommandSink& sink, QObject* parent);
  ~CameraFeeds() override { pool_.waitForDone(); }

  /// Asks for the next picture. `former`: the unmarked one of the picture before. `done` is called once, in
  /// the window's thread, unless this is destroyed first.
  void next(const station::CameraRequest& request, const QImage& former, Done done);

 private:
  CommandSink& sink_;
  QThreadPool pool_{};
};

}  // namespace adit::gui
