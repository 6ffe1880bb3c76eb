// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QElapsedTimer>
#include <QObject>
#include <QSet>
#include <QTimer>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "basestation/gui/bridge/action_bar.hpp"
#include "basestation/gui/bridge/area_tool.hpp"
#include "basestation/gui/bridge/attention_list.hpp"
#include "basestation/gui/bridge/camera_feeds.hpp"
#include "basestation/gui/bridge/camera_grid.hpp"
#include "basestation/gui/bridge/command_line.hpp"
#include "basestation/gui/bridge/command_sink.hpp"
#include "basestation/gui/bridge/detail_list.hpp"
#include "basestation/gui/bridge/drive_control.hpp"
#include "basestation/gui/bridge/map_follow.hpp"
#include "basestation/gui/bridge/mark_tool.hpp"
#include "basestation/gui/bridge/row_model.hpp"
#include "basestation/gui/bridge/stairs_offer.hpp"
#include "basestation/gui/bridge/tabs.hpp"
#include "basestation/gui/scene/camera.hpp"
#include "basestation/gui/scene/mark_list.hpp"
#include "basestation/gui/scene/trails.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/world.hpp"

namespace adit::gui {

/// The state of the window and the operator's inputs: what QML shows, and what it calls. Commands always
/// carry the names of their robots, and only the operator changes the selection.
class Control : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("given to the window by the program")
  Q_PROPERTY(QAbstractItemModel* robots READ robots CONSTANT)
  Q_PROPERTY(QAbstractItemModel* buttons READ buttons CONSTANT)
  Q_PROPERTY(QAbstractItemModel* refusals READ refusals CONSTANT)
  Q_PROPERTY(QAbstractItemModel* log READ log CONSTANT)
  Q_PROPERTY(adit::gui::TabState* tabs READ tabs CONSTANT)
  Q_PROPERTY(QString operatorName READ operator_name NOTIFY shown)
  Q_PROPERTY(QString link READ link NOTIFY shown)
  Q_PROPERTY(int robotCount READ robot_count NOTIFY shown)
  Q_PROPERTY(int mineCount READ mine_count NOTIFY shown)
  Q_PROPERTY(int lostCount READ lost_count NOTIFY shown)
  Q_PROPERTY(QString others READ others NOTIFY shown)
  Q_PROPERTY(adit::gui::AreaTool* area READ area CONSTANT)
  Q_PROPERTY(adit::gui::MarkTool* mark READ mark CONSTANT)
  Q_PROPERTY(adit::gui::AttentionList* attention READ attention CONSTANT)
  Q_PROPERTY(adit::gui::DetailList* details READ details CONSTANT)
  Q_PROPERTY(adit::gui::CameraFeeds* feeds READ feeds CONSTANT)
  Q_PROPERTY(adit::gui::CameraGrid* cameras READ cameras CONSTANT)
  Q_PROPERTY(adit::gui::DriveControl* drive READ drive CONSTANT)
  Q_PROPERTY(adit::gui::MapFollow* follow READ follow CONSTANT)
  Q_PROPERTY(adit::gui::CommandLine* commandLine READ command_line CONSTANT)
  Q_PROPERTY(QString stopText READ stop_text NOTIFY shown)
  Q_PROPERTY(QString stopTextShort READ stop_text_short NOTIFY shown)
  Q_PROPERTY(bool silent READ silent NOTIFY shown)
  Q_PROPERTY(bool ended READ ended NOTIFY shown)
  Q_PROPERTY(QString silentText READ silent_text NOTIFY shown)
  Q_PROPERTY(QString silentTextShort READ silent_text_short NOTIFY shown)
  Q_PROPERTY(QString selectionText READ selection_text NOTIFY shown)
  Q_PROPERTY(int refusalCount READ refusal_count NOTIFY shown)
  Q_PROPERTY(QString stairsText READ stairs_text NOTIFY stairs_shown)
  Q_PROPERTY(bool stairsOffered READ stairs_offered NOTIFY stairs_shown)
  Q_PROPERTY(bool gotoHeld READ goto_is_held NOTIFY shown)
  Q_PROPERTY(QString outcome READ outcome NOTIFY said)
  /// The same in a few words, where it has no room.
  Q_PROPERTY(QString outcomeShort READ outcome_short NOTIFY said)
  Q_PROPERTY(QString outcomeKind READ outcome_kind NOTIFY said)
  /// Whether the map is shown from the side.
  Q_PROPERTY(bool solid READ solid WRITE set_solid NOTIFY solid_changed)
  /// Whether the window gives no orders to robots but stops: it selects, and switches cameras on and off.
  Q_PROPERTY(bool viewOnly READ view_only CONSTANT)
  Q_PROPERTY(bool aiming READ aiming WRITE set_aiming NOTIFY aiming_changed)
  Q_PROPERTY(bool reasonsOpen READ reasons_open WRITE set_reasons_open NOTIFY reasons_open_changed)

 public:
  static constexpr std::size_t kMaxLog = 500;

  enum class Orders : std::uint8_t { all, view_only };

  explicit Control(CommandSink& sink, Orders orders = Orders::all, QObject* parent = nullptr);

  // From the station.
  /// `now`: steady time, s, that never falls.
  void show(std::shared_ptr<const station::World> world, double now);
  void show_map(std::shared_ptr<const station::TileMap> map);
  void show_link(bool connected, double silent_for, const std::string& why);
  void add_notice(const station::Notice& notice);
  void add_command(const station::CommandEvent& event);
  void add_remark(const QString& text);  ///< A line of the log.

  // For the map.
  const station::World& world() const { return *world_; }
  const std::shared_ptr<const station::TileMap>& map() const { return map_; }
  const Trails& trails() const { return trails_; }
  const std::vector<std::string>& selection() const { return selection_; }
  double now() const { return now_; }
  double silent_for() const { return silent_for_; }
  /// Goals of the robots that would drive if that place was tapped, map frame, m.
  std::vector<Point> goals_at(const Point& place) const;
  /// Sends the robots of the selection that would accept it to a place, map frame, m. Without a selection the
  /// place is marked.
  /// `z`: height of the ground there, if it is known. `held`: by a press that was held; see goto_is_held().
  void go_to(const Point& place, std::optional<double> z, bool held);
  /// Whether they are so many that a tap on the place is not enough.
  bool goto_is_held() const;

  /// A finger tapped a mark of the map; `add`: with the shift key.
  void tap(const Target& target, bool add);

  /// Runs a command line as an order of the operator. `slot`: the button that shows its state. `then`: called
  /// with its outcome.
  void order(const std::string& line, const std::string& slot = {}, CommandSink::Done then = {});
  void stop(const std::vector<std::string>& robots);  ///< Software stop; of all, if there is none.
  /// Drives the selected robot by hand, if it is one that would accept it.
  void drive_selected();
  /// Takes the selected robots; `held`: by press and hold, which takes them from their holders.
  void take_selected(bool held);
  /// Selects the robot so many cards below the selected one.
  void move_selection(int by);
  /// Selects these robots as far as they are known, and asks the map to show them.
  void select_and_show(const std::vector<std::string>& robots);
  /// Lines of an answer, as one.
  static QString one_line(const std::string& text);

  /// Shows a line as the last outcome; `kind`: sent, done or refused. `brief`: what is shown where the text
  /// has no room.
  void say(const QString& text, const QString& kind, const QString& brief = {});

  /// The operator looks at this place of the map, or at none in particular.
  void view_moved(const std::optional<station::LookedAt>& place) { sink_.look_at(place); }

  // From QML.
  Q_INVOKABLE void select(const QString& name, bool add);
  Q_INVOKABLE void trigger(int slot, bool held);
  Q_INVOKABLE void cure(int row, bool held);
  Q_INVOKABLE void stopAll();
  /// Sends the selected robot over the marked staircase.
  Q_INVOKABLE void goOverStairs(bool up, bool held);
  Q_INVOKABLE void restartStation() { sink_.start_station(); }
  /// A key of the keyboard; `scan` is its place, as Shift turns 1 into another character. True if it means
  /// something.
  Q_INVOKABLE bool pressKey(int key, int modifiers, int scan, bool repeated);
  Q_INVOKABLE bool releaseKey(int key, int scan, bool repeated);
  /// The keys go to another item or window, so no release will come.
  Q_INVOKABLE void forgetKeys();
  /// Whether the window has the keyboard.
  Q_INVOKABLE void setFocused(bool focused);

  QAbstractItemModel* robots() { return &robots_; }
  QAbstractItemModel* buttons() { return &buttons_; }
  QAbstractItemModel* refusals() { return &refusals_; }
  QAbstractItemModel* log() { return &log_; }
  TabState* tabs() { return &tabs_; }
  CameraFeeds* feeds() { return &feeds_; }
  CameraGrid* cameras() { return &cameras_; }
  QString operator_name() const { return text_of(world_->station); }
  QString link() const { return text_of(world_->link); }
  int robot_count() const { return static_cast<int>(world_->robots.size()); }
  int mine_count() const { return mine_; }
  int lost_count() const { return lost_; }
  QString others() const;
  AreaTool* area() { return &area_; }
  MarkTool* mark() { return &mark_; }
  AttentionList* attention() { return &attention_; }
  DetailList* details() { return &details_; }
  DriveControl* drive() { return &drive_; }
  MapFollow* follow() { return &follow_; }
  CommandLine* command_line() { return &command_line_; }
  QString stop_text() const;
  QString stop_text_short() const;  ///< Counts instead of names.
  bool silent() const { return silent_for_ > 1.0 || ended_; }
  bool ended() const { return ended_; }
  QString silent_text() const;
  QString silent_text_short() const;
  QString selection_text() const;
  int refusal_count() const;  ///< Actions that some robot of the selection would refuse.
  QString stairs_text() const;
  bool stairs_offered() const;
  QString outcome() const { return outcome_; }
  QString outcome_short() const { return outcome_short_; }
  QString outcome_kind() const { return outcome_kind_; }
  bool solid() const { return solid_; }
  void set_solid(bool solid);
  bool view_only() const { return orders_ == Orders::view_only; }
  bool aiming() const { return aiming_; }
  void set_aiming(bool aiming);
  bool reasons_open() const { return reasons_open_; }
  void set_reasons_open(bool open);

 signals:
  void shown();  ///< The world, the link or the selection changed.
  void map_changed();
  void stairs_shown();  ///< Which robot would take the marked staircase may have changed.
  /// The map should show this place in its middle, map frame, m; z may be NaN: that of the selection.
  void look_at(double x, double y, double z);
  void said();
  void orders_dropped();  ///< A finger that is down on the map sends nothing any more.
  void solid_changed();
  void cut_moved(int steps);  ///< The height above which the map is not shown.
  void zoomed(double factor);
  void aiming_changed();
  void reasons_open_changed();

 private:
  void refresh();
  void show_cards();
  void show_bar();
  void run(const std::string& line, const std::string& slot, CommandSink::Done then = {});
  void order_of_tab(const QString& line);
  void finished(const std::string& line, const std::string& slot, int batch,
                const station::CommandOutcome& outcome);
  /// The next outcomes belong to a new order of the operator.
  void begin_batch();
  /// Takes back everything that was begun and not sent.
  void drop_orders();
  void set_state(const std::string& slot, const QString& state);
  /// Waits for the Enter key with the line of that button.
  void pend(const BarButton& button);
  void press_slot(const char* id);
  void ask_for_place(const BarButton& button);
  StairsOffer offer_of_stairs() const;
  QString reason_of(const BarButton& button) const;
  struct KeyRow;
  static std::span<const KeyRow> keys();
  void confirm();        ///< Sends the line that needs the Enter key.
  void take_back();      ///< What the Escape key does.
  void pend_override();  ///< Resets every stop of the selection once that is confirmed.
  bool press_digit(int key, int scan, bool add);
  bool press_letter(int key, int place, bool alone);
  /// `age`: time since it happened, s.
  void log_row(const QString& kind, const QString& who, const QString& text, double age = 0.0);
  void show_notice(const station::Notice& notice);

  CommandSink& sink_;
  Orders orders_;
  std::shared_ptr<const station::World> world_;
  std::shared_ptr<const station::TileMap> map_;
  Trails trails_{};
  double now_{};
  double silent_for_{0.0};
  bool ended_{false};
  std::string why_{};

  std::vector<std::string> selection_{};
  ActionBar bar_{};
  std::map<std::string, QString> states_{};  ///< Of buttons: sent, done or refused.
  RowModel robots_, buttons_, refusals_, log_;
  TabState tabs_;
  CameraFeeds feeds_;
  qint64 next_row_{1};
  int mine_{}, lost_{}, stopped_{};
  AreaTool area_{*this};
  MarkTool mark_{*this};
  AttentionList attention_{*this};
  DetailList details_{*this};
  CameraGrid cameras_{*this};
  DriveControl drive_{*this};
  MapFollow follow_{*this};
  CommandLine command_line_{*this};
  std::uint64_t last_notice_{};  ///< The newest one that was shown.
  bool catch_up_{true};          ///< The next snapshot has notices that did not come by themselves.

  int batch_{0};
  QStringList batch_lines_{};
  bool batch_refused_{false};
  QString outcome_{}, outcome_short_{}, outcome_kind_{};
  QStringList stop_missing_{};  ///< Robots that did not answer the last stop of all.
  bool aiming_{false}, reasons_open_{false}, solid_{false};

  std::string pending_line_{}, pending_slot_{};  ///< Sent by the Enter key within 3 s.
  QElapsedTimer pending_since_{};
  QSet<int> keys_down_{};  ///< By their places on the keyboard.
  int motion_place_{0};    ///< Of the key that acts when it is released; 0: none does.
  const char* motion_slot_{""};
};

}  // namespace adit::gui
