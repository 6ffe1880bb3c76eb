// SPDX-License-Identifier: Apache-2.0
// The ring of files that an agent keeps.
#include "core/record/recorder.hpp"

#include <atomic>
#include <filesystem>
#include <fstream>

#include "tests/live/process.hpp"
#include "tests/record/small.hpp"

namespace adit::record {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

std::vector<fs::path> files_in(const std::string& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

Heard heard_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return hear(bytes_of(bytes)).value();
}

class RecorderTest : public testing::Test {
 protected:
  RecorderParams params() {
    RecorderParams out;
    out.ring.folder = folder_.path() + "/recordings";
    out.ring.name = "r1";
    out.clock = [this] { return now_ += 1'000'000; };
    out.steady = [this] { return steady_ += 1'000'000; };
    out.on_error = [this](const std::string& text) { complaints_.push_back(text); };
    return out;
  }
  std::vector<fs::path> files() { return files_in(folder_.path() + "/recordings"); }

  live::Folder folder_{};
  std::atomic<std::uint64_t> now_{1'000'000'000}, steady_{0};
  std::vector<std::string> complaints_{};  // by the writing thread, read once it has ended
};

TEST_F(RecorderTest, StoresMessagesWithTheirTypes) {
  {
    Recorder recorder(params());
    const auto id = recorder.channel({"out/adit/presence", "adit::radio::Presence", {{"net", "radio"}}});
    EXPECT_EQ(recorder.channel({"out/adit/presence", "adit::radio::Presence", {{"net", "radio"}}}), id);
    const auto odd = recorder.channel({"out/odd", "odd::Type", {}});
    recorder.record(id, bytes_of("one"));
    recorder.record(odd, bytes_of("two"));
  }
  ASSERT_THAT(files(), SizeIs(1));
  const Heard heard = heard_in(files()[0]);
  EXPECT_TRUE(heard.report.complete) << heard.report.trouble;
  EXPECT_THAT(heard.messages,
              testing::ElementsAre("1:out/adit/presence 1001000000 one", "0:out/odd 1002000000 two"));
  EXPECT_EQ(heard.schemas.at(1).name, "adit::radio::Presence");
  EXPECT_THAT(heard.schemas.at(1).text, HasSubstr("typedef octet Id16[16]"));
  EXPECT_EQ(fs::status(files()[0]).permissions() & fs::perms::all,
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(RecorderTest, StaysWithinItsBoundsOverRestarts) {
  RecorderParams own = params();
  own.ring.segments = 3;
  own.ring.segment_bytes = 4096;
  own.compress = false;
  for (int run = 0; run < 4; ++run) {
    Recorder recorder(own);
    const auto id = recorder.channel({"out/x", "", {}});
    for (int i = 0; i < 100; ++i) recorder.record(id, bytes_of(std::string(200, 'x')));
  }
  std::uint64_t bytes = 0;
  for (const auto& file : files()) bytes += fs::file_size(file);
  EXPECT_LE(bytes, 3 * 4096U + 2048U) << "the summary of the last one comes on top";
  EXPECT_GE(bytes, 4096U);
  EXPECT_EQ(files().back().filename().string().substr(0, 3), "r1-");
}

TEST_F(RecorderTest, ShortLivesDoNotPushTheOldOut) {
  for (int run = 0; run < 20; ++run) {
    Recorder recorder(params());
    recorder.record(recorder.channel({"out/x", "", {}}), bytes_of("x"));
  }
  EXPECT_THAT(files(), SizeIs(20));
  for (int run = 0; run < 60; ++run) {
    Recorder recorder(params());
    recorder.record(recorder.channel({"out/x", "", {}}), bytes_of("x"));
  }
  EXPECT_THAT(files(), SizeIs(64)) << "their number is bounded all the same";
}

TEST_F(RecorderTest, FilesOfOthersAreLeftAlone) {
  fs::create_directories(folder_.path() + "/recordings");
  for (const std::string name : {"r1.mcap", "r10-000001.mcap", "r1-notes.mcap", "r1-000001-000001.mcap"})
    std::ofstream(folder_.path() + "/recordings/" + name) << std::string(100'000, 'x');
  RecorderParams own = params();
  own.ring.segments = 2;
  own.ring.segment_bytes = 4096;
  for (int run = 0; run < 40; ++run) {
    Recorder recorder(own);
    recorder.record(recorder.channel({"out/x", "", {}}), bytes_of("x"));
  }
  EXPECT_EQ(fs::file_size(folder_.path() + "/recordings/r1-000001-000001.mcap"), 100'000U);
  for (const std::string name : {"r1.mcap", "r10-000001.mcap", "r1-notes.mcap"})
    EXPECT_TRUE(fs::exists(folder_.path() + "/recordings/" + name)) << name;
  EXPECT_LT(files().size(), 4U + 16U);
}

TEST_F(RecorderTest, WritesQueuedMessagesOfAReleasedChannel) {
  {
    Recorder recorder(params());
    for (int i = 0; i < 5000; ++i) {
      const auto id = recorder.channel({"in/x", "", {{"from", std::to_string(i)}}});
      recorder.record(id, bytes_of(std::to_string(i)));
      recorder.release(id);
      recorder.record(id, bytes_of("too late"));
    }
  }
  const Heard heard = heard_in(files().at(0));
  EXPECT_EQ(heard.messages.size(), 5000U);
  EXPECT_EQ(heard.channels.size(), 5000U);
  EXPECT_THAT(heard.messages.back(), HasSubstr("4999"));
}

TEST_F(RecorderTest, LargeOnesAreThinned) {
  RecorderParams own = params();
  own.large = 100;
  own.large_period = 50ms;  // the clock of this test goes on by 1 ms a message
  Recorder recorder(own);
  const auto id = recorder.channel({"in/rt/points", "", {}});
  for (int i = 0; i < 100; ++i) recorder.record(id, bytes_of(std::string(101, 'x')));
  EXPECT_EQ(recorder.counters().thinned, 98U);
}

TEST_F(RecorderTest, CountsMessagesBeyondTheQueue) {
  RecorderParams own = params();
  own.queue_bytes = 1000;
  own.flush = 1h;
  Recorder recorder(own);
  const auto id = recorder.channel({"out/x", "", {}});
  for (int i = 0; i < 20; ++i) recorder.record(id, bytes_of(std::string(84, 'x')));
  EXPECT_EQ(recorder.counters().dropped, 10U);
}

/// A disk with room for so many bytes.
struct SmallDisk {
  std::atomic<std::int64_t> room{};
  struct Out final : Output {
    SmallDisk& disk;
    std::unique_ptr<Output> file;
    Out(SmallDisk& d, std::unique_ptr<Output> f) : disk(d), file(std::move(f)) {}
    Result<void> append(ByteSpan data) override {
      if (static_cast<std::int64_t>(data.size()) > disk.room)
        return {Reason::cannot_write, "No space left on device"};
      disk.room -= static_cast<std::int64_t>(data.size());
      return file->append(data);
    }
  };
  auto opener() {
    return [this](const std::string& path) -> Result<std::unique_ptr<Output>> {
      auto file = open_file(path, false);
      if (!file) return file;
      return std::unique_ptr<Output>(std::make_unique<Out>(*this, std::move(*file)));
    };
  }
};

TEST_F(RecorderTest, ReportsAFullDiskOnceAndContinuesWhenThereIsRoom) {
  SmallDisk disk;
  disk.room = 3000;
  RecorderParams own = params();
  own.ring.open = disk.opener();
  own.flush = 1ms;
  own.compress = false;
  {
    Recorder recorder(own);
    const auto id = recorder.channel({"out/x", "", {}});
    const auto until = [&](auto condition) {
      return live::eventually([&] {
        for (int i = 0; i < 100; ++i) recorder.record(id, bytes_of(std::string(100, 'x')));
        return condition();
      });
    };
    EXPECT_TRUE(until([&] { return recorder.counters().dropped > 100; }));
    EXPECT_EQ(recorder.counters().failed_files, 1U) << "it is tried again after 5 s";
    disk.room = 10'000'000;
    now_ += 10'000'000'000;
    steady_ += 10'000'000'000;
    const auto before = recorder.counters().files;
    EXPECT_TRUE(until([&] { return recorder.counters().files > before; }));
  }
  EXPECT_THAT(complaints_, testing::ElementsAre(HasSubstr("No space left")));
  EXPECT_GT(heard_in(files().front()).report.bytes, 100U) << "what was written before can be read";
  EXPECT_TRUE(heard_in(files().back()).report.complete);
}

TEST_F(RecorderTest, AClockThatStepsBackDoesNotLengthenThePauseAfterAnError) {
  SmallDisk disk;
  RecorderParams own = params();
  own.ring.open = disk.opener();
  own.flush = 1ms;
  now_ = 7'200'000'000'000;
  Recorder recorder(own);
  const auto id = recorder.channel({"out/x", "", {}});
  const auto until = [&](auto condition) {
    return live::eventually([&] {
      recorder.record(id, bytes_of("x"));
      return condition();
    });
  };
  ASSERT_TRUE(until([&] { return recorder.counters().failed_files > 0; }));
  disk.room = 10'000'000;
  now_ -= 3'600'000'000'000;
  steady_ += 10'000'000'000;
  EXPECT_TRUE(until([&] { return recorder.counters().files > 0; }));
}

TEST_F(RecorderTest, AFolderThatCannotBeMadeCostsTheRecordingOnly) {
  RecorderParams own = params();
  own.ring.folder = "/proc/nowhere/recordings";
  {
    Recorder recorder(own);
    recorder.record(recorder.channel({"out/x", "", {}}), bytes_of("x"));
  }
  EXPECT_THAT(complaints_, testing::ElementsAre(HasSubstr("/proc/nowhere")));
}

}  // namespace
}  // namespace adit::record
