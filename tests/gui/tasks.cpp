// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/tasks.hpp"

namespace adit::gui {
namespace {

TaskResult stop_all() {
  TaskWindow task("stop all", 1);
  task.think();
  task.tap("stopAll");
  return task.result(task.sent("STOP"));
}

TaskResult stop_one() {
  TaskWindow task("stop one robot", 2);
  task.think();
  task.tap("card_r1");
  task.tap("button_stop");
  return task.result(task.sent("STOP r1"));
}

TaskResult take_and_send() {
  TaskWindow task("take a robot and send it to a place", 3);
  task.change("r3", [](station::Robot& robot) { robot = gui::robot("r3", 12, 4); });  // It has no holder.
  task.think();
  task.tap("card_r3");
  task.tap("button_take");
  const bool taken = task.sent("take r3");
  task.station_side().pending.back()({});
  task.change("r3", [](station::Robot& robot) { robot = mine(robot); });
  task.think();
  task.hold_place(9, 0.5);
  return task.result(taken && task.last_starts("goto r3 "));
}

TaskResult blocked_and_why() {
  TaskWindow task("see who is blocked, and why", 1, 3.0);
  task.say("r4", "blocked", "every path is blocked");
  task.think();
  return task.result(task.reads("r4") && task.reads("every path is blocked"));
}

TaskResult unblock() {
  TaskWindow task("see who is blocked, understand, send it elsewhere", 2, 10.0);
  task.quiet_but("r4");
  task.say("r4", "blocked", "every path is blocked");
  task.think();
  task.tap("show_" + task.row_of("r4"));
  task.think();
  task.hold_place(12, 0.5);
  return task.result(task.last_starts("goto r4 "));
}

TaskResult grant() {
  TaskWindow task("grant a robot to the operator who asks", 1);
  task.quiet_but("none");
  task.say("r4", "asked", "op2 asked for r4");
  task.think();
  const QString button = "grant_" + task.row_of("r4");
  task.hold(button, [&] { return !task.station_side().lines.empty(); });
  return task.result(task.last_starts("grant r4 "));
}

TaskResult switch_view() {
  TaskWindow task("switch between the map from above and in 3D", 1);
  task.think();
  task.tap("solidToggle");
  return task.result(task.state().solid());
}

TaskResult drive() {
  TaskWindow task("drive a robot by hand", 2);
  task.think();
  task.tap("card_r1");
  task.tap("button_drive");
  return task.result(task.state().outcome().startsWith("Drive"));
}

}  // namespace

std::vector<TaskResult> do_tasks() {
  return {stop_all(), stop_one(), take_and_send(), blocked_and_why(),
          unblock(),  grant(),    switch_view(),   drive()};
}

}  // namespace adit::gui
