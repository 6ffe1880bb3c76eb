// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace adit::wire {

/// Returns the part of a received RTPS message that the library may parse: without the submessages that only
/// its vendor's own extensions use (kinds 0x80 and above, RTPS 2.2, 8.3.3.2.1). Fast DDS 2.9 built with
/// statistics ends the process by an assertion when such a submessage is not the last one, and another
/// vendor's participant may send some anywhere. The result is empty when nothing may be parsed: no RTPS
/// header, or a submessage other than the last whose length is no multiple of four, where parsers disagree on
/// what follows.
/// @param copy holds the result where it is no part of `message`.
std::span<const std::uint8_t> without_vendor_kinds(std::span<const std::uint8_t> message,
                                                   std::vector<std::uint8_t>& copy);

}  // namespace adit::wire
