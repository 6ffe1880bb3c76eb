// SPDX-License-Identifier: Apache-2.0
// The command table against what else names commands: the contract, and the page for operators.
#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <sstream>

#include "core/command/vocabulary.hpp"

namespace adit::command {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(std::string(ADIT_SOURCE_DIR) + "/" + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(CommandTable, NamesAndNumbersAreUnique) {
  std::set<std::string_view> names;
  std::set<int> numbers;
  for (const CommandInfo& row : table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(row.number < 0 || numbers.insert(row.number).second) << row.name;
    EXPECT_EQ(row.number >= 0, row.runs == Runs::robot || row.runs == Runs::nobody) << row.name;
    EXPECT_FALSE(row.summary.empty()) << row.name;
    EXPECT_FALSE(row.example.empty()) << row.name;
    EXPECT_TRUE(row.number < 0 || !row.done.empty()) << row.name;
    for (const Option& option : row.options) EXPECT_EQ(option.summary.empty(), !option) << row.name;
  }
}

TEST(CommandTable, NumbersAreThoseThatTheContractNames) {
  const std::string idl = text_of("idl/adit/command.idl");
  const std::size_t begin = idl.find("enum CommandKind"), end = idl.find('}', begin);
  ASSERT_NE(end, std::string::npos);
  int number = 0;
  for (std::size_t at = begin; (at = idl.find("CMD_", at)) < end; ++number) {
    std::string word;
    for (at += 4; std::isalpha(static_cast<unsigned char>(idl[at])) != 0 || idl[at] == '_'; ++at)
      word += idl[at] == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(idl[at])));
    const CommandInfo* row = find_number(number);
    ASSERT_NE(row, nullptr) << word;
    EXPECT_EQ(row->name, word);
  }
  EXPECT_GE(number, 15);
}

TEST(CommandTable, ThePageForOperatorsHasTheTable) {
  const std::string page = text_of("docs/operators.md");
  const std::string expected = help_markdown();
  const std::size_t begin = page.find("| command | what it does | example |");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = page.find("\n\n", begin);
  EXPECT_EQ(page.substr(begin, end + 1 - begin), expected)
      << "replace the table in docs/operators.md by the output of: basestation help --markdown";
}

}  // namespace
}  // namespace adit::command
