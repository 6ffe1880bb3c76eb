// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

TEST_F(Window, AFingerThatRestsOnACardAddsItOrTakesItOut) {
  settle_layout();
  touch(middle("card_r1"));
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
  const auto rest_on = [&](const QString& card, std::size_t robots) {
    const QPoint at = middle(card);
    finger_down(at);
    EXPECT_TRUE(QTest::qWaitFor([&] { return control.selection().size() == robots; }, 30'000));
    finger_up(at);
    settle();
  };
  rest_on("card_r2", 2);
  EXPECT_THAT(control.selection(), ElementsAre("r1", "r2")) << "the end of the press selects nothing";
  rest_on("card_r1", 1);
  EXPECT_THAT(control.selection(), ElementsAre("r2"));
}

}  // namespace
}  // namespace adit::gui
