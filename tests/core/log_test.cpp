// SPDX-License-Identifier: Apache-2.0
#include "core/log/log.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "core/exec/virtual_runtime.hpp"
#include "tests/folders/folders.hpp"

namespace adit {
namespace {

using testing::ElementsAre;

TEST(Log, a_default_one_is_off) {
  const Log log;
  EXPECT_FALSE(log.on(LogLevel::error));
  log.error("nobody hears");
}

TEST(Log, names_the_component_and_the_machines_clock) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 1000s);
  const auto strand = machine->strand("main");
  const auto memory = std::make_shared<MemoryLog>(LogLevel::info);
  const Log log = Log(memory, "r1").named("r1/mux", strand.get());
  scheduler.run_until(1500ms);
  log.warn("source changed");
  log.debug("below the level");
  Log(memory, "plain").info("no clock");
  EXPECT_THAT(memory->lines(), ElementsAre("[ 1001.500000] warn  r1/mux: source changed",
                                           "[           -] info  plain: no clock"));
}

TEST(Log, is_one_line_without_control_characters) {
  const auto memory = std::make_shared<MemoryLog>();
  Log(memory, "wire").info("a\nb\x1b[31mc\t");
  EXPECT_THAT(memory->lines(), ElementsAre("[           -] info  wire: a | b?[31mc?"));
}

TEST(Log, has_no_control_characters_of_c1) {
  const auto memory = std::make_shared<MemoryLog>();
  const Log log(memory, "wire");
  log.info(
      "a\xc2\x9b"
      "31mb");  // CSI in UTF-8
  log.info(
      "a\x9b"
      "31mb");                                            // and as a byte alone
  log.info("caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\xa4\x96");  // text stays
  log.info("\xc0\x9b \xed\xa0\x80 \xe2\x82");
  EXPECT_THAT(memory->lines(),
              ElementsAre("[           -] info  wire: a??31mb", "[           -] info  wire: a?31mb",
                          "[           -] info  wire: caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\xa4\x96",
                          "[           -] info  wire: ?? ??? ??"));
}

TEST(Log, memory_is_bounded) {
  const auto memory = std::make_shared<MemoryLog>(LogLevel::info, 3);
  for (int i = 0; i < 10; ++i) Log(memory, "x").info(std::to_string(i));
  ASSERT_EQ(memory->lines().size(), 3u);
  EXPECT_EQ(memory->lines().front().back(), '7');
}

TEST(Log, levels_have_names) {
  LogLevel level{};
  for (const char* text : {"trace", "debug", "info", "warn", "error", "off"}) {
    EXPECT_TRUE(level_from_name(text, level));
    EXPECT_EQ(name(level), text);
  }
  EXPECT_FALSE(level_from_name("loud", level));
}

TEST(LiveLog, writes_both_clocks_into_a_file) {
  const std::string path = scratch_folder() + "/agent.log";
  {
    const auto sink = make_live_log({.level = LogLevel::debug, .console = false, .file = path});
    ASSERT_TRUE(sink) << sink.error().text;
    Log(*sink, "agent").info("started {}");
    Log(*sink, "agent").trace("below");
  }
  std::ifstream file(path);
  std::string line, more;
  std::getline(file, line);
  EXPECT_TRUE(std::regex_match(
      line, std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z \[ +-\] info  agent: started \{\})")))
      << line;
  EXPECT_FALSE(std::getline(file, more));
}

TEST(LiveLog, a_file_that_cannot_be_written_is_an_error) {
  const auto sink = make_live_log({.console = false, .file = "/proc/nowhere/x.log"});
  ASSERT_FALSE(sink);
  EXPECT_EQ(sink.error().reason, Reason::cannot_write);
}

}  // namespace
}  // namespace adit
