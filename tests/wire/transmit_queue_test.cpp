// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link/transmit_queue.hpp"

#include <gtest/gtest.h>

#include <string>

namespace adit::wire {
namespace {

using Queue = TransmitQueue<std::string>;

/// Sends the queued messages for `time`, 10 ms a frame; "a" or "a.1" for frame 1 of a message of several.
struct Line {
  Queue queue{};
  Duration now{};
  std::vector<std::string> sent{}, dropped{};

  void push(const std::string& name, int priority, std::uint64_t number = 0, std::uint16_t frames = 1) {
    const auto replaced = queue.push({.item = name,
                                      .frames = frames,
                                      .priority = priority,
                                      .supersedes = number,
                                      .since = now,
                                      .max_queue_age = 250ms,
                                      .airtime = 10ms});
    if (replaced) dropped.push_back(*replaced);
  }
  void run(Duration time) {
    const Duration end = now + time;
    while (now < end) {
      const auto next = queue.next(
          now, [](const std::string&) { return 10ms; },
          [this](std::string item) { dropped.push_back(std::move(item)); });
      if (next) {
        sent.push_back(next->message.frames == 1
                           ? next->message.item
                           : next->message.item + "." + std::to_string(next->message.sent));
        now += next->airtime;
      } else if (const auto at = queue.ready(now)) {
        now = std::min(*at, end);
      } else {
        now = end;
      }
    }
  }
};

using Names = std::vector<std::string>;

TEST(TransmitQueue, SendsByPriorityThenInOrder) {
  Line line;
  line.now = 10s;
  line.push("map", 5), line.push("state", 3), line.push("stop", 0), line.push("take", 0);
  line.run(100ms);
  EXPECT_EQ(line.sent, (Names{"stop", "take", "state", "map"}));
  EXPECT_EQ(line.queue.size(), 0U);
}

TEST(TransmitQueue, CountsWaitingAndDroppedFrames) {
  Line line;
  line.now = 10s;
  line.push("stop", 0), line.push("map", 5, 0, 3);
  for (int i = 0; i < 4; ++i) line.push("state", 3, 7);
  EXPECT_EQ(line.queue.waiting()[0], 10ms);
  EXPECT_EQ(line.queue.waiting()[3], 10ms);
  EXPECT_EQ(line.queue.waiting()[5], 30ms);
  EXPECT_EQ(line.queue.dropped()[3], 3U);
  line.run(30ms);
  EXPECT_EQ(line.queue.waiting()[5], 20ms);  // one frame of three went
  line.push("late", 4);
  line.now += 1s;
  line.run(100ms);
  EXPECT_EQ(line.queue.dropped()[4], 1U);
  EXPECT_EQ(line.queue.dropped()[5], 0U);  // what was begun is finished
}

TEST(TransmitQueue, AnUrgentMessageWaitsForOneFrameAtMost) {
  Line line;
  line.now = 10s;
  line.push("map", 5, 0, 3);
  line.run(10ms);
  line.push("stop", 0);
  line.run(100ms);
  EXPECT_EQ(line.sent, (Names{"map.1", "stop", "map.2", "map.3"}));
}

TEST(TransmitQueue, NewestReplacesAWaitingMessageButNotAHalfSentOne) {
  Line line;
  line.now = 10s;
  line.push("old", 3, 7), line.push("other", 3, 8), line.push("new", 3, 7);
  EXPECT_EQ(line.dropped, (Names{"old"}));
  line.run(100ms);
  EXPECT_EQ(line.sent, (Names{"new", "other"}));
  line.push("picture", 6, 9, 2);
  line.run(10ms);
  line.push("next", 6, 9, 2);
  line.run(500ms);
  EXPECT_EQ(Names(line.sent.begin() + 2, line.sent.end()),
            (Names{"picture.1", "picture.2", "next.1", "next.2"}));
}

TEST(TransmitQueue, RepeatedMessageStaysInPlaceAndIsNoLoss) {
  Queue queue;
  for (const char* text : {"repair", "other", "repair"}) {
    const std::uint64_t number = text[0] == 'r' ? 7 : 8;
    (void)queue.push({.item = text, .priority = 1, .supersedes = number, .again = true, .max_queue_age = 1s});
  }
  EXPECT_EQ(queue.size(), 2U);
  EXPECT_EQ(queue.dropped()[1], 0U);
  const auto first = queue.next(
      0ms, [](const std::string&) { return 1ms; }, [](const std::string&) {});
  EXPECT_EQ(first->message.item, "repair");
}

TEST(TransmitQueue, DropsMessagesThatWaitedTooLong) {
  Line line;
  for (int i = 0; i < 40; ++i) line.push("stop", 0);
  line.run(1s);
  EXPECT_EQ(line.sent.size(), 26U);  // at 0, 10, ... 250 ms
  EXPECT_EQ(line.dropped.size(), 14U);
  line.push("late", 5);
  EXPECT_EQ(line.queue.oldest(line.now + 30ms), 30ms);
}

TEST(TransmitQueue, AClassStaysWithinItsShareWhileOthersUseTheRest) {
  Line line;
  line.now = 10s;
  int bulk = 0, video = 0;
  for (int i = 1; i <= 400; ++i) {
    line.push("bulk", 5), line.push("video", 6);
    line.run(10s + i * 25ms - line.now);
  }
  for (const std::string& name : line.sent) (name == "bulk" ? bulk : video)++;
  EXPECT_NEAR(bulk, 400, 40);   // wanted and within 60 % of 1000 frames
  EXPECT_NEAR(video, 315, 30);  // 30 %, and what was saved up at the start
}

TEST(TransmitQueue, UrgentMessagesAreNotLimited) {
  Line line;
  for (int i = 0; i < 20; ++i) line.push("stop", 0);
  line.run(200ms);
  EXPECT_EQ(line.sent.size(), 20U);
  EXPECT_FALSE(line.queue.ready(line.now));
}

}  // namespace
}  // namespace adit::wire
