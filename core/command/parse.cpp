// SPDX-License-Identifier: Apache-2.0
#include "core/command/parse.hpp"

#include <algorithm>
#include <charconv>

#include "core/command/words.hpp"

namespace adit::command {
namespace {

/// Parses a complete word as a finite number, without locale and without hexadecimal.
bool to_number(std::string_view word, double& out) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(out);
}

/// Describes an argument for use in a sentence: "a robot", "X", "auto or manual".
std::string named(const Argument& argument) {
  if (!argument.what.empty()) return std::string(argument.what);
  if (argument.type != Type::choice) return std::string(argument.name);
  std::string text;
  for (const std::string& choice : choices(argument)) text += (text.empty() ? "" : " or ") + choice;
  return text;
}

/// Describes the arguments of a command in a sentence: "a robot and a component", "one robot".
std::string takes(const CommandInfo& command) {
  std::vector<std::string> all;
  for (const Argument& argument : command.arguments)
    if (argument) all.push_back(named(argument));
  if (all.empty()) return "takes no arguments";
  if (all.size() == 1 && command.arguments[0].max_count == 1) {
    const std::size_t article = all[0].find(' ');
    return "takes one" + (article == std::string::npos ? " " + all[0] : all[0].substr(article));
  }
  std::string text = "takes " + all[0];
  for (std::size_t i = 1; i < all.size(); ++i) text += (i + 1 < all.size() ? ", " : " and ") + all[i];
  return text;
}

/// Reads the words of one line according to one row of the table.
class Reader {
 public:
  Reader(const CommandInfo& row, std::vector<std::string> words) : row_(row), words_(std::move(words)) {}

  Result<Request> run() {
    request_.info = &row_;
    if (auto done = take_options(); !done) return done.error();
    std::size_t argument = 0, word = 0;
    for (std::size_t i = 0; i < row_.arguments.size(); ++i) {
      if (row_.arguments[i].type != Type::keyword) continue;
      const auto found =
          std::find(words_.begin() + static_cast<std::ptrdiff_t>(word), words_.end(), row_.arguments[i].name);
      const auto at = static_cast<std::size_t>(found - words_.begin());
      if (auto done = assign(argument, i, word, at); !done) return done.error();
      if (found == words_.end()) return wrong(row_, std::string(row_.arguments[i].name) + " is missing");
      argument = i + 1;
      word = at + 1;
    }
    if (auto done = assign(argument, row_.arguments.size(), word, words_.size()); !done) return done.error();
    if (auto done = check_all(); !done) return done.error();
    for (ArgumentValue& option : options_) request_.values.push_back(std::move(option));
    return std::move(request_);
  }

 private:
  Result<void> take_options() {
    std::vector<std::string> rest;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (!words_[i].starts_with("--")) {
        rest.push_back(words_[i]);
        continue;
      }
      const std::size_t equals = words_[i].find('=');
      const std::string name = words_[i].substr(0, equals);
      const auto option = std::find_if(row_.options.begin(), row_.options.end(),
                                       [&](const Option& o) { return o && o.name == name; });
      if (option == row_.options.end() || (equals != std::string::npos && option->count() != 1))
        return wrong(row_, "no option " + clean(words_[i], 32));
      ArgumentValue value{option->name, {}, {}};
      for (std::size_t v = 0; v < option->count(); ++v) {
        if (equals == std::string::npos && ++i == words_.size())
          return wrong(row_, name + " wants " + std::string(option->values[v].name));
        const std::string& word = words_[i];
        Argument argument = option->values[v];
        if (option->count() == 1) argument.name = option->name;
        if (auto done = put(value, argument, equals == std::string::npos ? word : word.substr(equals + 1));
            !done)
          return done.error();
      }
      std::erase_if(options_, [&](const ArgumentValue& given) { return given.name == value.name; });
      options_.push_back(std::move(value));
    }
    words_ = std::move(rest);
    return {};
  }

  /// Assigns the words [from, to) to the arguments [begin, end); the optional arguments take the words that
  /// are left.
  Result<void> assign(std::size_t begin, std::size_t end, std::size_t from, std::size_t to) {
    std::size_t min_words = 0, max_words = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Argument& argument = row_.arguments[i];
      if (!argument) continue;
      if (to - from >= min_words && to - from < min_words + std::size_t{argument.min_count} * argument.group)
        missing_ = named(argument);
      min_words += std::size_t{argument.min_count} * argument.group;
      max_words += std::size_t{argument.max_count} * argument.group;
    }
    if (to - from < min_words) return wrong(row_, missing_ + " is missing");
    if (to - from > max_words)
      return wrong(row_,
                   takes(row_) + (max_words == 0 ? "" : ", not " + std::to_string(to - from) + " words"));
    std::size_t spare = to - from - min_words;
    for (std::size_t i = begin; i < end; ++i) {
      const Argument& argument = row_.arguments[i];
      if (!argument) continue;
      std::size_t extra =
          std::min(spare, (std::size_t{argument.max_count} - argument.min_count) * argument.group) /
          argument.group;
      // Words that follow an optional number as a text may begin where the number was left out.
      const bool before_text = i + 1 < end && row_.arguments[i + 1].type == Type::text;
      if (double number = 0.0; argument.type == Type::number && before_text && argument.min_count == 0 &&
                               extra > 0 && !to_number(words_[from], number))
        extra = 0;
      spare -= extra * argument.group;
      const std::size_t count = (argument.min_count + extra) * argument.group;
      const auto begin_of = words_.begin() + static_cast<std::ptrdiff_t>(from);
      const auto end_of = begin_of + static_cast<std::ptrdiff_t>(count);
      if (argument.all != AllRobots::refused && std::find(begin_of, end_of, "all") != end_of) {
        request_.all = true;  // Robot names beside it change nothing.
        from += count;
        continue;
      }
      ArgumentValue value{argument.name, {}, {}};
      for (std::size_t n = count; n > 0; --n)
        if (auto done = put(value, argument, words_[from++]); !done) return done;
      if (!value.words.empty() || !value.numbers.empty()) request_.values.push_back(std::move(value));
    }
    return spare > 0 ? Result<void>(wrong(row_, "its numbers come in pairs")) : Result<void>();
  }

  /// Refuses `all` where it would move robots.
  Result<void> check_all() const {
    const std::string_view only = row_.arguments[0].all_only;
    if (!request_.all || only.empty() || request_.values.back().words.back() == only) return {};
    return wrong(row_, "all goes with " + std::string(only) + " only; name the robots");
  }

  Result<void> put(ArgumentValue& value, const Argument& argument, const std::string& word) {
    if (argument.type == Type::robots) {
      if (word == "all")
        return wrong(row_,
                     std::string("it does not take all: ") + (argument.min_count == 0  ? "leave it out"
                                                              : argument.max_count > 1 ? "name each robot"
                                                                                       : "name one robot"));
      if (auto checked = check_word(row_, argument, word); !checked) return checked;
      auto& robots = request_.robots;
      if (argument.distinct && std::find(robots.begin(), robots.end(), word) != robots.end())
        return wrong(row_, word + " is named twice");
      if (std::find(robots.begin(), robots.end(), word) == robots.end()) robots.push_back(word);
      return {};
    }
    if (argument.type != Type::number) {
      value.words.push_back(word);
      return check_word(row_, argument, word);
    }
    double number = 0.0;
    if (!argument.unlimited.empty() && word == argument.unlimited)
      number = std::numeric_limits<double>::infinity();
    else if (!to_number(word, number))
      return wrong(row_, std::string(argument.name) + " is a number, not '" + clean(word, 32) + "'");
    value.numbers.push_back(number);
    return check_number(row_, argument, number);
  }

  const CommandInfo& row_;
  std::vector<std::string> words_;
  Request request_{};
  std::vector<ArgumentValue> options_{};
  std::string missing_{};
};

/// Of the rows with the same first word, returns the one whose keyword was typed first, else the one without
/// a keyword.
Result<const CommandInfo*> choose(const std::vector<const CommandInfo*>& found,
                                  const std::vector<std::string>& words) {
  const CommandInfo *plain = nullptr, *meant = nullptr;
  auto first = words.end();
  std::string expected;
  for (const CommandInfo* row : found) {
    const std::string_view keyword = row->name.substr(row->first_word().size());
    if (keyword.empty()) {
      plain = row;
      continue;
    }
    const auto at = std::find(words.begin() + 1, first, keyword.substr(1));
    if (at != first) {
      first = at;
      meant = row;
    }
    expected += (expected.empty() ? "" : " or ") + std::string(keyword.substr(1));
  }
  if (meant != nullptr) return meant;
  if (plain != nullptr) return plain;
  const std::string name(found.front()->first_word());
  return Error{Reason::bad_argument, name + ": " + expected + " is missing; try help " + name};
}

}  // namespace

Result<Request> parse(const std::vector<std::string>& words, Table rows) {
  if (words.empty()) return {Reason::syntax, "no command; try help"};
  const auto found = find_commands(words.front(), rows);
  if (found.empty()) {
    const std::string meant = nearest(words.front(), command_names(rows));
    return {Reason::unknown_command, "unknown command '" + clean(words.front(), 40) + "'" +
                                         (meant.empty() ? "; try help" : ", did you mean " + meant + "?")};
  }
  auto row = choose(found, words);
  if (!row) return row.error();
  auto request = Reader(**row, {words.begin() + 1, words.end()}).run();
  if (request) request->verb = static_cast<Verb>(*row - rows.data());
  return request;
}

Result<Request> parse(std::string_view line, Table rows) {
  auto words = split_words(line);
  if (!words) return words.error();
  return parse(*words, rows);
}

}  // namespace adit::command
