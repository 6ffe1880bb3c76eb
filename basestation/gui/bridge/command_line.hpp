// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QStringList>

#include "basestation/gui/bridge/typed_line.hpp"

namespace adit::gui {

class Control;

/// A command typed by its words, as in the terminal: completion, history, and the answer in place.
class CommandLine : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  Q_PROPERTY(bool open READ is_open WRITE set_open NOTIFY open_changed)
  Q_PROPERTY(QString line READ line WRITE set_line NOTIFY line_changed)
  Q_PROPERTY(QStringList proposals READ proposals NOTIFY line_changed)
  Q_PROPERTY(QString answer READ answer NOTIFY answered)
  /// Whether the line commands so many robots that its button is held.
  Q_PROPERTY(bool held READ is_held NOTIFY line_changed)
  Q_PROPERTY(bool refused READ refused NOTIFY answered)

 public:
  static constexpr int kMaxHistory = 100;
  static constexpr int kMaxAnswer = 20'000;  ///< Characters that are shown of an answer.

  explicit CommandLine(Control& control);

  bool is_open() const { return open_; }
  void set_open(bool open);
  QString line() const { return line_; }
  void set_line(const QString& line);
  QStringList proposals() const { return proposals_; }
  QString answer() const { return answer_; }
  bool is_held() const;
  bool refused() const { return refused_; }

  /// By the Enter key, which confirms, or by a press of the button; `held`: for 0.8 s.
  Q_INVOKABLE void run(bool held = true);
  /// Completes the last word as far as it is clear.
  Q_INVOKABLE void complete();
  /// Ends the last word with a proposal.
  Q_INVOKABLE void take(const QString& word);
  /// An earlier line (-1), or a later one (1).
  Q_INVOKABLE void recall(int by);

 signals:
  void open_changed();
  void line_changed();
  void answered();

 private:
  std::vector<std::string> robots() const;
  void show_answer(const QString& text, bool refused);

  Control& control_;
  bool open_{false}, refused_{false};
  QString line_{}, answer_{};
  TypedLine typed_{};  ///< What the line means.
  QStringList proposals_{}, history_{};
  int at_{0};      ///< Of the history; its size: the line that is being typed.
  int orders_{0};  ///< An answer to an earlier line is not shown.
};

}  // namespace adit::gui
