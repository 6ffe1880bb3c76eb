#include "basestation/command/parse.hpp"

#include <algorithm>
#include <charconv>

#include "basestation/command/grammar.hpp"
#include "basestation/command/words.hpp"

namespace adit::station {
namespace {

constexpr double max_speed = 20.0;       // m/s, rad/s: beyond any robot; a slip of the finger
constexpr double max_distance = 1e4;     // m
constexpr double max_duration = 3600.0;  // s
constexpr std::size_t max_robots = 64;

std::string usage(const CommandInfo& command) {
  return "usage: " + std::string(command.name) + (command.usage.empty() ? "" : " ") +
         std::string(command.usage);
}

Error wrong(const CommandInfo& command, const std::string& what) {
  return {Reason::bad_argument, std::string(command.name) + ": " + what + "; " + usage(command)};
}

/// A whole word as a finite number, with no locale and no hexadecimal.
bool to_number(std::string_view word, double& out) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(out);
}

Result<double> number(const CommandInfo& command, const std::string& word, const char* what, double limit) {
  double value = 0.0;
  if (!to_number(word, value))
    return wrong(command, std::string(what) + " is a number, not '" + clean(word, 32) + "'");
  if (std::abs(value) > limit) {
    std::string text(std::to_string(static_cast<int>(limit)));
    return {Reason::out_of_range,
            std::string(command.name) + ": " + what + " is at most " + text + " either way"};
  }
  return value;
}

/// Takes the options of `command` out of the words.
Result<void> take_options(const CommandInfo& command, std::vector<std::string>& words, Request& request) {
  std::vector<std::string> rest;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!word.starts_with("--")) {
      rest.push_back(word);
      continue;
    }
    if (word == "--wait" && request.verb == Verb::go_to) {
      request.wait = true;
    } else if (word == "--override" && request.verb == Verb::reset) {
      request.override_stop = true;
    } else if (word == "--all" && request.verb == Verb::run) {
      request.all_operators = true;
    } else if ((word == "--for" || word.starts_with("--for=")) && request.verb == Verb::drive) {
      std::string value = word.size() > 6 ? word.substr(6) : "";
      if (word == "--for") {
        if (++i == words.size()) return wrong(command, "--for wants a number of seconds");
        value = words[i];
      }
      auto parsed = number(command, value, "--for", max_duration);
      if (!parsed) return parsed.error();
      if (*parsed <= 0.0) return Error{Reason::out_of_range, "drive: --for is more than 0 seconds"};
      request.duration = *parsed;
    } else {
      return wrong(command, "no option " + clean(word, 32));
    }
  }
  words = std::move(rest);
  return {};
}

/// The words that are left are robot names.
Result<void> take_robots(const CommandInfo& command, const std::vector<std::string>& words,
                         Request& request) {
  for (const std::string& word : words) {
    if (!valid_name(word))
      return wrong(command,
                   "'" + clean(word, 40) + "' cannot be a robot's name (1 to 32 of A-Z a-z 0-9 _ -)");
    if (std::find(request.robots.begin(), request.robots.end(), word) == request.robots.end())
      request.robots.push_back(word);
  }
  const auto count = static_cast<int>(request.robots.size());
  if (count < command.robots_min) return wrong(command, "a robot is missing");
  if (command.robots_max > 0 && count > command.robots_max)
    return wrong(command, "takes one robot, not " + std::to_string(count));
  if (request.robots.size() > max_robots) return wrong(command, "at most 64 robots at once");
  return {};
}

Result<void> take_mode(const CommandInfo& command, std::vector<std::string>& words, Request& request) {
  if (words.size() < 2)
    return wrong(command, words.empty() ? "a robot and a mode are missing" : "a mode is missing");
  request.word = words.back();
  words.pop_back();
  const auto& modes = mode_names();
  if (std::find(modes.begin(), modes.end(), request.word) != modes.end()) return {};
  const std::string meant = nearest(request.word, modes);
  return {Reason::mode_unknown, "mode: no mode '" + clean(request.word, 32) + "'" +
                                    (meant.empty() ? "" : ", did you mean " + meant + "?") + " (" +
                                    joined(modes, "") + ")"};
}

Result<void> take_numbers(const CommandInfo& command, std::vector<std::string>& words, Request& request) {
  const bool drive = request.verb == Verb::drive;
  const std::size_t least = drive ? 4 : 3;
  if (words.size() < least || words.size() > 4)
    return wrong(command, "takes a robot and " + std::string(drive ? "three" : "two or three") +
                              " numbers, not " + std::to_string(words.size()) + " words");
  static constexpr std::array<const char*, 3> drive_names{"VX", "VY", "WZ"};
  static constexpr std::array<const char*, 3> goto_names{"X", "Y", "Z"};
  for (std::size_t i = 1; i < words.size(); ++i) {
    auto value = number(command, words[i], drive ? drive_names[i - 1] : goto_names[i - 1],
                        drive ? max_speed : max_distance);
    if (!value) return value.error();
    request.numbers[i - 1] = *value;
  }
  words.resize(1);
  return {};
}

Result<void> take_component(const CommandInfo& command, std::vector<std::string>& words, Request& request) {
  const bool policy = request.verb == Verb::policy;
  if (words.size() != (policy ? 3u : 2u))
    return wrong(command,
                 policy ? "takes a robot, a component, and auto or manual" : "takes a robot and a component");
  if (!valid_name(words[1]))
    return wrong(command, "'" + clean(words[1], 40) + "' cannot be a component's name");
  if (policy && words[2] != "auto" && words[2] != "manual")
    return wrong(command, "'" + clean(words[2], 40) + "' is neither auto nor manual");
  request.automatic = policy && words[2] == "auto";
  request.word = words[1];
  words.resize(1);
  return {};
}

}  // namespace

Result<Request> parse(const std::vector<std::string>& all_words) {
  if (all_words.empty()) return {Reason::syntax, "no command; try help"};
  const CommandInfo* command = find_command(all_words.front());
  if (!command) {
    const std::string meant = nearest(all_words.front(), command_names());
    return {Reason::unknown_command, "unknown command '" + clean(all_words.front(), 32) + "'" +
                                         (meant.empty() ? "; try help" : ", did you mean " + meant + "?")};
  }
  Request request;
  request.verb = command->verb;
  std::vector<std::string> words(all_words.begin() + 1, all_words.end());
  if (auto done = take_options(*command, words, request); !done) return done.error();

  switch (request.verb) {
    case Verb::mode:
      if (auto done = take_mode(*command, words, request); !done) return done.error();
      break;
    case Verb::drive:
    case Verb::go_to:
    case Verb::plan:
      if (auto done = take_numbers(*command, words, request); !done) return done.error();
      break;
    case Verb::grant:
      if (words.size() != 2) return wrong(*command, "takes a robot and an operator");
      if (!valid_name(words[1]))
        return wrong(*command, "'" + clean(words[1], 40) + "' cannot be an operator's name");
      request.word = words[1];
      words.pop_back();
      break;
    case Verb::restart:
    case Verb::policy:
      if (auto done = take_component(*command, words, request); !done) return done.error();
      break;
    case Verb::run:
      if (words.size() != 1) return wrong(*command, "takes one file");
      request.word = words[0];
      return request;
    case Verb::stop:
      request.all = std::find(words.begin(), words.end(), "all") != words.end();
      if (request.all) return request;  // names beside `all` change nothing
      break;
    default:
      break;
  }
  if (command->robots_min < 0) {
    if (!words.empty()) return wrong(*command, "takes no arguments");
    return request;
  }
  if (auto done = take_robots(*command, words, request); !done) return done.error();
  return request;
}

Result<Request> parse(std::string_view line) {
  auto words = split_words(line);
  if (!words) return words.error();
  return parse(*words);
}

}  // namespace adit::station
