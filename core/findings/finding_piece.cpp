// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding_piece.hpp"

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"

namespace adit::findings {
namespace {

constexpr std::uint8_t kVersion = 2;
constexpr std::size_t kChecksum = 4;
constexpr std::size_t kRobot = 32;
constexpr std::uint64_t kMaxChange = (std::uint64_t{1} << 33) - 1;

/// Revision and flag as one number, short while the revision is small.
std::uint64_t change_of(const Finding& f) {
  return std::uint64_t{f.revision} << 1 | static_cast<std::uint64_t>(f.withdrawn);
}

std::size_t varint_size(std::uint64_t value) {
  std::size_t size = 1;
  for (; value >= 0x80; value >>= 7) ++size;
  return size;
}

Error malformed(const char* what) { return {Reason::malformed, std::string("a piece of findings: ") + what}; }

}  // namespace

std::size_t encoded_head(const std::string& robot) { return 1 + 2 + robot.size() + 4 + 4 + 2 + kChecksum; }

std::size_t encoded_size(const Finding& f) {
  return 8 + varint_size(change_of(f)) + 2 + f.kind.size() + 1 + 3 * 8 + 8 + 2 + f.text.size() + 2 +
         f.data.size();
}

store::Bytes encode(const FindingPiece& piece) {
  store::Packer out;
  out.put(kVersion).text(piece.robot).put(piece.stored).put(piece.overflowed);
  out.put(static_cast<std::uint16_t>(piece.findings.size()));
  for (const Finding& f : piece.findings) {
    out.put(f.key.id).varint(change_of(f)).text(f.kind).put(f.importance);
    for (const double value : f.position) out.put(value);
    out.put(f.stamp).text(f.text).put(static_cast<std::uint16_t>(f.data.size())).raw(f.data);
  }
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

Result<FindingPiece> decode_piece(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > FindingPiece::kMaxBytes) return malformed("empty, or too long");
  if (bytes[0] == 0 || bytes[0] > kVersion)
    return {Reason::wrong_protocol, "a piece of findings has another version"};
  if (bytes.size() <= kChecksum) return malformed("too short");
  const auto content = bytes.first(bytes.size() - kChecksum);
  if (store::Unpacker(bytes.last(kChecksum)).get<std::uint32_t>() != crc32c(content))
    return malformed("damaged");
  store::Unpacker in(content.subspan(1));
  FindingPiece piece;
  piece.robot = in.text(kRobot);
  piece.stored = in.get<std::uint32_t>();
  piece.overflowed = in.get<std::uint32_t>();
  const std::size_t count = in.count(FindingPiece::kMaxFindings);
  if (!in.good() || count == 0) return malformed("no findings, or too many");
  for (std::size_t i = 0; i < count; ++i) {
    Finding f{};
    f.key = {piece.robot, in.get<std::uint64_t>()};
    if (bytes[0] > 1) {
      const std::uint64_t change = in.varint();
      if (change > kMaxChange) return malformed("a revision is too large");
      f.revision = static_cast<std::uint32_t>(change >> 1);
      f.withdrawn = (change & 1) != 0;
    }
    f.kind = in.text(Finding::kKind);
    f.importance = in.get<std::uint8_t>();
    for (double& value : f.position) value = in.number();
    f.stamp = in.get<std::uint64_t>();
    f.text = in.text(Finding::kText);
    const auto data = in.bytes(Finding::kData);
    f.data.assign(data.begin(), data.end());
    if (!in.good() || !valid(f)) return malformed("a finding is truncated, or not valid");
    piece.findings.push_back(std::move(f));
  }
  if (!in.done()) return malformed("bytes behind its end");
  return piece;
}

}  // namespace adit::findings
