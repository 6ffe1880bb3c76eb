// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QElapsedTimer>
#include <QImage>
#include <QQuickPaintedItem>
#include <QTimer>
#include <memory>

#include "basestation/gui/bridge/camera_feeds.hpp"

namespace adit::gui {

/// The live picture of one camera of a robot, as large as the item has room for it. It asks for pictures only
/// while it is visible and active. A picture that is older than kStale is grey; its caption says its age.
class CameraItem : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(adit::gui::CameraFeeds* feeds READ feeds WRITE set_feeds NOTIFY source_changed)
  Q_PROPERTY(QString robot READ robot WRITE set_robot NOTIFY source_changed)
  Q_PROPERTY(QString camera READ camera WRITE set_camera NOTIFY source_changed)
  /// Most pictures/s.
  Q_PROPERTY(double rate MEMBER rate_ NOTIFY source_changed)
  /// The largest width that is asked for, pixels; 0: as wide as the item is.
  Q_PROPERTY(int limit MEMBER limit_ NOTIFY source_changed)
  /// Time for which the source stays the same before a picture is asked for, ms: a station holds each request
  /// for seconds.
  Q_PROPERTY(int rest MEMBER rest_ NOTIFY source_changed)
  /// While it is false, the last picture stays in view and ages.
  Q_PROPERTY(bool active READ is_active WRITE set_active NOTIFY source_changed)
  Q_PROPERTY(QString caption READ caption NOTIFY shown_changed)
  /// Age of the picture in words, and what is lost of it; empty: there is none.
  Q_PROPERTY(QString ageText READ age_text NOTIFY shown_changed)
  /// The age alone.
  Q_PROPERTY(QString shortAge READ short_age NOTIFY shown_changed)
  /// Why no picture comes, in the words of the station.
  Q_PROPERTY(QString problem READ problem NOTIFY shown_changed)
  Q_PROPERTY(bool stale READ is_stale NOTIFY shown_changed)
  Q_PROPERTY(bool empty READ is_empty NOTIFY shown_changed)

 public:
  static constexpr double kStale = 1.0;        ///< s
  static constexpr double kStaleAtMost = 5.0;  ///< However rarely pictures come, s.
  static constexpr int kAgeStep = 500;         ///< Between two looks at the age, ms.
  static constexpr int kRetry = 1000;          ///< After a problem, ms.
  static constexpr int kPause = 100;           ///< After an answer without a picture, ms.

  explicit CameraItem(QQuickItem* parent = nullptr);
  void paint(QPainter* painter) override;

  CameraFeeds* feeds() const { return feeds_; }
  void set_feeds(CameraFeeds* feeds);
  const QString& robot() const { return robot_; }
  void set_robot(const QString& robot);
  const QString& camera() const { return camera_; }
  void set_camera(const QString& camera);
  bool is_active() const { return active_; }
  void set_active(bool active);
  QString caption() const;
  QString age_text() const;
  QString short_age() const;
  const QString& problem() const { return problem_; }
  bool is_stale() const { return !image_.isNull() && age() > stale_after(); }
  bool is_empty() const { return image_.isNull(); }

 signals:
  void source_changed();
  void shown_changed();

 protected:
  void itemChange(ItemChange change, const ItemChangeData& data) override;

 private:
  /// Age of the picture, s.
  double age() const;
  /// Pictures that come rarely are not old before the next one is due. After the first one, that is known by
  /// the rate alone.
  double stale_after() const {
    const double period = period_ > 0.0 ? period_ : std::min(10.0, 1.0 / std::max(rate_, 0.1));
    return std::clamp(2.0 * period + 0.5, kStale, kStaleAtMost);
  }
  void restart();
  void ask_soon();
  void ask();
  void take(std::uint64_t run, const ShownPicture& picture);

  CameraFeeds* feeds_{};
  QString robot_{}, camera_{};
  double rate_{15.0};
  int limit_{}, rest_{};
  bool active_{true};
  QImage image_{}, unmarked_{};
  QString problem_{};
  int missing_{};
  std::uint64_t number_{};
  std::uint64_t run_{};  ///< Answers to requests before a restart are left out.
  bool asked_{};
  double delay_{};         ///< Age of the picture when it came, s.
  double period_{};        ///< Between the last two pictures, s.
  QElapsedTimer since_{};  ///< Since the picture came.
  QTimer aging_{}, retry_{};
};

}  // namespace adit::gui
