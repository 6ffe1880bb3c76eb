// SPDX-License-Identifier: Apache-2.0
// The commands of README "Use" and of docs/tutorial.md are taken out of the pages and run in their order,
// twice, in one shell, with one home folder.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>

#include "tests/folders/folders.hpp"
#include "tests/live/process.hpp"

namespace adit::live {
namespace {

namespace fs = std::filesystem;

constexpr Seconds kCommandLimit{30};
constexpr Seconds kOutputLimit{20};  ///< From a command to the output that the page shows for it.
constexpr Seconds kEndLimit{10};     ///< From the last command of a page to the end of all that it started.

/// What is not run as the page says.
struct Instead {
  std::string_view page, here;
  int uses{};
};
std::array instead{
    Instead{"./run build", "true"},  // The build of this test made the programs.
    // These are minutes of processor time; tests/rehearsal runs the same scenarios, with more seeds.
    Instead{"rehearse config/scenarios/demo.yaml", "rehearse config/scenarios/grant.yaml"},
    Instead{"--seeds 1..50", "--seeds 1..1"},
    Instead{"--chaos --seeds 1..20", "--chaos --seeds 1..1"},
};

/// A line of an indented block of a page.
struct PageLine {
  std::string where{};  ///< "FILE:LINE"
  std::string text{};
  bool command{};  ///< Otherwise: what is printed.
};

bool is_command(const std::string& text) {
  const std::string word = text.substr(0, text.find(' '));
  return word == "export" || word == "kill" || word == "./run" ||
         (!word.empty() && fs::exists(program_folder() + "/" + word));
}

/// The lines of a page's indented blocks, below `heading` up to the next one of its level; empty: of all the
/// page.
std::vector<PageLine> lines_of(const std::string& page, const std::string& heading = {}) {
  std::vector<PageLine> lines;
  std::ifstream file(source_folder() + "/" + page);
  bool in = heading.empty();
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (!heading.empty() && line.starts_with("## ")) in = line == heading;
    if (in && line.starts_with("    "))
      lines.push_back({page + ":" + std::to_string(number), line.substr(4), is_command(line.substr(4))});
  }
  return lines;
}

/// What a line looks like in the output. A rehearsal prints the same figures each time; a live program has
/// others.
std::regex shape_of(const std::string& line) {
  const bool live = line.starts_with("driver:");
  const std::string plain = std::regex_replace(line, std::regex(R"([\\^$.|?*+()\[\]{}])"), R"(\$&)");
  return std::regex(live ? std::regex_replace(plain, std::regex(R"(-?\d+(\\\.\d+)?)"), R"(-?\d+(\.\d+)?)")
                         : plain);
}

/// A shell with job control, without a terminal, to which the test gives one command after the other.
class Pages : public testing::Test {
 protected:
  Pages() {
    const std::string work = folder_.path() + "/work";
    fs::create_directories(work + "/build/release");
    fs::create_directory_symlink(program_folder(), work + "/build/release/bin");
    fs::create_directory_symlink(source_folder() + "/config", work + "/config");
    write("cd " + work + R"(
      set -m
      exec 2>&1
      trap 'for job in $(jobs -p); do kill -9 -- -$job; done' EXIT
      # The tutorial shows the begin of the file.
      example_read_recording() { command example_read_recording "$@" && head -n 2 "$2"; }
      # By their names, programs of others would be found as well.
      pgrep() { false; }
      pkill() { false; }
      killall() { false; }
)");
  }
  ~Pages() override {
    for (const char* name : {"reader", "op1"}) (void)as(name, {"down", "--leave"});
    end_jobs();
    write("exit\n");
    (void)shell_.wait(kEndLimit);
    close(terminal_);
    close(commands_);
  }

  /// Runs a line in the shell; its exit status, or nothing when it did not end: then all that the shell
  /// started is killed.
  std::optional<int> step(const std::string& line, Seconds limit = kCommandLimit) {
    const std::string mark = "\n@@ " + std::to_string(++steps_) + " ";
    // `jobs` forgets the jobs that ended, as the prompt of a person's shell does: `%NAME` may mean them
    // otherwise.
    write(line + "\nstatus=$?; jobs > /dev/null; printf '\\n@@ " + std::to_string(steps_) +
          " %d\\n' $status\n");
    const auto ended = [&] { return press_q(), shell_.out().find(mark) != std::string::npos; };
    if (!shell_.wait_until(ended, limit)) return end_jobs(), std::nullopt;
    return std::stoi(shell_.out().substr(shell_.out().find(mark) + mark.size()));
  }

  /// True once the line was printed, after those before it.
  bool printed(const std::string& line) {
    const std::regex shape = shape_of(line);
    return shell_.wait_until(
        [&] {
          std::smatch found;
          const std::string rest = shell_.out().substr(seen_);
          if (!std::regex_search(rest, found, shape)) return false;
          seen_ += static_cast<std::size_t>(found.position() + found.length());
          return true;
        },
        kOutputLimit);
  }

  /// True once another operator reads that r1 could drive: a person does not type within 0.1 s of its start.
  bool ready() {
    const std::regex possible("mode smart_joystick +possible");
    return eventually(
        [&] {
          return std::regex_search(as("reader", {"status", "r1"}).out, possible);
        },
        kOutputLimit);
  }

  bool driver_was_silent() const {
    return shell_.out().find("[driver_silent]", shell_.out().rfind("\n@@ " + std::to_string(steps_ - 1) +
                                                                   " ")) != std::string::npos;
  }

  void follow(const std::vector<PageLine>& page) {
    ASSERT_FALSE(page.empty());
    bool after_output = true;
    for (const PageLine& line : page) {
      if (line.text.empty()) continue;
      SCOPED_TRACE(line.where + ": " + line.text);
      if (!line.command) {
        EXPECT_TRUE(printed(line.text)) << "it is not printed, but:\n" << shell_.out().substr(seen_);
      } else {
        if (after_output) seen_ = shell_.out().size();
        auto status = step(here(line.text));
        // On a busy machine a simulated driver may fall silent for a moment, and a person types the line
        // again.
        for (int tries = 0; tries < 5 && status && *status != 0 && driver_was_silent() && ready(); ++tries)
          status = step(here(line.text));
        ASSERT_TRUE(status) << "it does not end:\n" << shell_.out().substr(seen_);
        EXPECT_EQ(*status, 0) << shell_.out().substr(seen_);
        const bool starts = std::regex_search(line.text, std::regex("^robot_agent .*&"));
        EXPECT_TRUE(!starts || ready());
      }
      after_output = !line.command;
    }
    EXPECT_TRUE(step("wait", kEndLimit)) << page.back().where << ": the page leaves programs behind";
  }

 private:
  Finished as(const std::string& name, std::vector<std::string> words) {
    words.insert(words.begin(), {"basestation", "--name", name});
    return run(words, folder_.environment());
  }
  void write(const std::string& text) { (void)!::write(commands_, text.data(), text.size()); }

  /// Kills the process group of each job.
  void end_jobs() {
    const std::string shell = std::to_string(shell_.pid());
    std::ifstream children("/proc/" + shell + "/task/" + shell + "/children");
    for (pid_t job{}; children >> job;) kill(-job, SIGKILL);
  }

  /// The line as it is run here.
  std::string here(std::string line) {
    for (Instead& entry : instead) {
      const auto at = line.find(entry.page);
      if (at == line.npos) continue;
      line.replace(at, entry.page.size(), entry.here);
      ++entry.uses;
    }
    // What needs a terminal gets one on which `q` is pressed; the shell itself would take it for its own.
    if (line.starts_with("basestation watch"))
      line = "(basestation watch < " + terminal_name_ + " > " + terminal_name_ + ")";
    return line;
  }
  /// Whenever something was drawn there.
  void press_q() {
    char shown[4096];
    bool drawn = false;
    while (read(terminal_, shown, sizeof shown) > 0) drawn = true;
    if (drawn) (void)!::write(terminal_, "q", 1);
  }

  Folder folder_{};
  std::string pipe_name_{make_pipe(folder_.path() + "/commands")};
  int commands_{open(pipe_name_.c_str(), O_RDWR | O_CLOEXEC)};
  int terminal_{posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)};
  std::string terminal_name_{grantpt(terminal_) == 0 && unlockpt(terminal_) == 0 ? ptsname(terminal_) : ""};
  // In a session of its own: it takes no terminal from whom started the test.
  Process shell_{{"/usr/bin/setsid", "/bin/bash", pipe_name_}, folder_.environment()};
  int steps_{};
  std::size_t seen_{};  ///< Of the output: what the page showed until now comes before it.

  static std::string make_pipe(const std::string& name) {
    return mkfifo(name.c_str(), 0600) == 0 ? name : "";
  }
};

TEST_F(Pages, RunInTheirOrderAndTwice) {
  if (getenv("ADIT_OWN_NETWORK") == nullptr)
    GTEST_SKIP()
        << "the pages' domains may have robots of others: tests/live/isolated.sh can make no network here";
  for (const char* pass : {"first", "second"}) {
    SCOPED_TRACE(std::string(pass) + " pass");
    ASSERT_NO_FATAL_FAILURE(follow(lines_of("README.md", "## Use")));
    ASSERT_NO_FATAL_FAILURE(follow(lines_of("docs/tutorial.md")));
    if (HasFailure()) return;
  }
  for (const Instead& entry : instead) EXPECT_GT(entry.uses, 0) << entry.page << " is in no page any more";
}

}  // namespace
}  // namespace adit::live
