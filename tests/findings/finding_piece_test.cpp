// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding_piece.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"
#include "core/time/random.hpp"
#include "tests/findings/some.hpp"

namespace adit::findings {
namespace {

FindingPiece some_piece(std::size_t count = 3) {
  FindingPiece piece{"r1", 7, 2, {}, {}};
  for (std::size_t id = 1; id <= count; ++id) piece.findings.push_back(some(id));
  return piece;
}

/// The bytes with another checksum, as somebody who means harm would send them.
store::Bytes sealed(store::Bytes bytes) {
  const std::uint32_t sum = crc32c(std::span(bytes).first(bytes.size() - 4));
  for (std::size_t i = 0; i < 4; ++i) bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  return bytes;
}

TEST(FindingPiece, ComesBackFromItsBytes) {
  const store::Bytes bytes = encode(some_piece());
  const auto back = decode_piece(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(*back, some_piece());
  EXPECT_EQ(bytes.size(), encoded_head("r1") + 3 * encoded_size(some(1)));
}

/// As releases before revisions (version 1) and before owners (version 2) wrote it.
store::Bytes piece_of_version(std::uint8_t version, const FindingPiece& piece) {
  store::Packer out;
  out.put(version).text(piece.robot).put(piece.stored).put(piece.overflowed);
  out.put(static_cast<std::uint16_t>(piece.findings.size()));
  for (const Finding& f : piece.findings) {
    out.put(f.key.id);
    if (version == 2) out.varint(std::uint64_t{f.revision} << 1 | static_cast<std::uint64_t>(f.withdrawn));
    out.text(f.kind).put(f.importance);
    for (const double value : f.position) out.put(value);
    out.put(f.stamp).text(f.text).put(static_cast<std::uint16_t>(f.data.size())).raw(f.data);
  }
  const std::uint32_t sum = crc32c(out.bytes());
  return out.put(sum).bytes();
}

TEST(FindingPiece, HasTheRevisionOfEachFinding) {
  FindingPiece piece = some_piece(4);
  piece.findings[1].revision = 15;
  piece.findings[2].revision = 16;
  piece.findings[2].withdrawn = true;
  piece.findings[3].revision = std::numeric_limits<std::uint32_t>::max();
  piece.findings[3].withdrawn = true;
  std::size_t size = encoded_head("r1");
  for (const Finding& f : piece.findings) size += encoded_size(f);
  const store::Bytes bytes = encode(piece);
  EXPECT_EQ(bytes.size(), size);
  EXPECT_EQ(decode_piece(bytes).value(), piece);
  EXPECT_EQ(encoded_size(piece.findings[1]), encoded_size(piece.findings[0])) << "one byte below 16";
}

TEST(FindingPiece, OfVersion1HasRevision0) {
  const store::Bytes bytes = piece_of_version(1, some_piece());
  EXPECT_EQ(bytes.size() + 3 + sizeof(Owner), encode(some_piece()).size());
  EXPECT_EQ(decode_piece(bytes).value(), some_piece());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(decode_piece(std::span(bytes).first(size)).reason(), Reason::malformed) << size;
}

TEST(FindingPiece, OfVersion2HasNoOwner) {
  FindingPiece piece = some_piece();
  piece.findings[0].revision = 63;
  piece.findings[1].revision = std::numeric_limits<std::uint32_t>::max();
  piece.findings[1].withdrawn = true;
  const store::Bytes bytes = piece_of_version(2, piece);
  EXPECT_EQ(decode_piece(bytes).value(), piece);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(decode_piece(std::span(bytes).first(size)).reason(), Reason::malformed) << size;
}

FindingPiece owned_piece() {
  FindingPiece piece = some_piece();
  for (std::size_t i = 0; i < piece.owner.size(); ++i) piece.owner[i] = static_cast<std::uint8_t>(i + 1);
  for (Finding& f : piece.findings) f.key.owner = piece.owner;
  piece.findings[0].anchor = {0x123456789abcdef0, 300, {1.5f, -2.0f, 0.25f}, -3.0f};
  piece.findings[1].photo = {0xfedcba9876543210, PhotoRef::kMaxBytes, PhotoRef::kMaxThumbnail};
  piece.findings[2].anchor = {1, UINT32_MAX, {0, 0, Anchor::kFarthest}, 0.0f};
  piece.findings[2].photo = {1, 1, 0};
  return piece;
}

TEST(FindingPiece, HasOwnerAnchorsAndPhotos) {
  const FindingPiece piece = owned_piece();
  const store::Bytes bytes = encode(piece);
  EXPECT_EQ(decode_piece(bytes).value(), piece);
  std::size_t size = encoded_head("r1");
  for (const Finding& f : piece.findings) size += encoded_size(f);
  EXPECT_EQ(bytes.size(), size);
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    EXPECT_EQ(decode_piece(std::span(bytes).first(cut)).reason(), Reason::malformed) << cut;
    if (cut > 8) {
      const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(cut);
      EXPECT_EQ(decode_piece(sealed(store::Bytes(bytes.begin(), end))).reason(), Reason::malformed) << cut;
    }
  }
}

TEST(FindingPiece, WithAnAnchorOrAPhotoOutOfBoundsIsRefused) {
  const auto refused = [](const auto& spoil) {
    FindingPiece piece = owned_piece();
    spoil(piece.findings[2]);
    return decode_piece(encode(piece)).reason() == Reason::malformed;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([&](Finding& f) { f.anchor->offset[1] = nan; }));
  EXPECT_TRUE(refused([&](Finding& f) { f.anchor->offset[0] = -1.01f * Anchor::kFarthest; }));
  EXPECT_TRUE(refused([&](Finding& f) { f.anchor->yaw = nan; }));
  EXPECT_TRUE(refused([&](Finding& f) { f.photo->content = 0; }));
  EXPECT_TRUE(refused([&](Finding& f) { f.photo->bytes = 0; }));
  EXPECT_TRUE(refused([&](Finding& f) { f.photo->bytes = PhotoRef::kMaxBytes + 1; }));
  EXPECT_TRUE(refused([&](Finding& f) { f.photo->thumbnail = PhotoRef::kMaxThumbnail + 1; }));
  EXPECT_FALSE(refused([](Finding&) {}));
}

TEST(FindingPiece, WithATooLargeRevisionIsRefused) {
  store::Bytes bytes = encode(some_piece(1));
  const std::size_t at = encoded_head("r1") - 4 + 8;
  ASSERT_EQ(bytes[at], 0);
  bytes[at] = 0x80;
  const store::Bytes more{0x80, 0x80, 0x80, 0x80, 0x01};  // Bit 35.
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 1, more.begin(), more.end());
  EXPECT_EQ(decode_piece(sealed(bytes)).reason(), Reason::malformed);
}

TEST(FindingPiece, TheLargestFindingFitsAlone) {
  Finding largest = some(std::numeric_limits<std::uint64_t>::max());
  largest.key.robot = std::string(32, 'r');
  largest.kind = std::string(Finding::kKind, 'k');
  largest.text = std::string(Finding::kText, 't');
  largest.data.assign(Finding::kData, 9);
  largest.revision = std::numeric_limits<std::uint32_t>::max();
  largest.anchor = {1, UINT32_MAX, {1, 2, 3}, 1.0f};
  largest.photo = {1, 1, 1};
  EXPECT_EQ(encoded_size(largest), 655U);
  const FindingPiece piece{largest.key.robot, 1, 0, {largest}, {}};
  const store::Bytes bytes = encode(piece);
  EXPECT_LE(bytes.size(), FindingPiece::kMaxBytes);
  EXPECT_EQ(decode_piece(bytes).value(), piece);
}

TEST(FindingPiece, ThatIsCutIsRefusedAtEachLength) {
  const store::Bytes bytes = encode(some_piece());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(decode_piece(std::span(bytes).first(size)).reason(), Reason::malformed) << size;
    store::Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    if (size > 8) {
      EXPECT_EQ(decode_piece(sealed(cut)).reason(), Reason::malformed) << size;
    }
  }
}

TEST(FindingPiece, OfAnotherVersionIsNotGuessed) {
  for (const std::uint8_t version : {0, 4, 255}) {
    store::Bytes bytes = encode(some_piece());
    bytes[0] = version;
    EXPECT_EQ(decode_piece(sealed(bytes)).reason(), Reason::wrong_protocol) << int{version};
  }
}

TEST(FindingPiece, WithBytesBehindItsEndIsRefused) {
  store::Bytes bytes = encode(some_piece());
  bytes.push_back(0);
  EXPECT_EQ(decode_piece(sealed(bytes)).reason(), Reason::malformed);
}

TEST(FindingPiece, WithTooLongCountsIsRefused) {
  // Version, robot, owner, stored and overflowed are before the number of findings.
  const std::size_t count_at = 1 + 2 + 2 + 16 + 4 + 4, kind_at = count_at + 2 + 8 + 1;
  const store::Bytes bytes = encode(some_piece());
  for (const std::size_t at : {std::size_t{1}, count_at, kind_at})
    for (const int value : {0, 25, 33, 255}) {
      store::Bytes wrong = bytes;
      wrong[at] = static_cast<std::uint8_t>(value);
      EXPECT_EQ(decode_piece(sealed(wrong)).reason(), Reason::malformed) << at << ": " << value;
      wrong[at + 1] = 255;
      EXPECT_EQ(decode_piece(sealed(wrong)).reason(), Reason::malformed) << at << ": " << value;
    }
  EXPECT_EQ(decode_piece(store::Bytes(5000, 1)).reason(), Reason::malformed);
}

TEST(FindingPiece, WithoutFindingsOrWithOneThatIsNoneIsRefused) {
  EXPECT_EQ(decode_piece(encode({"r1", 0, 0, {}, {}})).reason(), Reason::malformed);
  FindingPiece piece = some_piece();
  piece.findings[1].position[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(decode_piece(encode(piece)).reason(), Reason::malformed);
  piece = some_piece();
  piece.findings[2].key.id = 0;
  EXPECT_EQ(decode_piece(encode(piece)).reason(), Reason::malformed);
  piece = some_piece();
  piece.robot = "../r1";
  EXPECT_EQ(decode_piece(encode(piece)).reason(), Reason::malformed);
}

TEST(FindingPiece, WithADamagedByteIsRefused) {
  const store::Bytes complete = encode(some_piece());
  for (std::size_t at = 1; at < complete.size(); ++at) {
    store::Bytes bytes = complete;
    bytes[at] ^= 0x10;
    EXPECT_EQ(decode_piece(bytes).reason(), Reason::malformed) << at;
  }
}

TEST(FindingPiece, TakesAnyBytes) {
  Random random(1);
  std::vector<store::Bytes> genuine;
  for (std::size_t count = 1; count <= FindingPiece::kMaxFindings; ++count)
    genuine.push_back(encode(some_piece(count)));
  for (int i = 0; i < 20000; ++i) {
    store::Bytes junk = genuine[random.below(genuine.size())];
    for (std::uint64_t edits = 1 + random.below(3); edits > 0; --edits)
      junk[random.below(junk.size())] = static_cast<std::uint8_t>(random.next());
    if (random.chance(0.3)) junk.resize(4 + random.below(junk.size() - 4));
    const auto back = decode_piece(sealed(junk));
    if (!back) continue;
    EXPECT_LE(back->findings.size(), FindingPiece::kMaxFindings);
    for (const Finding& finding : back->findings) {
      EXPECT_TRUE(valid(finding));
      EXPECT_EQ(finding.key.robot, back->robot);
    }
  }
}

}  // namespace
}  // namespace adit::findings
