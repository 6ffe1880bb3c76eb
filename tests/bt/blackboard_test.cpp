// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(Blackboard, KeepsWhatWasPutAndConvertsTexts) {
  Blackboard board;
  ASSERT_TRUE(board.put("n", 3));
  ASSERT_TRUE(board.put("t", std::string("2.5")));
  EXPECT_EQ(board.get<int>("n").value(), 3);
  EXPECT_EQ(board.get<std::string>("n").value(), "3");
  EXPECT_EQ(board.get<double>("t").value(), 2.5);
  EXPECT_EQ(board.get<int>("t").reason(), Reason::wrong_type);
  EXPECT_EQ(board.get<int>("missing").reason(), Reason::missing_key);
}

TEST(Blackboard, KeepsAnyTypeForLeaves) {
  struct Goal {
    double x, y;
  };
  Blackboard board;
  ASSERT_TRUE(board.put("goal", Goal{1, 2}));
  EXPECT_EQ(board.get<Goal>("goal").value().y, 2);
  EXPECT_EQ(board.get<int>("goal").reason(), Reason::wrong_type);
}

TEST(Blackboard, IntegersAreNotCutInSilence) {
  Blackboard board;
  ASSERT_TRUE(board.put("x", 1.5));
  EXPECT_EQ(board.get<int>("x").reason(), Reason::wrong_type);
  ASSERT_TRUE(board.put("big", std::int64_t{300}));
  EXPECT_EQ(board.get<std::uint8_t>("big").reason(), Reason::wrong_type);
}

TEST(Blackboard, BooleansListsAndStatuses) {
  EXPECT_TRUE(value_as<bool>(BlackboardValue(std::string("true"))));
  EXPECT_FALSE(value_as<bool>(BlackboardValue(std::string("0"))));
  EXPECT_THROW(value_as<bool>(BlackboardValue(std::string("maybe"))), NodeError);
  EXPECT_EQ(value_as<std::vector<double>>(BlackboardValue(std::string("1;2.5;-3"))),
            (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(value_as<NodeStatus>(BlackboardValue(std::string("SKIPPED"))), NodeStatus::skipped);
  EXPECT_THROW(value_as<NodeStatus>(BlackboardValue(std::string("skipped"))), NodeError);
}

TEST(SetBlackboard, WritesTextsAndCopiesEntries) {
  Dry dry(
      R"(<Sequence><SetBlackboard value="42" output_key="a"/><SetBlackboard value="{a}" output_key="b"/></Sequence>)");
  EXPECT_EQ(dry.tick(), "S");
  EXPECT_EQ(dry.tree.blackboard().get<int>("b").value(), 42);
}

TEST(SetBlackboard, KeepsTheTypeOfANumber) {
  Dry dry(
      R"(<Sequence><Script code="n := 1"/><SetBlackboard value="7" output_key="n"/><Script code="n += 1"/></Sequence>)");
  EXPECT_EQ(dry.tick(), "S");
  EXPECT_EQ(dry.tree.blackboard().get<int>("n").value(), 8);
  Dry wrong(R"(<Sequence><Script code="n := 1"/><SetBlackboard value="x" output_key="n"/></Sequence>)");
  EXPECT_EQ(wrong.tick(), "F");
  EXPECT_EQ(wrong.errors.size(), 1u);
}

TEST(SetBlackboard, AMissingSourceFailsAndIsReported) {
  Dry dry(R"(<SetBlackboard value="{nothing}" output_key="b"/>)");
  EXPECT_EQ(dry.tick(), "F");
}

TEST(UnsetBlackboard, RemovesTheEntry) {
  Dry dry(R"(<Sequence><SetBlackboard value="1" output_key="a"/><UnsetBlackboard key="a"/></Sequence>)");
  EXPECT_EQ(dry.tick(), "S");
  EXPECT_EQ(dry.tree.blackboard().find("a"), nullptr);
}

}  // namespace adit::bt::test
