// SPDX-License-Identifier: Apache-2.0
// Photos of an operator's marks: files that he names, good or not, and what the station lists and writes.
#include <fstream>

#include "core/store/memory_disk.hpp"
#include "tests/findings/drawn_photo.hpp"
#include "tests/folders/folders.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class MarkPhotosTest : public StationTest {
 protected:
  MarkPhotosTest() { begin_again(1); }
  void begin_again(std::uint64_t seed) {
    op_.reset();
    wire_.reset();
    wire_ = network_.join(77, "op1");
    StationParams params;
    params.name = "op1";
    params.id = kId;
    params.seed = seed;
    params.disk = disk_;
    op_ = std::make_unique<Station>(params, *strand_, *wire_);
    ASSERT_TRUE(op_->start().ok());
    run_for(6s);
  }
  std::string file_with(const store::Bytes& bytes) {
    const std::string file = folder_ + "/" + std::to_string(++files_) + ".jpg";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
  }
  static store::Bytes content_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::string folder_{scratch_folder()};
  int files_{};
  std::shared_ptr<store::MemoryDisk> disk_{std::make_shared<store::MemoryDisk>()};
};

TEST_F(MarkPhotosTest, AreStoredListedAndWrittenAlsoAfterARestart) {
  const store::Bytes jpeg = findings::draw({});
  const Outcome added = execute("finding add gas 1 2 0 it smells --photo " + file_with(jpeg));
  ASSERT_EQ(added.exit_code, 0) << added.error;
  EXPECT_EQ(added.json["photo"], true);
  EXPECT_EQ(added.json["text"], "it smells");
  EXPECT_EQ(execute("finding add exit 5 5").exit_code, 0);
  run_for(2s);
  for (std::uint64_t start = 2; start <= 3; ++start) {
    const Outcome listed = execute("findings");
    EXPECT_THAT(listed.text, HasSubstr("whole"));
    EXPECT_EQ(listed.json["findings"][0]["photo"]["here"], "whole");
    EXPECT_EQ(listed.json["findings"][0]["photo"]["percent"], 100);
    EXPECT_EQ(listed.json["findings"][0]["photo"]["bytes"], jpeg.size());
    EXPECT_EQ(listed.json["findings"][0]["photo"]["id"], findings::id_text(findings::photo_hash(jpeg)));
    EXPECT_FALSE(listed.json["findings"][1].contains("photo"));
    const std::string out = folder_ + "/out.jpg";
    EXPECT_EQ(execute("finding photo 1 " + out).text, "the photo is in " + out + "\n");
    EXPECT_EQ(content_of(out), jpeg);
    begin_again(start);
  }
  EXPECT_EQ(execute("finding photo 2 " + folder_ + "/none.jpg").json["reason"], "bad_argument");
  EXPECT_EQ(execute("finding photo 9 " + folder_ + "/none.jpg").json["reason"], "out_of_range");
  EXPECT_EQ(execute("finding photo 1 " + folder_ + "/no/such/folder.jpg").json["reason"], "cannot_write");
}

TEST_F(MarkPhotosTest, AFileThatCannotBeUsedAddsNoMark) {
  const auto reason = [this](const std::string& file) {
    return execute("finding add gas 1 2 --photo " + file).json["reason"];
  };
  EXPECT_EQ(reason(folder_ + "/none.jpg"), "cannot_read");
  EXPECT_EQ(reason(folder_), "cannot_read");
  EXPECT_EQ(reason("/dev/zero"), "cannot_read");
  EXPECT_EQ(reason(file_with({})), "malformed");
  EXPECT_EQ(reason(file_with(store::Bytes(5000, 'x'))), "malformed");
  EXPECT_EQ(reason(file_with(store::Bytes(20'000'000, 0xff))), "out_of_range");
  store::Bytes cut = findings::draw({});
  cut.resize(cut.size() / 2);
  EXPECT_EQ(reason(file_with(cut)), "malformed");
  EXPECT_TRUE(execute("findings").json["findings"].empty());
  EXPECT_EQ(op_->photos(), 0U);
}

TEST_F(MarkPhotosTest, ALargeFileIsScaled) {
  const store::Bytes jpeg = findings::draw({.width = 3000, .height = 2000, .quality = 98});
  ASSERT_GT(jpeg.size(), findings::Photo::kMaxBytes);
  ASSERT_EQ(execute("finding add gas 1 2 --photo " + file_with(jpeg)).exit_code, 0);
  EXPECT_EQ(op_->photos(), 1U);
  EXPECT_LE(execute("findings").json["findings"][0]["photo"]["bytes"], findings::Photo::kMaxBytes);
}

}  // namespace
}  // namespace adit::station
