// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <memory>
#include <string>
#include <vector>

#include "basestation/gui/bridge/command_sink.hpp"
#include "basestation/gui/bridge/log_view.hpp"
#include "basestation/gui/bridge/photo_view.hpp"
#include "basestation/gui/bridge/row_model.hpp"
#include "basestation/gui/bridge/settings.hpp"
#include "basestation/gui/bridge/tables.hpp"
#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/network.hpp"
#include "basestation/model/stairs.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// The tabs at the bottom of the window: which one is open, and what they show. The log can stay open; the
/// others cover the map's lower part until they are closed, that of cameras all of it. Health, network and
/// staircases are asked for once a second, only while they are open; findings, and the staircases among them,
/// when they changed.
class TabState : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("a part of the control")
  Q_PROPERTY(QString open READ open NOTIFY opened)
  Q_PROPERTY(QAbstractItemModel* tabs READ tabs CONSTANT)
  Q_PROPERTY(adit::gui::LogView* log READ log CONSTANT)
  Q_PROPERTY(adit::gui::WindowSettings* settings READ settings CONSTANT)
  Q_PROPERTY(QAbstractItemModel* columns READ columns CONSTANT)
  Q_PROPERTY(QAbstractItemModel* cells READ cells CONSTANT)
  Q_PROPERTY(int columnCount READ column_count NOTIFY shown)
  Q_PROPERTY(QAbstractItemModel* network READ network CONSTANT)
  Q_PROPERTY(QAbstractItemModel* speakers READ speakers CONSTANT)
  Q_PROPERTY(QAbstractItemModel* hearing READ hearing CONSTANT)
  Q_PROPERTY(int speakerCount READ speaker_count NOTIFY shown)
  Q_PROPERTY(QAbstractItemModel* findings READ findings CONSTANT)
  Q_PROPERTY(adit::gui::PhotoView* photos READ photos CONSTANT)
  Q_PROPERTY(QAbstractItemModel* stairs READ stairs CONSTANT)
  Q_PROPERTY(QString unreadable READ unreadable NOTIFY shown)
  Q_PROPERTY(QString missing READ missing NOTIFY shown)
  Q_PROPERTY(QString problem READ problem NOTIFY shown)
  /// The keys title, text, mine and automatic, as in HealthDetail.
  Q_PROPERTY(QVariantMap chosen READ chosen NOTIFY shown)
  Q_PROPERTY(int noting READ noting NOTIFY shown)
  Q_PROPERTY(int pickedFinding READ picked NOTIFY shown)
  /// The row of that finding; -1: none.
  Q_PROPERTY(int pickedRow READ picked_row NOTIFY shown)
  Q_PROPERTY(int pickedStairsRow READ picked_stairs_row NOTIFY shown)

 public:
  /// `log`: every line of the log, the newest first.
  TabState(CommandSink& sink, RowModel& log, QObject* parent);

  /// Shows a newer state. `silent`: the station does not speak.
  void show(const std::shared_ptr<const station::World>& world, const std::vector<std::string>& selection,
            bool silent);
  void add_notice(const station::Notice& notice);
  void add_command(const station::CommandEvent& event);
  /// True if the key opens or closes a tab.
  bool press_key(int key);
  /// Closes the tab that covers the map; false if there is none.
  bool close();

  QString open() const { return extra_.isEmpty() ? (log_open_ ? "log" : "") : extra_; }
  Q_INVOKABLE void toggle(const QString& tab);
  /// Chooses a component for the details below the matrix.
  Q_INVOKABLE void choose(const QString& robot, const QString& component);
  Q_INVOKABLE void restartChosen();
  Q_INVOKABLE void changePolicy();  ///< From automatic to manual, or back.
  Q_INVOKABLE void judge(int finding, const QString& verdict);
  Q_INVOKABLE void removeMark(int finding);
  /// Marks a finding, and asks the map to show its place.
  Q_INVOKABLE void pickFinding(int finding);
  /// Marks a staircase by its number, and asks the map to show its middle.
  Q_INVOKABLE void pickStairs(int number);
  /// Opens the tab of findings, or of staircases, with that one marked.
  void show_finding(int finding);
  Q_INVOKABLE void startNote(int finding);
  Q_INVOKABLE void endNote(const QString& text, bool send);
  Q_INVOKABLE void exportLog();
  Q_INVOKABLE void exportFindings();

  QAbstractItemModel* tabs() { return &tabs_; }
  LogView* log() { return &log_; }
  WindowSettings* settings() { return &settings_; }
  QAbstractItemModel* columns() { return &columns_; }
  QAbstractItemModel* cells() { return &cells_; }
  int column_count() const { return columns_.rowCount(); }
  QAbstractItemModel* network() { return &network_; }
  QAbstractItemModel* speakers() { return &speakers_; }
  QAbstractItemModel* hearing() { return &hearing_; }
  int speaker_count() const { return speakers_.rowCount(); }
  QAbstractItemModel* findings() { return &findings_; }
  PhotoView* photos() { return &photos_; }
  QAbstractItemModel* stairs() { return &stairs_; }
  const QString& unreadable() const { return unreadable_; }
  const QString& missing() const { return missing_; }
  const QString& problem() const { return problem_; }
  QVariantMap chosen() const;
  int noting() const { return noting_; }
  std::uint32_t picked() const { return picked_; }  ///< Number of the marked finding; 0: none.
  int picked_row() const;
  int picked_stairs_row() const;
  const station::NetworkReport& net() const { return net_; }
  /// Asks for the network also while its tab is closed, until each who began has ended it.
  void watch_network(bool watch);
  const station::FoundReport& found() const { return found_; }
  const station::StairsReport& staircases() const { return stairs_report_; }

 signals:
  void opened();
  void shown();
  void network_changed();
  void findings_changed();                          ///< Or another one is marked.
  void place_wanted(double x, double y, double z);  ///< The map should show it, map frame, m.
  void ordered(const QString& line);                ///< A command of the operator.
  void said(const QString& text, bool good);
  void remark(const QString& text);  ///< For the log.

 private:
  void time_questions();  ///< Starts or stops them.
  void ask();
  void find_later();  ///< Asks for the findings soon.
  void ask_findings();
  void ask_stairs();
  template <class Report>
  void ask_for(const char* line, Result<Report> (*read)(const station::CommandOutcome&), bool& asked,
               Report& report, void (TabState::*show)());
  void show_tabs();
  void show_health();
  void show_network();
  void show_findings();
  void show_stairs();
  void write(const QString& name, const QByteArray& content);

  CommandSink& sink_;
  LogView log_;
  WindowSettings settings_;
  RowModel tabs_, columns_, cells_, network_, speakers_, hearing_, findings_, stairs_;
  std::shared_ptr<const station::World> world_;
  bool silent_{true};

  bool log_open_{true};
  QString extra_{};
  QTimer timer_{};        ///< Runs while a tab that asks is open.
  QTimer found_later_{};  ///< Several findings at once are asked for once.
  bool health_asked_{false}, network_asked_{false}, found_asked_{false};
  std::uint64_t found_changes_{};  ///< Of the last world.
  bool found_again_{false};        ///< Findings changed while they were asked for.
  station::HealthReport health_{};
  station::NetworkReport net_{};
  int network_watchers_{0};
  station::FoundReport found_{};
  PhotoView photos_;                                ///< Of `found_`.
  bool stairs_asked_{false}, stairs_again_{false};  ///< As of findings.
  station::StairsReport stairs_report_{};
  QString missing_{}, unreadable_{}, problem_{};
  std::string chosen_robot_{}, chosen_component_{};
  HealthDetail chosen_{};
  int noting_{0};
  std::uint32_t picked_{0};
};

}  // namespace adit::gui
