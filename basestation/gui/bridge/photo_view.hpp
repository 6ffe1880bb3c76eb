// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>

#include "basestation/gui/bridge/photo_loader.hpp"
#include "basestation/gui/bridge/tables.hpp"
#include "basestation/model/found.hpp"

namespace adit::gui {

/// The photo that is open over the window, with what is known of its finding: the whole one if it is here,
/// else the thumbnail.
class PhotoView : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("a part of the tabs")
  Q_PROPERTY(bool open READ is_open NOTIFY changed)
  Q_PROPERTY(QString title READ title NOTIFY changed)
  Q_PROPERTY(QString text READ text NOTIFY changed)
  Q_PROPERTY(QString line READ line NOTIFY changed)
  /// Which part it is, in words, or why there is none.
  Q_PROPERTY(QString state READ state NOTIFY changed)
  Q_PROPERTY(QString source READ source NOTIFY changed)

 public:
  /// `report`: the newest findings; it outlives this.
  PhotoView(CommandSink& sink, const station::FoundReport& report, QObject* parent);

  /// Opens the photo of that finding, if it has one.
  Q_INVOKABLE void show(int finding);
  /// Returns false if none is open.
  Q_INVOKABLE bool close();
  /// The report changed. A photo whose finding is gone is closed.
  void refresh();
  /// Photos that could not be shown are asked for again.
  void try_again();

  PhotoLoader& loader() { return loader_; }
  /// The source of a finding's thumbnail; empty: it is not here.
  QString thumbnail(const station::FoundItem& item) const;

  bool is_open() const { return finding_ != 0; }
  QString title() const;
  QString text() const;
  QString line() const;
  QString state() const;
  QString source() const;

 signals:
  void changed();

 private:
  /// The part that is open.
  findings::PhotoPart shown() const;

  const station::FoundReport& report_;
  PhotoLoader loader_;
  std::uint32_t finding_{0};  ///< Its number; 0: none is open.
  int attempt_{1};
  QString problem_{};
  std::string id_{};
  bool here_{}, whole_{};
  PhotoCaption caption_{};
};

}  // namespace adit::gui
