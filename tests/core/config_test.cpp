// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>

#include "core/config/node.hpp"

namespace adit::config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Reads one document with `read` and gives the error's text, "" when there is none.
template <class F>
std::string error_of(const std::string& yaml, F read, Reason* reason = nullptr) {
  auto root = parse(yaml, "f.yaml");
  Result<void> done = root ? (read(*root), root->finish()) : Result<void>(root.error());
  if (reason) *reason = done ? Reason::none : done.error().reason;
  return done ? "" : done.error().text;
}

TEST(ConfigNode, reads_what_is_there_and_fallbacks) {
  auto root = parse(
      "speed: 2.5\ncount: -3\non: true\nname: r1\nquoted: \"7\"\npose: [1, 0, 0.5]\nwords: [a, b]\n"
      "words_of_yaml: {a: yes, b: no}\nnested: {kind: b}\nlist:\n  - {x: 1}\n  - {x: 2}\n",
      "f.yaml");
  ASSERT_TRUE(root);
  EXPECT_EQ(root->number("speed", positive_up_to(10)), 2.5);
  EXPECT_EQ(root->integer("count", -5, 5), -3);
  EXPECT_TRUE(root->flag("on"));
  EXPECT_TRUE(root->child("words_of_yaml").flag("a"));
  EXPECT_FALSE(root->child("words_of_yaml").flag("b"));
  EXPECT_EQ(root->text("name"), "r1");
  EXPECT_EQ(root->text("quoted"), "7");
  EXPECT_THAT(root->numbers("pose", 3, 3), ElementsAre(1, 0, 0.5));
  EXPECT_THAT(root->texts("words"), ElementsAre("a", "b"));
  EXPECT_EQ(root->child("nested").choice("kind", {"a", "b"}), 1u);
  double sum = 0;
  for (const Node& item : root->list("list")) sum += item.number("x");
  EXPECT_EQ(sum, 3);
  EXPECT_EQ(root->number("absent", any_number(), 4.0), 4.0);
  EXPECT_EQ(root->text("absent_text", "z"), "z");
  EXPECT_FALSE(root->child_if("gone").present());
  EXPECT_EQ(root->child_if("gone").number("whatever", within(1, 2)), 2.0);
  EXPECT_TRUE(root->list_if("none").empty());
  const auto done = root->finish();
  EXPECT_TRUE(done) << done.error().text;
}

TEST(ConfigNode, an_unknown_key_is_an_error_with_a_suggestion) {
  Reason reason{};
  const auto read = [](const Node& n) {
    n.number("speed", any_number());
    n.number("turn", any_number(), 1.0);
  };
  EXPECT_EQ(error_of("turn: 1\nsped: 2\n", read, &reason),
            "f.yaml:2: unknown key 'sped', did you mean 'speed'?");
  EXPECT_EQ(reason, Reason::unknown_key);
  EXPECT_EQ(error_of("speed: 1\nzebra: 2\n", read),
            "f.yaml:2: unknown key 'zebra'; expected one of speed, turn");
}

TEST(ConfigNode, an_unknown_key_in_a_nested_mapping_or_list_is_found) {
  const auto read = [](const Node& n) {
    for (const Node& item : n.list("items")) item.number("x");
    n.child("sub").number("y");
  };
  EXPECT_EQ(error_of("items:\n  - {x: 1}\n  - {x: 1, q: 2}\nsub: {y: 1}\n", read),
            "f.yaml:3: unknown key 'q', did you mean 'x'?");
  EXPECT_THAT(error_of("items: []\nsub:\n  y: 1\n  other: 2\n", read),
              StartsWith("f.yaml:4: unknown key 'other'"));
}

TEST(ConfigNode, names_the_missing_key) {
  Reason reason{};
  EXPECT_EQ(error_of(
                "a: 1\n", [](const Node& n) { n.number("a"), n.text("name"); }, &reason),
            "f.yaml:1: key 'name' is missing");
  EXPECT_EQ(reason, Reason::missing_key);
}

struct Wrong {
  const char* yaml;
  const char* error;
  Reason reason;
};
class ConfigWrong : public testing::TestWithParam<Wrong> {};
TEST_P(ConfigWrong, names_file_line_key_and_expected_value) {
  Reason reason{};
  const std::string error = error_of(
      GetParam().yaml,
      [](const Node& n) {
        n.number("number", positive_up_to(10), 1);
        n.number("big", Range{1, std::numeric_limits<double>::max(), false}, 1);
        n.integer("whole", 1, 9, 1);
        n.flag("flag", false);
        n.text("text", "");
        n.choice("choice", {"lan", "wifi"}, 0);
        n.numbers("pose", 2, 3, within(-1, 1), {});
        n.texts("texts", {});
        n.list_if("list");
        n.child_if("sub").number("x", any_number(), 0);
      },
      &reason);
  EXPECT_EQ(error, GetParam().error);
  EXPECT_EQ(reason, GetParam().reason);
}
INSTANTIATE_TEST_SUITE_P(
    All, ConfigWrong,
    testing::Values(
        Wrong{"number: fast", "f.yaml:1: number: expected a number in (0, 10], got 'fast'",
              Reason::wrong_type},
        Wrong{"\nnumber: 0", "f.yaml:2: number: expected a number in (0, 10], got '0'", Reason::out_of_range},
        Wrong{"number: .nan", "f.yaml:1: number: expected a number in (0, 10], got '.nan'",
              Reason::wrong_type},
        Wrong{"number: 1e999", "f.yaml:1: number: expected a number in (0, 10], got '1e999'",
              Reason::wrong_type},
        Wrong{"number: \"3\"", "f.yaml:1: number: expected a number in (0, 10], got the text \"3\"",
              Reason::wrong_type},
        Wrong{"number: [1]", "f.yaml:1: number: expected a number in (0, 10], got a list of 1",
              Reason::wrong_type},
        Wrong{"big: 0", "f.yaml:1: big: expected a number of at least 1, got '0'", Reason::out_of_range},
        Wrong{"whole: 2.5", "f.yaml:1: whole: expected a whole number in [1, 9], got '2.5'",
              Reason::wrong_type},
        Wrong{"whole: 99999999999999999999",
              "f.yaml:1: whole: expected a whole number in [1, 9], got '99999999999999999999'",
              Reason::wrong_type},
        Wrong{"flag: maybe", "f.yaml:1: flag: expected true or false, got 'maybe'", Reason::wrong_type},
        Wrong{"flag: 'yes'", "f.yaml:1: flag: expected true or false, got the text \"yes\"",
              Reason::wrong_type},
        Wrong{"text: {a: 1}", "f.yaml:1: text: expected a text, got a mapping", Reason::wrong_type},
        Wrong{"choice: wify", "f.yaml:1: choice: expected one of lan, wifi; got 'wify', did you mean 'wifi'?",
              Reason::out_of_range},
        Wrong{"pose: [1]", "f.yaml:1: pose: expected a list of 2 to 3 numbers, got a list of 1",
              Reason::wrong_type},
        Wrong{"pose: [0, 2]", "f.yaml:1: pose: expected a number in [-1, 1], got '2'", Reason::out_of_range},
        Wrong{"texts: [[a]]", "f.yaml:1: texts: expected a text, got a list of 1", Reason::wrong_type},
        Wrong{"list: 5", "f.yaml:1: list: expected a list, got '5'", Reason::wrong_type},
        Wrong{"sub: 5", "f.yaml:1: sub: expected a mapping with keys, got '5'", Reason::wrong_type}));

TEST(ConfigNode, notes_errors_of_meaning_and_free_keys) {
  EXPECT_EQ(error_of("a: 1\nb: 2\n",
                     [](const Node& n) {
                       for (const auto& [key, value] : n.entries())
                         if (value.as_number() > 1) value.fail(Reason::bad_argument, "too many");
                     }),
            "f.yaml:2: b: too many");
}

TEST(ConfigParse, syntax_errors_name_the_line) {
  const auto none = [](const Node&) {};
  Reason reason{};
  EXPECT_THAT(error_of("a: 1\nb: [1, 2\n", none, &reason), StartsWith("f.yaml:"));
  EXPECT_EQ(reason, Reason::syntax);
  EXPECT_EQ(error_of("a: 1\nb: 2\na: 3\n", none), "f.yaml:3: key 'a' is given twice, first in line 1");
  EXPECT_THAT(error_of("", none), HasSubstr("empty"));
  EXPECT_THAT(error_of("a: 1\n---\nb: 2\n", none), HasSubstr("more than one document"));
  EXPECT_THAT(error_of("[a, b]: 1\n", none), HasSubstr("a key must be a word"));
  EXPECT_THAT(error_of("a: &x [*x]\n", none), HasSubstr("alias"));
}

TEST(ConfigParse, an_alias_repeats_a_value) {
  auto root = parse("a: &p {x: 3}\nb: *p\n", "f.yaml");
  ASSERT_TRUE(root);
  EXPECT_EQ(root->child("a").number("x"), 3);
  EXPECT_EQ(root->child("b").number("x"), 3);
  EXPECT_TRUE(root->finish());
}

TEST(ConfigParse, bombs_and_giants_are_refused) {
  const auto none = [](const Node&) {};
  EXPECT_THAT(error_of(std::string(2 << 20, ' '), none), HasSubstr("1 MiB"));
  EXPECT_THAT(error_of("a: " + std::string(300, '[') + std::string(300, ']'), none), HasSubstr("nested"));
  std::string many = "a: [";
  for (int i = 0; i < 200'001; ++i) many += "1,";
  EXPECT_THAT(error_of(many + "1]", none), HasSubstr("values"));
  std::string keys;
  for (int i = 0; i < 5000; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(error_of(keys, none), HasSubstr("4096 keys"));
  std::string laughs = "a0: &a0 [x]\n";  // 10^9 elements if they were copied
  for (int i = 1; i < 10; ++i) {
    const std::string n = std::to_string(i), p = "*a" + std::to_string(i - 1);
    laughs += "a" + n + ": &a" + n + " [";
    for (int k = 0; k < 10; ++k) laughs += p + ",";
    laughs += "]\n";
  }
  EXPECT_EQ(error_of(laughs, [](const Node& n) { n.entries(); }), "");
}

TEST(ConfigParse, files_that_cannot_be_read) {
  const auto missing = load("/nonexistent/x.yaml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().reason, Reason::cannot_read);
  EXPECT_EQ(missing.error().text, "/nonexistent/x.yaml: cannot read: No such file or directory");
  EXPECT_EQ(load("/").reason(), Reason::cannot_read);
}

}  // namespace
}  // namespace adit::config
