// SPDX-License-Identifier: Apache-2.0
// The program `tree`, as a user runs it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/folders/folders.hpp"

namespace {

namespace fs = std::filesystem;

struct Answer {
  int status{-1};
  std::string out{};  ///< Standard output and standard error.
};

class Tool : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name) << content;
  }
  Answer tree(const std::string& arguments) {
    const std::string command =
        "cd '" + folder_.string() + "' && '" + adit::program_folder() + "/tree' " + arguments + " 2>&1";
    Answer answer;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (pipe && std::fgets(buffer.data(), buffer.size(), pipe)) answer.out += buffer.data();
    const int raw = pipe ? pclose(pipe) : -1;
    answer.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
    return answer;
  }
  fs::path folder_{adit::scratch_folder()};
};

constexpr const char* kTree = R"(<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <ReactiveSequence name="root">
      <Ready/>
      <Sequence name="work"><Drive name="drive"/><Look/><AlwaysSuccess name="yes"/></Sequence>
    </ReactiveSequence>
  </BehaviorTree>
</root>)";

}  // namespace

TEST_F(Tool, RunPrintsOneJsonLineATick) {
  write("t.xml", kTree);
  write("l.yaml",
        "Ready: [SUCCESS, SUCCESS, FAILURE, SUCCESS]\ndrive: [RUNNING, RUNNING, RUNNING, SUCCESS]\n");
  const auto answer = tree("run t.xml --leaves l.yaml --ticks 5 --json");
  EXPECT_EQ(answer.status, 0);
  EXPECT_EQ(
      answer.out,
      R"({"tick":1,"status":"RUNNING","ticked":["Ready","drive"],"halted":[],"nodes":{"root":"RUNNING","work":"RUNNING","drive":"RUNNING"}}
{"tick":2,"status":"RUNNING","ticked":["Ready","drive"],"halted":[],"nodes":{"root":"RUNNING","work":"RUNNING","drive":"RUNNING"}}
{"tick":3,"status":"FAILURE","ticked":["Ready"],"halted":["drive"],"nodes":{}}
{"tick":4,"status":"RUNNING","ticked":["Ready","drive"],"halted":[],"nodes":{"root":"RUNNING","work":"RUNNING","drive":"RUNNING"}}
{"tick":5,"status":"SUCCESS","ticked":["Ready","drive"],"halted":[],"nodes":{}}
)");
}

TEST_F(Tool, LeavesAreFoundByIdTooAndTimeIsVirtual) {
  write(
      "t.xml",
      R"(<root><BehaviorTree ID="M"><Timeout msec="150" name="t"><Drive name="d"/></Timeout></BehaviorTree></root>)");
  write("l.yaml", "Drive: [RUNNING]\n");
  const auto answer = tree("run t.xml --leaves l.yaml --ticks 3 --tick-ms 100 --json");
  EXPECT_NE(answer.out.find(R"({"tick":3,"status":"FAILURE","ticked":[],"halted":["d"],"nodes":{}})"),
            std::string::npos)
      << answer.out;
}

TEST_F(Tool, LeavesThatAreNotScriptedSucceedAndAreNotListed) {
  write("t.xml", kTree);
  const auto answer = tree("run t.xml --ticks 1 --json");
  EXPECT_EQ(answer.out, "{\"tick\":1,\"status\":\"SUCCESS\",\"ticked\":[],\"halted\":[],\"nodes\":{}}\n");
}

TEST_F(Tool, RunWithoutJsonIsForPeople) {
  write("t.xml", kTree);
  write("l.yaml", "Ready: [FAILURE]\n");
  EXPECT_EQ(tree("run t.xml --leaves l.yaml --ticks 1").out, "tick 1  FAILURE  ticked: Ready  nodes: {}\n");
}

TEST_F(Tool, AFailingNodeIsReportedAndTheRunGoesOn) {
  write("t.xml", "<root><BehaviorTree ID=\"M\">\n<Script code=\"a = 1\"/></BehaviorTree></root>");
  const auto answer = tree("run t.xml --ticks 2 --json");
  EXPECT_EQ(answer.status, 0);
  EXPECT_NE(answer.out.find("tree: tick 1: t.xml:2: 'Script': no blackboard entry 'a'"), std::string::npos)
      << answer.out;
  EXPECT_NE(answer.out.find("\"tick\":2,\"status\":\"FAILURE\""), std::string::npos);
}

TEST_F(Tool, CheckNamesFileAndLine) {
  write("t.xml", kTree);
  EXPECT_EQ(tree("check t.xml").out, "t.xml: ok, Main\n");
  write("bad.xml", "<root>\n<BehaviorTree ID=\"M\">\n<Inverter/></BehaviorTree></root>");
  const auto answer = tree("check bad.xml");
  EXPECT_EQ(answer.status, 1);
  EXPECT_EQ(answer.out, "tree: bad.xml:3: 'Inverter' must have exactly 1 child, it has 0\n");
  EXPECT_EQ(tree("check none.xml").out, "tree: none.xml: no such file\n");
  EXPECT_EQ(tree("check .").status, 1);
}

TEST_F(Tool, CheckBuildsEveryTreeOfTheFile) {
  write("t.xml",
        "<root main_tree_to_execute=\"A\"><BehaviorTree ID=\"A\"><X/></BehaviorTree>\n<BehaviorTree "
        "ID=\"B\"><SubTree ID=\"C\"/></BehaviorTree></root>");
  EXPECT_EQ(tree("check t.xml").out, "tree: t.xml:2: no tree with ID 'C'\n");
  EXPECT_EQ(tree("run t.xml --ticks 1").status, 0);
}

TEST_F(Tool, CheckAsksARobotsTreeAgainstTheModeTable) {
  const std::string folder = adit::source_folder() + "/tests/rehearsal/hostile_trees/";
  const auto stop = tree("check " + folder + "without_not_stopped.xml");
  EXPECT_EQ(stop.status, 1);
  EXPECT_EQ(stop.out,
            "tree: " + folder +
                "without_not_stopped.xml:19: Run mode=\"manual\" lacks the condition NotStopped before "
                "it\n");
  write("fly.xml", "<root><BehaviorTree ID=\"M\">\n<Run mode=\"fly\"/></BehaviorTree></root>");
  EXPECT_EQ(tree("check fly.xml").out, "tree: fly.xml:2: Run: the mode table has no mode 'fly'\n");
  for (const char* valid : {"/config/trees/robot.xml", "/tests/agent/robot_by_conditions.xml"})
    EXPECT_EQ(tree("check " + adit::source_folder() + valid).status, 0) << valid;
  write("hover.xml", "<root><BehaviorTree ID=\"M\">\n<Mode mode=\"hover\"/></BehaviorTree></root>");
  EXPECT_EQ(tree("check hover.xml").out, "tree: hover.xml:2: Mode: the mode table has no mode 'hover'\n");
  // A robot's tree with a leaf that the robot does not know.
  write("dance.xml",
        "<root><BehaviorTree ID=\"M\"><Sequence>\n<NotStopped/>\n<Dance/></Sequence></BehaviorTree></root>");
  EXPECT_EQ(tree("check dance.xml").out.rfind("tree: dance.xml:3: ", 0), 0u);
}

TEST_F(Tool, WrongLeavesAreErrorsWithTheirLine) {
  write("t.xml", kTree);
  const auto run = [&](const std::string& yaml) {
    write("l.yaml", yaml);
    const auto answer = tree("run t.xml --leaves l.yaml");
    EXPECT_EQ(answer.status, 1) << yaml;
    return answer.out;
  };
  EXPECT_EQ(run("A: [SUCCESS]\nB: [DONE]\n"),
            "tree: l.yaml:2: leaf 'B': expected RUNNING, SUCCESS, FAILURE or SKIPPED\n");
  EXPECT_EQ(run("A: SUCCESS\n"), "tree: l.yaml:1: leaf 'A' needs a list such as [RUNNING, SUCCESS]\n");
  EXPECT_EQ(run("A: []\n"), "tree: l.yaml:1: leaf 'A' needs a list such as [RUNNING, SUCCESS]\n");
  EXPECT_EQ(run("A: [SUCCESS]\nA: [FAILURE]\n"), "tree: l.yaml:2: leaf 'A' is there twice\n");
  EXPECT_EQ(run("- A\n"), "tree: l.yaml:1: expected 'Name: [RUNNING, SUCCESS]' lines\n");
  EXPECT_NE(run("A: [SUCCESS\n").find("not well-formed YAML"), std::string::npos);
  EXPECT_EQ(tree("run t.xml --leaves gone.yaml").out, "tree: gone.yaml: cannot be read\n");
}

TEST_F(Tool, DrawsTextAndDot) {
  write("t.xml", kTree);
  EXPECT_NE(tree("draw t.xml").out.find("└─ Sequence \"work\""), std::string::npos);
  EXPECT_EQ(tree("draw t.xml --dot").out.rfind("digraph", 0), 0u);
}

TEST_F(Tool, WrongUsageIsTwoAndHelpHasExamples) {
  EXPECT_EQ(tree("").status, 2);
  EXPECT_EQ(tree("run").status, 2);
  EXPECT_EQ(tree("run t.xml --ticks 0").status, 2);
  EXPECT_EQ(tree("fell t.xml").status, 2);
  const auto help = tree("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.out.find("tree run config/trees/robot.xml --leaves leaves.yaml"), std::string::npos);
}
