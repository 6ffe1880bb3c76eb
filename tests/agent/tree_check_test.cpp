// SPDX-License-Identifier: Apache-2.0
// What a user reads when a tree contradicts the mode table.
#include "robot_agent/behaviour/tree_check.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "robot_agent/behaviour/decider.hpp"
#include "tests/folders/folders.hpp"

namespace adit::agent {
namespace {

using testing::HasSubstr;

const std::string kShipped = source_folder() + "/config/trees/robot.xml";
const std::string kByConditions = source_folder() + "/tests/agent/robot_by_conditions.xml";

/// A tree, one place changed.
std::string changed(const std::string& from, const std::string& to, const std::string& tree = kByConditions) {
  std::ifstream file(tree);
  std::stringstream text;
  text << file.rdbuf();
  std::string xml = text.str();
  const std::size_t at = xml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return xml.replace(at, from.size(), to);
}

/// Where `text` is in that tree, as complaints name it.
std::string line_of(const std::string& xml, const std::string& text) {
  const std::size_t at = xml.find(text);
  EXPECT_NE(at, std::string::npos) << text;
  return std::to_string(1 + std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

std::string complaint(const std::string& xml) {
  const auto decider = Decider::load_text(xml);
  EXPECT_FALSE(decider);
  if (decider) return {};
  EXPECT_EQ(decider.reason(), Reason::tree_refused);
  return decider.error().text;
}

TEST(TreeCheck, TheShippedTreeAgrees) {
  for (const std::string& tree : {kShipped, kByConditions}) {
    const auto checked = check_tree(tree);
    EXPECT_TRUE(checked) << checked.error().text;
  }
}

TEST(TreeCheck, ModeEvaluatesItsConditionsItselfAndMayBeAnywhere) {
  const std::string leaf = "<Mode mode=\"waypoint\"/>";
  for (const std::string& form :
       {"<Inverter><Inverter>" + leaf + "</Inverter></Inverter>", "<Sequence>" + leaf + "</Sequence>",
        "<ReactiveSequence><MapFresh/>" + leaf + "</ReactiveSequence>"}) {
    const auto decider = Decider::load_text(changed(leaf, form, kShipped));
    ASSERT_TRUE(decider) << form << ": " << decider.error().text;
    EXPECT_TRUE((*decider)->installed(*ModeTable::shipped().find("waypoint")));
  }
}

TEST(TreeCheck, ModeIsNoConditionOfARun) {
  const std::string leaf = "<Mode mode=\"waypoint\"/>", run = "<Run mode=\"waypoint\"/>";
  EXPECT_THAT(complaint(changed(leaf, "<ReactiveSequence>" + leaf + run + "</ReactiveSequence>", kShipped)),
              HasSubstr("Run mode=\"waypoint\" lacks the condition Requested mode=\"waypoint\" before it"));
}

TEST(TreeCheck, HoldNeedsARunBecauseNobodyRequestsAFallback) {
  EXPECT_THAT(complaint(changed("<Run name=\"hold\" mode=\"hold\"/>", "<Mode mode=\"hold\"/>", kShipped)),
              HasSubstr("the tree has no Run for mode hold"));
}

TEST(TreeCheck, MissingConditionIsNamedWithTheLineOfItsRun) {
  std::string xml = changed("      <NotStopped/>\n", "");
  EXPECT_EQ(complaint(xml), "<text>:" + line_of(xml, "<Run mode=\"manual\"/>") +
                                ": Run mode=\"manual\" lacks the condition NotStopped before it");
  xml = changed("      <Requested mode=\"waypoint\"/>\n", "");
  EXPECT_EQ(complaint(xml),
            "<text>:" + line_of(xml, "<Run mode=\"waypoint\"/>") +
                ": Run mode=\"waypoint\" lacks the condition Requested mode=\"waypoint\" before it");
}

TEST(TreeCheck, ConditionThatDoesNotCountIsExplained) {
  const std::string xml = changed("<NotStopped/>", "<Inverter><NotStopped/></Inverter>");
  EXPECT_EQ(complaint(xml), "<text>:" + line_of(xml, "<Run mode=\"manual\"/>") +
                                ": Run mode=\"manual\" lacks the condition NotStopped: the one in line " +
                                line_of(xml, "<NotStopped/>") +
                                " does not count, it is under Inverter; use ReactiveSequence");
  EXPECT_THAT(complaint(changed("<StickKept/>", "<ForceSuccess><StickKept/></ForceSuccess>")),
              HasSubstr("it is under ForceSuccess"));
  EXPECT_THAT(complaint(changed("<StickKept/>", "<StickKept _skipIf=\"true\"/>")),
              HasSubstr("_skipIf, _successIf or _while may pass over StickKept"));
  EXPECT_THAT(
      complaint(changed("<StickKept/>", "<ReactiveFallback><StickKept/><AlwaysSuccess/></ReactiveFallback>")),
      HasSubstr("ReactiveFallback does without it"));
  EXPECT_THAT(complaint(changed("<StickKept/>", "<Sequence><StickKept/></Sequence>")),
              HasSubstr("it is under Sequence"));
}

TEST(TreeCheck, NodeThatRemembersAboveTheConditionsIsNamed) {
  std::string xml = changed("<ReactiveSequence>", "<Sequence>");
  xml.replace(xml.find("</ReactiveSequence>"), 19, "</Sequence>");
  EXPECT_THAT(complaint(xml), HasSubstr("it is under Sequence; use ReactiveSequence"));
}

TEST(TreeCheck, ConditionsMayStandInOtherPlacesOfAReactiveSequence) {
  // In a sequence of their own, in a subtree, and in every branch of a fallback.
  for (const char* form :
       {"<ReactiveSequence><NotStopped/></ReactiveSequence>", "<SubTree ID=\"Conditions\"/>",
        "<ReactiveFallback><NotStopped/><ReactiveSequence><NotStopped/><DriverAlive/>"
        "</ReactiveSequence></ReactiveFallback>"}) {
    std::string xml = changed("<NotStopped/>", form);
    xml.insert(xml.find("  <TreeNodesModel>"),
               "<BehaviorTree ID=\"Conditions\"><NotStopped/></BehaviorTree>\n");
    const auto decider = Decider::load_text(xml);
    EXPECT_TRUE(decider) << form << ": " << decider.error().text;
  }
}

TEST(TreeCheck, UnknownModesAreNamed) {
  const std::string xml = changed("<Run mode=\"manual\"/>", "<Run mode=\"fly\"/>");
  EXPECT_EQ(complaint(xml),
            "<text>:" + line_of(xml, "<Run mode=\"fly\"/>") + ": Run: the mode table has no mode 'fly'");
  EXPECT_THAT(complaint(changed("<Requested mode=\"manual\"/>", "<Requested mode=\"fly\"/>")),
              HasSubstr("Requested: the mode table has no mode 'fly'"));
  EXPECT_THAT(complaint(changed("<Pause mode=\"waypoint\"/>", "<Pause mode=\"{mode}\"/>")),
              HasSubstr("Pause: the mode table has no mode '{mode}'"));
  EXPECT_THAT(complaint(changed("<Mode mode=\"manual\"/>", "<Mode mode=\"{mode}\"/>", kShipped)),
              HasSubstr("Mode: the mode table has no mode '{mode}'"));
}

TEST(TreeCheck, ModesThatFallToHoldCannotPause) {
  EXPECT_THAT(complaint(changed("<Run mode=\"manual\"/>",
                                "<ReactiveFallback><Run mode=\"manual\"/><Pause mode=\"manual\"/>"
                                "</ReactiveFallback>")),
              HasSubstr("manual cannot pause: it falls to hold"));
}

TEST(TreeCheck, EveryModeThatIsNotOptionalNeedsARun) {
  EXPECT_THAT(complaint(changed("<SubTree ID=\"Manual\" name=\"manual\"/>", "")),
              HasSubstr("the tree has no Run for mode manual"));
  EXPECT_THAT(complaint(changed("<Mode mode=\"manual\"/>", "", kShipped)),
              HasSubstr("the tree has no Run for mode manual"));
  EXPECT_TRUE(Decider::load_text(changed("<SubTree ID=\"External\" name=\"external\"/>", "")));
}

TEST(TreeCheck, FilesThatCannotBeReadAreErrorsOfTheLoader) {
  EXPECT_EQ(check_tree("/nowhere/robot.xml").reason(), Reason::cannot_read);
}

}  // namespace
}  // namespace adit::agent
