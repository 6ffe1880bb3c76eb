// SPDX-License-Identifier: Apache-2.0
// Seeded damage to good files: the reader answers, with a value or with a line, and never dies.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "core/config/node.hpp"
#include "core/time/random.hpp"
#include "tests/folders/folders.hpp"

namespace adit::config {
namespace {

std::string slurp(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string damaged(std::string text, Random& random) {
  static const std::string spice =
      "[]{}:,-&*!|>'\"%@`#?\n\t \\~<\x01\x80\xff"
      "0aZ";
  const std::uint64_t changes = 1 + random.below(4);
  for (std::uint64_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = random.below(text.size());
    switch (random.below(5)) {
      case 0:
        text[at] = spice[random.below(spice.size())];
        break;
      case 1:
        text.insert(at, 1, spice[random.below(spice.size())]);
        break;
      case 2:
        text.erase(at, 1 + random.below(8));
        break;
      case 3:
        text.insert(at, text.substr(random.below(text.size()), random.below(40)));
        break;
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

void read(const Node& n) {
  n.text("name");
  n.choice("drive", {"differential", "holonomic"});
  for (const char* key : {"length", "width", "max_speed"}) n.number(key, positive_up_to(5));
  n.numbers("pose", 3, 3, any_number(), {});
  n.flag("stairs", false);
  for (const auto& item : n.list_if("script")) item.text("do"), item.number("at");
}

TEST(ConfigMutation, damaged_files_give_a_value_or_one_line) {
  const std::string sources[] = {slurp(source_folder() + "/config/platforms/legged.yaml"),
                                 "name: &n r1\npose: [1, 0, 0]\nscript:\n  - {at: 2, do: take r1}\n  - {at: "
                                 "3, do: *n}\ntext: |\n  block\n"};
  ASSERT_FALSE(sources[0].empty());
  Random random(2024);
  int good = 0, bad = 0;
  for (int i = 0; i < 6000; ++i) {
    const std::string text = damaged(sources[i % 2], random);
    auto root = parse(text, "f.yaml");
    Result<void> done = root ? (read(*root), root->finish()) : Result<void>(root.error());
    (done ? good : bad)++;
    if (!done) {
      EXPECT_EQ(done.error().text.rfind("f.yaml:", 0), 0u) << done.error().text;
    }
  }
  EXPECT_GT(bad, 3000);
  EXPECT_GT(good + bad, 5999);
}

}  // namespace
}  // namespace adit::config
