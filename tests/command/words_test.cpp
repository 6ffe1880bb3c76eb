// SPDX-License-Identifier: Apache-2.0
#include "core/command/words.hpp"

#include <gmock/gmock.h>

namespace adit::command {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Words, SplitsAtBlanks) {
  EXPECT_THAT(*split_words("  take\tr1   r2 \n"), ElementsAre("take", "r1", "r2"));
  EXPECT_THAT(*split_words(""), IsEmpty());
}

TEST(Words, QuotesKeepBlanksAndEmptyWords) {
  EXPECT_THAT(*split_words(R"(run "my file.yaml" 'a "b"' "" c\ d)"),
              ElementsAre("run", "my file.yaml", "a \"b\"", "", "c d"));
  EXPECT_THAT(*split_words(R"(a"b c"d "e\"f" 'g\h')"), ElementsAre("ab cd", "e\"f", "g\\h"));
}

TEST(Words, RefusesWhatDoesNotEnd) {
  EXPECT_EQ(split_words("take \"r1").reason(), Reason::syntax);
  EXPECT_EQ(split_words("take 'r1").reason(), Reason::syntax);
  EXPECT_EQ(split_words("take r1\\").reason(), Reason::syntax);
}

TEST(Words, RefusesControlCharactersAndEndlessLines) {
  EXPECT_EQ(split_words("take r1\x1b[2J").reason(), Reason::syntax);
  EXPECT_EQ(split_words(std::string("a\0b", 3)).reason(), Reason::syntax);
  EXPECT_EQ(split_words(std::string(5000, 'a')).reason(), Reason::syntax);
}

TEST(Words, NearestFindsTyposOnly) {
  const std::vector<std::string> names{"take", "release", "lock", "unlock", "stop", "status"};
  EXPECT_EQ(nearest("tkae", names), "take");
  EXPECT_EQ(nearest("stpo", names), "stop");
  EXPECT_EQ(nearest("relase", names), "release");
  EXPECT_EQ(nearest("stat", names), "status");
  EXPECT_EQ(nearest("photograph", names), "");
  EXPECT_EQ(nearest("foo", {"goto", "home"}), "") << "two letters of three are no typing error";
  EXPECT_EQ(nearest("lick", names), "lock");
  EXPECT_EQ(nearest("lik", names), "");
  EXPECT_EQ(nearest("", names), "");
}

TEST(Words, NamesThatTravel) {
  EXPECT_TRUE(valid_name("op_1-B"));
  EXPECT_TRUE(valid_name(std::string(32, 'a')));
  EXPECT_FALSE(valid_name(std::string(33, 'a')));
  EXPECT_FALSE(valid_name(""));
  EXPECT_FALSE(valid_name("a b"));
  EXPECT_FALSE(valid_name("r\xc3\xa9"));
}

TEST(Words, RobotNamesAreNoOtherWordsOfACommand) {
  EXPECT_TRUE(valid_name("all") && valid_name("-r1")) << "a station may have such a name";
  for (const char* name : {"all", "-r1", "--override", "", "r 1"})
    EXPECT_FALSE(valid_robot_name(name)) << name;
  for (const char* name : {"r1", "r-1", "all1"}) EXPECT_TRUE(valid_robot_name(name)) << name;
}

TEST(Words, CleanKeepsTheTerminalSafe) {
  EXPECT_EQ(clean("a\x1b[31mb\n\x7f\xff", 40), "a?[31mb???");
  EXPECT_EQ(clean("abcdef", 3), "abc");
}

}  // namespace
}  // namespace adit::command
