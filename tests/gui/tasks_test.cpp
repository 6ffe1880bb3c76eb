// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/tasks.hpp"

namespace adit::gui {
namespace {

TEST(Tasks, NeedNoMoreInputsThanWanted) {
  for (const TaskResult& task : do_tasks()) {
    EXPECT_TRUE(task.done) << task.name;
    EXPECT_LE(task.inputs, task.most) << task.name;
    EXPECT_TRUE(task.limit == 0.0 || task.seconds <= task.limit) << task.name << ": " << task.seconds << " s";
    EXPECT_GE(task.seconds, KeystrokeModel::kMental) << task.name;
  }
}

TEST(Tasks, ASmallerOrFartherTargetTakesLonger) {
  EXPECT_DOUBLE_EQ(KeystrokeModel::pointing(0.0, 12.0), 0.0);
  EXPECT_DOUBLE_EQ(KeystrokeModel::pointing(12.0, 12.0), KeystrokeModel::kPerBit) << "one bit";
  EXPECT_GT(KeystrokeModel::pointing(100.0, 12.0), KeystrokeModel::pointing(50.0, 12.0));
  EXPECT_GT(KeystrokeModel::pointing(50.0, 6.0), KeystrokeModel::pointing(50.0, 12.0));
}

}  // namespace
}  // namespace adit::gui
