// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding_piece.hpp"

#include "core/findings/finding_fields.hpp"
#include "core/store/crc32c.hpp"

namespace adit::findings {
namespace {

constexpr std::size_t kChecksum = 4;
constexpr std::size_t kRobot = 32;
Error malformed(const char* what) { return {Reason::malformed, std::string("a piece of findings: ") + what}; }

}  // namespace

std::size_t encoded_head(const std::string& robot) {
  return 1 + 2 + robot.size() + std::tuple_size_v<Owner> + 4 + 4 + 2 + kChecksum;
}

std::size_t encoded_size(const Finding& f) { return packed_size(f); }

store::Bytes encode(const FindingPiece& piece) {
  store::Packer out;
  out.put(kVersion).text(piece.robot).put(piece.owner).put(piece.stored).put(piece.overflowed);
  out.put(static_cast<std::uint16_t>(piece.findings.size()));
  for (const Finding& f : piece.findings) pack_fields(out, f);
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

Result<FindingPiece> decode_piece(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > FindingPiece::kMaxBytes) return malformed("empty, or too long");
  if (bytes[0] < kFirstVersion || bytes[0] > kVersion)
    return {Reason::wrong_protocol, "a piece of findings has another version"};
  if (bytes.size() <= kChecksum) return malformed("too short");
  const auto content = bytes.first(bytes.size() - kChecksum);
  if (store::Unpacker(bytes.last(kChecksum)).get<std::uint32_t>() != crc32c(content))
    return malformed("damaged");
  store::Unpacker in(content.subspan(1));
  FindingPiece piece;
  piece.robot = in.text(kRobot);
  if (bytes[0] == kVersion) piece.owner = in.array<std::tuple_size_v<Owner>>();
  piece.stored = in.get<std::uint32_t>();
  piece.overflowed = in.get<std::uint32_t>();
  const std::size_t count = in.count(FindingPiece::kMaxFindings);
  if (!in.good() || count == 0) return malformed("no findings, or too many");
  for (std::size_t i = 0; i < count; ++i) {
    Finding f{};
    unpack_fields(in, bytes[0], f);
    f.key.robot = piece.robot;
    f.key.owner = piece.owner;
    if (!in.good() || !valid(f)) return malformed("a finding is truncated, or not valid");
    piece.findings.push_back(std::move(f));
  }
  if (!in.done()) return malformed("bytes behind its end");
  return piece;
}

}  // namespace adit::findings
