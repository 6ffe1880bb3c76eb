// SPDX-License-Identifier: Apache-2.0
// The tool `recording`, as it is typed.
#include <fstream>

#include "tests/live/process.hpp"
#include "tests/record/small.hpp"

namespace adit::record {
namespace {

using testing::HasSubstr;

class Tool : public testing::Test {
 protected:
  std::string file(const std::string& name, ByteSpan bytes) {
    return folder_.write(name, std::string(bytes.begin(), bytes.end()));
  }
  live::Finished recording(std::vector<std::string> words) {
    words.insert(words.begin(), "recording");
    return live::run(words);
  }
  Heard read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return hear(bytes_of(bytes)).value();
  }
  live::Folder folder_{};
};

TEST_F(Tool, InfoAndCatPrintTheContents) {
  const std::string path = file("a.mcap", small_file(true));
  const auto info = recording({"info", path});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("6 messages in 3 chunks"));
  EXPECT_THAT(info.out, HasSubstr("x::Y"));
  EXPECT_THAT(info.out, HasSubstr("about robot: r1"));
  const auto cat = recording({"cat", path, "--topic", "/b"});
  EXPECT_EQ(cat.exit_code, 0);
  EXPECT_EQ(cat.out, "0.000000 /b 5 bytes\n");
}

TEST_F(Tool, RecoversTheMessagesOfATornFile) {
  const auto complete = small_file(false);
  const std::string bytes(complete.begin(), complete.end());
  const std::string torn = file("torn.mcap", ByteSpan(complete).first(bytes.find("third")));
  EXPECT_EQ(recording({"info", torn}).exit_code, 1);
  const std::string saved = folder_.path() + "/saved.mcap";
  const auto done = recording({"recover", torn, saved});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("torn off"));
  const Heard heard = read(saved);
  EXPECT_TRUE(heard.report.complete) << heard.report.trouble;
  EXPECT_EQ(heard.messages.size(), 4U);
  EXPECT_EQ(heard.schemas.at(1).name, "x::Y");
}

TEST_F(Tool, SeveralBecomeOne) {
  const std::string a = file("a.mcap", small_file(true)), b = file("b.mcap", small_file(false));
  const std::string all = folder_.path() + "/all.mcap";
  EXPECT_EQ(recording({"recover", a, b, all}).exit_code, 0);
  const Heard heard = read(all);
  EXPECT_EQ(heard.messages.size(), 12U);
  EXPECT_EQ(heard.channels.size(), 2U) << "the same channels are not doubled";
}

TEST_F(Tool, ReportsWrongUsage) {
  const std::string text = file("notes.txt", bytes_of("no recording"));
  for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                {"info"},
                                                {"info", "/nowhere.mcap"},
                                                {"info", text},
                                                {"recover", text, text}}) {
    const auto got = recording(words);
    EXPECT_EQ(got.exit_code, 2);
    EXPECT_FALSE(got.err.empty());
  }
}

}  // namespace
}  // namespace adit::record
