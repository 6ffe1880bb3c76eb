// SPDX-License-Identifier: Apache-2.0
// Datagrams on a radio domain as libFuzzer makes them up. Built by tools/fuzz.sh. The first byte of each
// datagram says from whom it comes and how long it is.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/wire/fastdds/rtps_guard.hpp"
#include "core/wire/fastdds/rtps_submessage.hpp"
#include "tests/wire/kept_datagrams.hpp"
#include "tests/wire/rtps_messages.hpp"

using namespace adit;
using namespace adit::wire;

namespace {

const ParticipantId kFuzzed = test::participant(1), kPeer = test::participant(2);
constexpr std::uint32_t kPeerWriter = 0x00000103;

void check(bool holds) {
  if (!holds) std::abort();
}

void write_seed(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// What passed consists of complete submessages of known kinds that carry what they say.
void check_passed(std::span<const std::uint8_t> passed) {
  check(rtps_bytes::has_header(passed));
  for (std::size_t at = rtps_bytes::kHeader; at + 4 <= passed.size();) {
    const std::uint8_t kind = passed[at];
    const std::size_t length = rtps_bytes::half(passed, at + 2, (passed[at + 1] & 1) != 0);
    if (at + 4 + length > passed.size()) return;  // Truncated: the library stops here.
    check(kind < 0x30);
    if (length == 0 && kind != rtps_bytes::kPad && kind != rtps_bytes::kInfoTimestamp) return;
    at += 4 + length;
  }
}

void write_seeds(const std::filesystem::path& folder) {
  using namespace test;
  const std::vector<Bytes> messages{
      rtps_message(kPeer, {announcement(kPeer, {locator("10.0.0.2", 7410), locator("10.0.0.9", 7410)})}),
      rtps_message(kPeer,
                   {destination(kFuzzed), endpoint(kPublications, kPeer, kPeerWriter, "adit/health", 1)}),
      rtps_message(kPeer, {fragment(kPeerWriter, 1, 1, 1, 1000, 4000, 100), heartbeat(kPeerWriter, 1, 9)}),
      rtps_message(kPeer, {gap(kPeerWriter, 1, 9), submessage(0x80, Bytes(56)), goodbye(kPeer)})};
  for (std::size_t i = 0; i < messages.size(); ++i) {
    Bytes seed{0};
    seed.insert(seed.end(), messages[i].begin(), messages[i].end());
    write_seed(folder / ("seed" + std::to_string(i)), seed);
  }
  const auto kept = kept_datagrams("tests/wire/datagrams.corpus");
  for (std::size_t i = 0; i < kept.size(); ++i) write_seed(folder / ("kept" + std::to_string(i)), kept[i]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool wrote = [] {
    if (const char* folder = std::getenv("ADIT_FUZZ_SEEDS")) write_seeds(folder);
    return true;
  }();
  (void)wrote;
  RtpsGuard radio, inner;
  radio.set({true, {}, {}, {}});
  Duration now{};
  std::span<const std::uint8_t> rest(data, size);
  while (!rest.empty()) {
    const std::uint8_t head = rest[0];
    rest = rest.subspan(1);
    const std::size_t length = head < 16 ? rest.size() : std::min<std::size_t>(rest.size(), head * 2U);
    const auto message = rest.first(length);
    rest = rest.subspan(length);
    now += std::chrono::milliseconds(head * 10);
    for (RtpsGuard* guard : {&radio, &inner}) {
      std::vector<std::uint8_t> copy;
      const auto passed = guard->pass(message, {0x0200000aU + head % 2U, 40000}, kFuzzed, now, copy);
      check(passed.size() <= message.size());
      if (!passed.empty()) check_passed(passed);
    }
    (void)radio.may_send(0x0200000a, 7410, 1000, now);
  }
  return 0;
}
