// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

namespace {

/// The value of a script as text, or "error".
std::string run(const std::string& text, Blackboard& board) {
  const auto script = Script::parse(text);
  if (!script) return "syntax";
  try {
    const BlackboardValue v = (*script)->run(board, {{"RED", 3}});
    return std::holds_alternative<double>(v) &&
                   to_real(v) == static_cast<double>(static_cast<long>(to_real(v)))
               ? std::to_string(static_cast<long>(to_real(v)))
               : to_text(v);
  } catch (const NodeError&) {
    return "error";
  }
}
std::string run(const std::string& text) {
  Blackboard board;
  return run(text, board);
}

}  // namespace

TEST(Script, Arithmetic) {
  EXPECT_EQ(run("1 + 2 * 3 - 4"), "3");
  EXPECT_EQ(run("(1 + 2) * -3"), "-9");
  EXPECT_EQ(run("7 / 2"), "3.500000");
  EXPECT_EQ(run("0x1F & 6 | 8"), "14");
  EXPECT_EQ(run("1.5e1 + .5"), "syntax");
  EXPECT_EQ(run("1.5e1 - 5"), "10");
}

TEST(Script, ComparisonsAndLogic) {
  EXPECT_EQ(run("1 < 2 && 2 <= 2"), "1");
  EXPECT_EQ(run("1 < 2 < 2"), "0");
  EXPECT_EQ(run("!(1 == 2) || false"), "1");
  EXPECT_EQ(run("'abc' == \"abc\""), "1");
  EXPECT_EQ(run("'2' == 2"), "1");
  EXPECT_EQ(run("'x' == 2"), "error");
  EXPECT_EQ(run("RED == 3 ? 'yes' : 'no'"), "yes");
  EXPECT_EQ(run("2 && 1"), "error") << "an integer is true or false only if it is 1 or 0";
}

TEST(Script, TextsAreJoined) {
  EXPECT_EQ(run("'a' + 'b'"), "ab");
  EXPECT_EQ(run("'n' .. 1"), "n1");
  EXPECT_EQ(run("'a' * 2"), "error");
}

TEST(Script, AssignmentsCreateOnlyWithColon) {
  Blackboard board;
  EXPECT_EQ(run("x = 1", board), "error");
  EXPECT_EQ(run("x := 1; x += 2; x *= 4", board), "12");
  EXPECT_EQ(run("x -= 2; x /= 5; x", board), "2");
  EXPECT_EQ(run("x = 'text'", board), "error") << "a number stays a number";
  EXPECT_EQ(run("x = '8'", board), "8");
  EXPECT_EQ(run("y := 1; y += 0.5", board), "error") << "an integer stays an integer";
  EXPECT_EQ(run("missing + 1", board), "error");
}

TEST(Script, MistakesAreFoundWhenParsed) {
  for (const char* text : {"", "1 +", "(1", "a b", "'open", "3foo", "1..", "a := ", "? 1 : 2", "1 ? 2", "#",
                           "99999999999999999999"}) {
    EXPECT_FALSE(Script::parse(text).ok()) << text;
  }
  const std::string deep = std::string(5000, '(') + "1" + std::string(5000, ')');
  EXPECT_FALSE(Script::parse(deep).ok());
  std::string endless = "1";
  for (int i = 0; i < 5000; ++i) endless += "+1";
  EXPECT_FALSE(Script::parse(endless).ok());
}

TEST(ScriptNode, RunsOnItsBlackboard) {
  Dry dry(R"(<Sequence><Script code="a := 1; b := a + 1"/><ScriptCondition code="b == 2"/></Sequence>)");
  EXPECT_EQ(dry.tick(), "S");
  Dry no(R"(<Sequence><Script code="a := 1"/><ScriptCondition code="a == 2"/></Sequence>)");
  EXPECT_EQ(no.tick(), "F");
}

TEST(ScriptNode, AnErrorIsAFailureOfTheNodeAndReported) {
  Dry dry(R"(<Fallback><Script code="a = 1"/><A/></Fallback>)", {{"A", "S"}});
  EXPECT_EQ(dry.tick(), "S A");
  ASSERT_EQ(dry.errors.size(), 1u);
  EXPECT_NE(dry.errors[0].find("'a'"), std::string::npos);
}

}  // namespace adit::bt::test
