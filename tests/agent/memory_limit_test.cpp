// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/memory_limit.hpp"

#include <gmock/gmock.h>
#include <sys/mman.h>

#include <cstdlib>
#include <cstring>

namespace adit::agent {
namespace {

using testing::HasSubstr;

TEST(DataLimit, UnusedReservedMemoryDoesNotCount) {
  const auto limit = data_limit(60.0, {.touched = 20.0, .reserved = 150.0});
  ASSERT_TRUE(limit) << limit.error().text;
  EXPECT_DOUBLE_EQ(*limit, 190.0);  // 40 MB more than now
}

TEST(DataLimit, TooLittleNamesTheMinimumThatWorks) {
  const auto limit = data_limit(25.0, {.touched = 20.2, .reserved = 150.0});
  ASSERT_EQ(limit.reason(), Reason::out_of_range);
  EXPECT_THAT(limit.error().text, HasSubstr("25 MB is too little, 21 MB are in use"));
  EXPECT_THAT(limit.error().text, HasSubstr("at least 45"));
  EXPECT_TRUE(data_limit(45.0, {.touched = 20.2, .reserved = 150.0}));
  EXPECT_TRUE(data_limit(45.0, {.touched = 30.0, .reserved = 150.0})) << "another start that took more";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr std::size_t kMegabyte = 1024 * 1024;

void* reserve(std::size_t megabytes) {
  return ::mmap(nullptr, megabytes * kMegabyte, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

/// In a process of its own, which the limit binds for good. 0: as it should be.
[[noreturn]] void within_the_limit() {
  if (reserve(200) == MAP_FAILED) std::_Exit(10);  // as the stacks of many threads
  const auto before = memory_use();
  if (!before || before->reserved < 200.0 || before->touched > 150.0) std::_Exit(11);
  if (!limit_memory(before->touched + 40.0)) std::_Exit(12);
  void* fits = reserve(20);
  if (fits == MAP_FAILED) std::_Exit(13);
  std::memset(fits, 1, 20 * kMegabyte);
  if (reserve(30) != MAP_FAILED) std::_Exit(14);
  std::_Exit(0);
}

TEST(MemoryLimit, AllocationsBeyondTheLimitFail) {
  EXPECT_EXIT(within_the_limit(), testing::ExitedWithCode(0), "");
}

TEST(MemoryLimit, NoneIsSetForZero) {
  EXPECT_TRUE(limit_memory(0.0));
  EXPECT_EQ(limit_memory(1.0).reason(), Reason::out_of_range);
}
#endif

}  // namespace
}  // namespace adit::agent
