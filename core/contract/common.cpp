// SPDX-License-Identifier: Apache-2.0
#include "core/contract/common.hpp"

#include "adit/common.h"
#include "core/command/words.hpp"

namespace adit::contract {

radio::Epoch encode(const Epoch& epoch) {
  radio::Epoch out;
  out.start(epoch.start);
  out.counter(epoch.counter);
  return out;
}

Epoch decode(const radio::Epoch& sample) { return {sample.start(), sample.counter()}; }

std::string cleaned_name(std::string_view name) { return command::clean(name, kMaxName); }

std::vector<std::string> cleaned_names(const std::vector<std::string>& words, std::size_t max) {
  std::vector<std::string> out;
  for (const std::string& word : words) {
    if (out.size() == max) break;
    out.push_back(cleaned_name(word));
  }
  return out;
}

std::string clipped(const std::string& text, std::size_t max) {
  return text.size() <= max ? text : text.substr(0, max - 3) + "...";
}

}  // namespace adit::contract
