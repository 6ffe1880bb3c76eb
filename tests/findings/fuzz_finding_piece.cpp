// SPDX-License-Identifier: Apache-2.0
// Pieces of findings as libFuzzer makes them up. Built by tools/fuzz.sh. The first byte says whether the
// piece gets a correct checksum.
#include <cstdlib>

#include "core/findings/finding_piece.hpp"
#include "core/store/crc32c.hpp"

using namespace adit;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  store::Bytes bytes(data + 1, data + size);
  if (data[0] % 4 != 0) {
    if (bytes.empty()) return 0;
    bytes[0] = static_cast<std::uint8_t>(1 + data[0] / 4 % 3);  // The version.
    const std::uint32_t sum = crc32c(bytes);
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
  }
  const auto piece = findings::decode_piece(bytes);
  if (!piece) return 0;
  // What was accepted is valid, and comes back from its bytes.
  if (piece->findings.empty() || piece->findings.size() > findings::FindingPiece::kMaxFindings) std::abort();
  for (const findings::Finding& finding : piece->findings)
    if (!valid(finding) || finding.key.robot != piece->robot || finding.key.owner != piece->owner)
      std::abort();
  const auto back = findings::decode_piece(findings::encode(*piece));
  if (!back || *back != *piece) std::abort();
  return 0;
}
