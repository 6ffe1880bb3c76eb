// SPDX-License-Identifier: Apache-2.0
// Broken files of every kind: an error or a tree that can be ticked, never a crash.
#include "core/time/random.hpp"
#include "tests/bt/errors.hpp"

namespace adit::bt::test {

namespace {

const std::string kSeed = R"(<?xml version="1.0"?>
<root BTCPP_format="4" main_tree_to_execute="Main">
  <!-- everything once -->
  <BehaviorTree ID="Main">
    <ReactiveSequence name="root" _while="true">
      <Fallback><A name="a"/><Inverter><B p="{q}"/></Inverter></Fallback>
      <Parallel success_count="-1" failure_count="2"><Timeout msec="20"><C/></Timeout><Sleep msec="5"/></Parallel>
      <Switch2 variable="{v}" case_1="1" case_2="x"><A/><B/><C/></Switch2>
      <SubTree ID="Sub" in="{x}" k="5" _autoremap="1"/>
      <Script code="n := (1 + 2) * 3; t := 'abc' .. n"/>
      <Repeat num_cycles="2"><IfThenElse><A/><B _skipIf="n &lt; 3"/></IfThenElse></Repeat>
    </ReactiveSequence>
  </BehaviorTree>
  <BehaviorTree ID="Sub">
    <SequenceWithMemory><SetBlackboard value="{in}" output_key="out"/><Delay delay_msec="1"><AlwaysSuccess/></Delay></SequenceWithMemory>
  </BehaviorTree>
  <TreeNodesModel><SubTree ID="Sub"><input_port name="in"/></SubTree></TreeNodesModel>
</root>)";

void try_it(const std::string& text) {
  auto tree = load_tree_text(tolerant(), text, "fuzz.xml");
  if (!tree) {
    EXPECT_FALSE(tree.error().text.empty());
    EXPECT_EQ(tree.error().text.rfind("fuzz.xml", 0), 0u) << tree.error().text;
    return;
  }
  Time now{};
  for (int i = 0; i < 5; ++i) tree->tick(now += std::chrono::milliseconds(10));
  tree->halt();
}

}  // namespace

TEST(Garbage, TheSeedItselfLoads) {
  const auto tree = load_tree_text(tolerant(), kSeed);
  EXPECT_TRUE(tree.ok()) << tree.error().text;
}

TEST(Garbage, EveryPrefix) {
  for (std::size_t length = 0; length < kSeed.size(); length += 3) try_it(kSeed.substr(0, length));
}

TEST(Garbage, BytesChangedMovedAndRepeated) {
  Random random(1);
  for (int round = 0; round < 3000; ++round) {
    std::string text = kSeed;
    const auto edits = 1 + random.below(4);
    for (std::uint64_t i = 0; i < edits; ++i) {
      const auto at = random.below(text.size());
      const auto length = std::min<std::size_t>(random.below(60), text.size() - at);
      switch (random.below(4)) {
        case 0:
          text[at] = static_cast<char>(random.below(256));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(random.below(text.size()), text.substr(at, length));
          break;
        default:
          text.insert(at, 1, "<>/\"'&={}!-"[random.below(11)]);
          break;
      }
    }
    try_it(text);
  }
}

TEST(Garbage, WordsExchanged) {
  const std::vector<std::string> words{
      "Sequence", "Sub",      "Main", "Inverter", "Switch2",        "SubTree", "Repeat", "name", "{q}",
      "-1",       "Parallel", "msec", "\"\"",     "99999999999999", "ID",      "Action", "root"};
  Random random(2);
  for (int round = 0; round < 2000; ++round) {
    std::string text = kSeed;
    for (int i = 0; i < 3; ++i) {
      const auto& from = words[random.below(words.size())];
      const auto at = text.find(from, random.below(text.size()));
      if (at != std::string::npos) text.replace(at, from.size(), words[random.below(words.size())]);
    }
    try_it(text);
  }
}

TEST(Garbage, Scripts) {
  Random random(3);
  const std::string letters = "ab01.'\"()+-*/&|^~!<>=?:; @x";
  for (int round = 0; round < 5000; ++round) {
    std::string text;
    for (auto n = random.below(25); n > 0; --n) text += letters[random.below(letters.size())];
    const auto script = Script::parse(text);
    if (!script) continue;
    Blackboard board;
    try {
      (*script)->run(board, {});
    } catch (const NodeError&) {
      SUCCEED();
    }
  }
}

}  // namespace adit::bt::test
