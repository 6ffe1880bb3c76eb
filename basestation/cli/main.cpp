// SPDX-License-Identifier: Apache-2.0
// The program basestation: parses the options, then runs one command, the prompt or the dashboard.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "basestation/cli/completion.hpp"
#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/prompt.hpp"
#include "basestation/cli/run_line.hpp"
#include "basestation/client/arguments.hpp"
#include "basestation/host/serve.hpp"
#include "core/command/parse.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"
#include "core/config/usage.hpp"

namespace adit::station::cli {
namespace {

std::string footer() {
  return "Commands (without one: a prompt that takes them):\n" + command::help_all() +
         "\nExamples:\n"
         "  basestation list                          who is there\n"
         "  basestation take r1 r2                    become their holder\n"
         "  basestation goto r1 12 0.5 --wait         send r1 to a point, return on arrival\n"
         "  basestation --json status r1              for scripts\n"
         "  basestation --name op2 --link wifi watch  another operator's dashboard\n"
         "  basestation stop all                      software stop of every robot; needs no authority\n"
         "\nExit status: 0 done, 1 refused (why: on stderr), 2 wrong usage, 3 no answer.";
}

int show_help(const std::vector<std::string>& words, const Options& options) {
  if (words.size() < 2) {
    std::printf("usage: basestation [--name op1] [--link wifi] [--json] COMMAND\n\n%s\n", footer().c_str());
    return kExitDone;
  }
  if (words[1] == "--markdown") {  // Prints the table of docs/operators.md.
    std::fputs(command::help_markdown().c_str(), stdout);
    return kExitDone;
  }
  const auto found = command::find_commands(words[1]);
  for (const command::CommandInfo* row : found) std::fputs(command::help(*row).c_str(), stdout);
  if (!found.empty()) return kExitDone;
  return fail(options, kExitUsage, command::parse(std::vector<std::string>{words[1]}).error());
}

int run_command(const Options& options, const std::vector<std::string>& words) {
  if (words[0] == "help") return show_help(words, options);
  if (words[0] == "completion") return print_completion(options, words);
  const auto request = command::parse(words);
  if (!request) return fail(options, kExitUsage, request.error());
  return run_request(options, *request, client::quoted(words), nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::error_code failed;
  options.program = std::filesystem::read_symlink("/proc/self/exe", failed).string();
  if (failed) options.program = argv[0];

  CLI::App app{"The operator's side of a team of robots: one station per operator name."};
  app.set_help_flag("-h,--help", "This help");
  app.set_version_flag("--version", ADIT_VERSION, "The version");
  app.option_defaults()->always_capture_default();
  int ready_fd = -1;
  client::StationArguments station(app, options);
  app.add_flag("--json", options.json, "One JSON object instead of text");
  app.add_option(
         "--at", options.at,
         "Where the station stands, X Y Z of the map in m; others are told, and a link with a range or "
         "that fades reckons with it")
      ->expected(3)
      ->allow_extra_args(false)
      ->check(config::between(-1e4, 1e4));
  app.add_option(
         "--record", options.record,
         "Folder for the recording of the last minutes, or none; below the state folder when not given")
      ->allow_extra_args(false);
  app.add_flag("--alone", options.alone, "A stop goes out without the station")->group("");
  CLI::Option* served = app.add_option("--serve", ready_fd, "Run the station in this process")->group("");
  app.prefix_command();
  app.footer(footer());
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::printf("%s\n", app.help().c_str());
    return kExitDone;
  } catch (const CLI::CallForVersion&) {
    std::printf("%s\n", ADIT_VERSION);
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    return fail(options, kExitUsage, {Reason::bad_argument, std::string(error.what()) + "; try --help"});
  }
  if (const auto good = station.finish(); !good) return fail(options, kExitUsage, good.error());
  if (served->count() > 0) return host::serve(options, ready_fd);

  std::vector<std::string> words = app.remaining();
  if (!words.empty() && words[0].starts_with('-'))
    return fail(options, kExitUsage,
                {Reason::bad_argument, "no option " + command::clean(words[0], 40) + "; try --help"});
  // These two options may also follow the command.
  if (std::erase(words, "--json") > 0) options.json = true;
  if (std::erase(words, "--help") + std::erase(words, "-h") > 0) words.insert(words.begin(), "help");
  for (const std::string& word : words) {
    const std::string option = word.substr(0, word.find('='));
    if (words[0] != "completion" && option.starts_with("--") && app.get_option_no_throw(option) != nullptr)
      return fail(options, kExitUsage,
                  {Reason::bad_argument, option + " goes before the command: basestation " + option +
                                             " ... " + command::clean(words[0], 40)});
  }
  catch_interrupts();
  if (words.empty()) return prompt(options);
  return run_command(options, words);
}

}  // namespace adit::station::cli

int main(int argc, char** argv) { return adit::station::cli::main(argc, argv); }
