// SPDX-License-Identifier: Apache-2.0
#include "core/wire/mailbox.hpp"

#include <gtest/gtest.h>

namespace adit::wire {
namespace {

using Box = Mailbox<int>;

class MailboxTest : public testing::Test {
 protected:
  void put(std::uint8_t sender, std::uint64_t key, std::size_t bytes = 10) {
    box.put({{sender}, key, Time{}, bytes, ++number},
            [this](const Box::Entry& old) { gone.push_back(old.payload); });
  }
  std::vector<int> take_all() {
    std::vector<int> all;
    while (!box.empty()) all.push_back(box.take().payload);
    return all;
  }
  Box box{2, 100};
  std::vector<int> gone{};
  int number{};
};

TEST_F(MailboxTest, HoldsTheNewestOfEachSenderAndKeyInOrder) {
  put(1, 1);
  put(1, 2);
  put(2, 1);
  put(1, 1);
  put(1, 1);  // the third of its sender and key
  EXPECT_EQ(gone, std::vector<int>{1});
  EXPECT_EQ(take_all(), (std::vector<int>{2, 3, 4, 5}));
}

TEST_F(MailboxTest, IsBoundedHoweverManyKeysASenderInvents) {
  for (std::uint64_t key = 0; key < 10'000; ++key) put(1, key);
  const auto all = take_all();
  EXPECT_EQ(all.size(), 512u);
  EXPECT_EQ(all.back(), 10'000);
  EXPECT_EQ(gone.size() + all.size(), 10'000u);
}

TEST_F(MailboxTest, IsBoundedInBytes) {
  for (std::uint64_t key = 0; key < 10; ++key) put(1, key, 1 << 18);
  EXPECT_EQ(take_all(), (std::vector<int>{7, 8, 9, 10}));  // 1 MiB
  put(1, 0, 8 << 20);                                      // one sample always has a place
  EXPECT_EQ(take_all(), std::vector<int>{11});
  for (std::uint64_t key = 0; key < 10; ++key) put(1, key, 1 << 18);
  EXPECT_EQ(take_all().size(), 4u) << "what was taken counts no more";
}

}  // namespace
}  // namespace adit::wire
