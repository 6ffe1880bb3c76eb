// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/rtps_guard.hpp"

#include <cstring>

namespace adit::wire {

std::span<const std::uint8_t> without_vendor_kinds(std::span<const std::uint8_t> message,
                                                   std::vector<std::uint8_t>& copy) {
  constexpr std::size_t kHeader = 20, kSubmessageHeader = 4;
  constexpr std::uint8_t kPad = 0x01, kInfoTimestamp = 0x09, kFirstVendorKind = 0x80;
  if (message.size() < kHeader || std::memcmp(message.data(), "RTPS", 4) != 0) return {};
  copy.clear();
  std::size_t wanted = kHeader;  // Bytes from the begin of the message without a vendor's submessage.
  std::size_t at = kHeader;
  while (message.size() - at >= kSubmessageHeader) {
    const std::uint8_t kind = message[at];
    const bool little = (message[at + 1] & 1) != 0;
    std::size_t length =
        little ? message[at + 2] | message[at + 3] << 8 : message[at + 3] | message[at + 2] << 8;
    const std::size_t rest = message.size() - at - kSubmessageHeader;
    if (length > rest) break;  // Truncated: the library stops here, too.
    // Length 0 means up to the end of the message, but of these two kinds it means an empty body.
    if (length == 0 && kind != kPad && kind != kInfoTimestamp) length = rest;
    if (length % 4 != 0 && length != rest) return {};
    const std::size_t end = at + kSubmessageHeader + length;
    if (kind < kFirstVendorKind) {
      if (wanted == at) {
        wanted = end;
      } else {
        if (copy.empty()) copy.assign(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(wanted));
        copy.insert(copy.end(), message.begin() + static_cast<std::ptrdiff_t>(at),
                    message.begin() + static_cast<std::ptrdiff_t>(end));
      }
    }
    at = end;
  }
  return copy.empty() ? message.first(wanted) : std::span<const std::uint8_t>(copy);
}

}  // namespace adit::wire
