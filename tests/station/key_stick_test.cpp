// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/key_stick.hpp"

#include <gmock/gmock.h>

#include "basestation/input/keys.hpp"

namespace adit::station::input {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr KeyStick::Clock::time_point kStart{};

TEST(Keys, ArrowsLettersAndControl) {
  EXPECT_THAT(
      decode_keys("\x1b[A\x1b[B\x1bOC\x1b[Dt\x03\r\x7f"),
      ElementsAre(key_up, key_down, key_right, key_left, 't', key_interrupt, key_enter, key_backspace));
}

TEST(Keys, UnknownSequencesAreLeftOut) {
  EXPECT_THAT(decode_keys("\x1b[15~a\x1b[1;5A\x1b["), ElementsAre('a', key_up));
  EXPECT_THAT(decode_keys("\x1b"), ElementsAre(key_escape));
}

TEST(KeyStick, AFirstPressLastsUntilTheKeyboardRepeats) {
  KeyStick stick;
  stick.set_limits(1.0, 2.0);
  EXPECT_TRUE(stick.press(key_up, kStart));
  EXPECT_DOUBLE_EQ(stick.velocity(kStart + 590ms)[0], 0.5);
  EXPECT_DOUBLE_EQ(stick.velocity(kStart + 610ms)[0], 0.0);
}

TEST(KeyStick, ARepeatedKeyEndsSoonAfterItsLastRepeat) {
  KeyStick stick;
  stick.press('w', kStart);
  stick.press('w', kStart + 500ms);
  stick.press('w', kStart + 530ms);
  EXPECT_GT(stick.velocity(kStart + 770ms)[0], 0.0);
  EXPECT_DOUBLE_EQ(stick.velocity(kStart + 790ms)[0], 0.0);
}

TEST(KeyStick, SpaceIsZeroAndScaleHasItsLimits) {
  KeyStick stick;
  stick.set_limits(2.0, 1.0);
  stick.press('w', kStart);
  stick.press('a', kStart);
  EXPECT_DOUBLE_EQ(stick.velocity(kStart)[2], 0.5);
  stick.press(' ', kStart);
  EXPECT_THAT(stick.velocity(kStart), ElementsAre(0.0, 0.0, 0.0));
  for (int i = 0; i < 20; ++i) stick.press('+', kStart);
  EXPECT_DOUBLE_EQ(stick.scale(), 1.0);
  for (int i = 0; i < 20; ++i) stick.press('-', kStart);
  EXPECT_DOUBLE_EQ(stick.scale(), 0.1);
  EXPECT_FALSE(stick.press('z', kStart));
}

}  // namespace
}  // namespace adit::station::input
