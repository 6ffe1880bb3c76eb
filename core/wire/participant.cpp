// SPDX-License-Identifier: Apache-2.0
#include "core/wire/participant.hpp"

namespace adit::wire {

std::string to_string(const ParticipantId& id) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : id) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

}  // namespace adit::wire
