// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/completion.hpp"

#include <algorithm>
#include <cstdio>

#include "basestation/cli/run_line.hpp"
#include "basestation/client/connection.hpp"
#include "basestation/client/paths.hpp"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"

namespace adit::station::cli {
namespace {

constexpr const char* kBashScript = R"sh(_basestation() {
  local IFS=$'\n'
  COMPREPLY=($(compgen -W "$(basestation completion words "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)" -- "${COMP_WORDS[COMP_CWORD]}"))
}
complete -o default -F _basestation basestation
)sh";

constexpr const char* kZshScript = R"sh(#compdef basestation
_basestation() {
  local -a found
  found=("${(@f)$(basestation completion words "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  compadd -a found
}
compdef _basestation basestation
)sh";

constexpr const char* kFishScript =
    R"sh(complete -c basestation -f -a '(basestation completion words (commandline -opc)[2..-1] (commandline -ct) 2>/dev/null)'
)sh";

/// The robots that a running station knows; empty if it does not answer immediately.
std::vector<std::string> known_robots(const Options& options) {
  std::vector<std::string> robots;
  const auto path = client::socket_path(options.name);
  if (!path) return robots;
  auto socket = client::LineSocket::connect(*path);
  if (!socket) return robots;
  client::Connection client(std::move(*socket), "completion");
  bool answered = false;
  client.on_world = [&](const World& world) {
    answered = true;
    robots.clear();
    for (const Robot& robot : world.robots) robots.push_back(robot.name);
  };
  client.follow();
  for (int i = 0; i < 5 && !answered; ++i)
    if (!client.wait(100)) break;
  return robots;
}

}  // namespace

std::vector<std::string> candidates(const std::vector<std::string>& all_words,
                                    const std::vector<std::string>& robots) {
  // Skips the options before the command.
  std::size_t at = 0;
  while (at + 1 < all_words.size() && all_words[at].starts_with('-')) at += all_words[at] == "--json" ? 1 : 2;
  std::vector<std::string> words(
      all_words.begin() + static_cast<std::ptrdiff_t>(std::min(at, all_words.size())), all_words.end());
  if (words.size() <= 1) {
    std::vector<std::string> out = command::command_names();
    out.insert(out.end(), {"--name", "--link", "--json", "--domain", "--interface", "--peer", "--at"});
    return out;
  }
  return command::complete(words, robots);
}

int print_completion(const Options& options, const std::vector<std::string>& words) {
  const std::string shell = words.size() > 1 ? words[1] : "";
  if (shell == "words") {
    const std::vector<std::string> typed(words.begin() + 2, words.end());
    Options asked = options;
    for (std::size_t i = 0; i + 1 < typed.size(); ++i)
      if (typed[i] == "--name" && command::valid_name(typed[i + 1])) asked.name = typed[i + 1];
    for (const std::string& word : candidates(typed, known_robots(asked))) std::printf("%s\n", word.c_str());
    return kExitDone;
  }
  if (words.size() == 2 && (shell == "bash" || shell == "zsh" || shell == "fish")) {
    std::fputs(shell == "bash" ? kBashScript : shell == "zsh" ? kZshScript : kFishScript, stdout);
    return kExitDone;
  }
  return fail(options, kExitUsage, {Reason::bad_argument, "completion: usage: completion bash|zsh|fish"});
}

}  // namespace adit::station::cli
