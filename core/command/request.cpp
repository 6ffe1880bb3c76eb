// SPDX-License-Identifier: Apache-2.0
#include "core/command/request.hpp"

#include <algorithm>
#include <cstdio>

#include "core/command/words.hpp"

namespace adit::command {
namespace {

/// Whether an argument's values are sent to the robot as words.
bool sends_words(const Argument& a) {
  return a.type == Type::name || a.type == Type::file || a.type == Type::choice;
}
bool sends_numbers(const Argument& a) { return a.type == Type::number; }

std::string shown(double number, int decimals) {
  if (!std::isfinite(number)) return "";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, number);
  std::string text(buffer);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

/// A limit in its shortest notation.
std::string shown(double number) {
  std::string text = shown(number, 2);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

/// `field` is a name, for a number with the count of decimals after a point: "MODE", "X.2".
std::string shown(const Request& request, std::string_view field) {
  const std::size_t point = std::min(field.find('.'), field.size());
  const std::string_view name = field.substr(0, point);
  const ArgumentValue* value = request.find(name);
  if (value && !value->words.empty()) return joined(value->words, "");
  return shown(request.number(name), point + 1 < field.size() ? field[point + 1] - '0' : 2);
}

/// Reads the values of a row from a payload, front to back.
class PayloadReader {
 public:
  PayloadReader(const CommandInfo& row, const Payload& payload) : row_(row), payload_(payload) {
    std::size_t words = 0, numbers = 0;
    const auto need = [&](const Argument& a, std::size_t count) {
      if (sends_words(a)) words += count;
      if (sends_numbers(a)) numbers += count;
    };
    for (const Argument& a : row.arguments) need(a, std::size_t{a.min_count} * a.group);
    for (std::size_t i = 0; i < row.options.size(); ++i)
      for (const Argument& a : row.options[i].values)
        if (given(i)) need(a, 1);
    is_complete_ = payload.words.size() >= words && payload.numbers.size() >= numbers;
    spare_words_ = is_complete_ ? payload.words.size() - words : 0;
    spare_numbers_ = is_complete_ ? payload.numbers.size() - numbers : 0;
  }

  Result<Request> run() {
    for (const Argument& argument : row_.arguments)
      if (sends_words(argument) || sends_numbers(argument)) take(argument.name, argument);
    for (std::size_t i = 0; i < row_.options.size(); ++i) {
      if (!given(i)) continue;
      const Option& option = row_.options[i];
      if (!option || option.local) return wrong(row_, "it has an option that this version does not know");
      request_.values.push_back({option.name, {}, {}});
      for (const Argument& value : option.values) take(option.name, value);
    }
    if ((payload_.options >> row_.options.size()) != 0 || !is_complete_ || spare_words_ > 0 ||
        spare_numbers_ > 0)
      return wrong(row_, "it came with arguments that do not fit");
    if (!checked_) return checked_.error();
    request_.info = &row_;
    return std::move(request_);
  }

 private:
  bool given(std::size_t option) const { return (payload_.options >> option & 1U) != 0; }

  void take(std::string_view name, const Argument& argument) {
    if (!is_complete_ || !argument) return;
    std::size_t count = std::size_t{argument.min_count} * argument.group;
    std::size_t& spare = sends_words(argument) ? spare_words_ : spare_numbers_;
    const std::size_t extra =
        std::min(spare / argument.group, std::size_t{argument.max_count} - argument.min_count);
    spare -= extra * argument.group;
    count += extra * argument.group;
    if (count == 0) return;
    if (request_.values.empty() || request_.values.back().name != name)
      request_.values.push_back({name, {}, {}});
    ArgumentValue& value = request_.values.back();
    for (std::size_t i = 0; i < count; ++i) {
      if (sends_words(argument)) {
        value.words.push_back(payload_.words[next_word_++]);
        if (checked_) checked_ = check_word(row_, argument, value.words.back());
      } else {
        value.numbers.push_back(payload_.numbers[next_number_++]);
        if (checked_) checked_ = check_number(row_, argument, value.numbers.back());
      }
    }
  }

  const CommandInfo& row_;
  const Payload& payload_;
  Request request_{};
  Result<void> checked_{};
  bool is_complete_{false};
  std::size_t spare_words_{}, spare_numbers_{}, next_word_{}, next_number_{};
};

}  // namespace

const ArgumentValue* Request::find(std::string_view name) const {
  const auto found =
      std::find_if(values.begin(), values.end(), [&](const ArgumentValue& v) { return v.name == name; });
  return found == values.end() ? nullptr : &*found;
}

std::string Request::word(std::string_view name) const {
  const ArgumentValue* value = find(name);
  return value && !value->words.empty() ? value->words.front() : std::string{};
}

double Request::number(std::string_view name) const {
  const ArgumentValue* value = find(name);
  if (value && !value->numbers.empty()) return value->numbers.front();
  for (const Option& option : info->options)
    if (option && option.name == name) return option.preset;
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> Request::numbers(std::string_view name) const {
  const ArgumentValue* value = find(name);
  return value ? value->numbers : std::vector<double>{};
}

Payload pack(const Request& request) {
  const CommandInfo& row = *request.info;
  Payload out{.number = row.number};
  const auto put = [&](std::string_view name) {
    const ArgumentValue* value = request.find(name);
    if (!value) return false;
    out.words.insert(out.words.end(), value->words.begin(), value->words.end());
    out.numbers.insert(out.numbers.end(), value->numbers.begin(), value->numbers.end());
    return true;
  };
  for (const Argument& argument : row.arguments)
    if (argument) put(argument.name);
  for (std::size_t i = 0; i < row.options.size(); ++i)
    if (row.options[i] && !row.options[i].local && put(row.options[i].name))
      out.options = static_cast<std::uint16_t>(out.options | 1U << i);
  return out;
}

Result<Request> unpack(const Payload& payload, Table rows) {
  const CommandInfo* row = find_number(payload.number, rows);
  if (!row)
    return {Reason::unknown_command,
            "this version has no command of number " + std::to_string(payload.number)};
  auto request = PayloadReader(*row, payload).run();
  if (request) request->verb = static_cast<Verb>(row - rows.data());
  return request;
}

std::string done_text(const Request& request) {
  std::string_view pattern = request.info->done;
  for (const Option& option : request.info->options)
    if (option && !option.done.empty() && request.has(option.name)) pattern = option.done;
  if (pattern.empty()) return "done";
  std::string out;
  for (std::size_t at = 0; at < pattern.size();) {
    const std::size_t open = std::min(pattern.find('{', at), pattern.size());
    const std::size_t close = std::min(pattern.find('}', open), pattern.size());
    out += pattern.substr(at, open - at);
    if (open < close) out += shown(request, pattern.substr(open + 1, close - open - 1));
    at = std::min(close + 1, pattern.size());
  }
  return out;
}

Result<void> check_word(const CommandInfo& command, const Argument& argument, const std::string& word) {
  const std::string quoted = "'" + clean(word, 40) + "'";
  if (argument.type == Type::name || argument.type == Type::robots) {
    if (valid_name(word)) return {};
    Error error = wrong(command, quoted + " cannot be " + std::string(argument.what) +
                                     "'s name (1 to 32 of A-Z a-z 0-9 _ -)");
    error.reason = argument.refusal;
    return error;
  }
  if (argument.type != Type::choice) return {};
  const std::vector<std::string> all = choices(argument);
  if (std::find(all.begin(), all.end(), word) != all.end()) return {};
  if (all.size() == 2) return wrong(command, quoted + " is neither " + all[0] + " nor " + all[1]);
  const std::string meant = nearest(word, all);
  return {argument.refusal,
          std::string(command.name) + ": " + quoted + " is not " + std::string(argument.what) +
              (meant.empty() ? "" : ", did you mean " + meant + "?") + " (" + joined(all, "") + ")"};
}

Result<void> check_number(const CommandInfo& command, const Argument& argument, double number) {
  const auto out_of_range = [&](const std::string& text) -> Error {
    return {Reason::out_of_range, std::string(command.name) + ": " + std::string(argument.name) + " " + text};
  };
  if (std::isinf(number) && number > 0.0 && !argument.unlimited.empty()) return {};
  if (!std::isfinite(number)) return out_of_range("is a finite number");
  if (argument.minimum == -argument.maximum && std::abs(number) > argument.maximum)
    return out_of_range("is at most " + shown(argument.maximum) + " either way");
  if (number > argument.maximum) return out_of_range("is at most " + shown(argument.maximum));
  if (argument.above && number <= argument.minimum)
    return out_of_range("is more than " + shown(argument.minimum));
  if (number < argument.minimum) return out_of_range("is at least " + shown(argument.minimum));
  return {};
}

Error wrong(const CommandInfo& command, const std::string& what) {
  return {Reason::bad_argument, std::string(command.name) + ": " + what + "; usage: " + usage(command)};
}

}  // namespace adit::command
