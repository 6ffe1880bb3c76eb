// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "core/store/crc32c.hpp"
#include "perception/camera/stripe_encoder.hpp"
#include "perception/camera/stripe_store.hpp"
#include "tests/perception/camera/pictures.hpp"

namespace adit::perception {
namespace {

PictureHeader full_header() {
  PictureHeader header;
  header.run = 0x12345678;
  header.frame = 9;
  header.format = {321, 241, true, 35, 4};
  header.stamp = 0x0123456789abcdefu;
  header.age = 120;
  header.digest = 77;
  header.pieces = 3;
  header.number = 2;
  header.pose = CameraPose{{1.0f, -2.0f, 0.5f}, {0.0f, 0.6f, 0.0f, 0.8f}};
  return header;
}

PicturePiece two_stripes() {
  return {full_header(), {{3, {1, 2, 0xff, 0x00, 5}}, {80, std::vector<std::uint8_t>(400, 9)}}};
}

std::vector<std::uint8_t> with_checksum(std::vector<std::uint8_t> bytes) {
  bytes.resize(bytes.size() - 4);
  const std::uint32_t sum = crc32c(bytes);
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
  return bytes;
}

Reason reason_of(const PicturePiece& piece) { return decode_picture_piece(encode(piece)).reason(); }

TEST(PicturePieces, DecodeToWhatWasEncoded) {
  const PicturePiece piece = two_stripes();
  const auto back = decode_picture_piece(encode(piece));
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(*back, piece);
  PicturePiece empty{full_header(), {}};
  EXPECT_LE(encode(empty).size(), kPictureHeaderBytes);
  empty.header.pose.reset();
  EXPECT_EQ(*decode_picture_piece(encode(empty)), empty);
}

TEST(PicturePieces, RefuseWrongHeaders) {
  EXPECT_EQ(reason_of(two_stripes()), Reason::none);
  const auto refused = [](auto&& change) {
    PicturePiece piece = two_stripes();
    change(piece);
    return reason_of(piece) == Reason::malformed;
  };
  EXPECT_TRUE(refused([](auto& p) { p.header.run = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.frame = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.number = 3; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.pieces = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format.span = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format.span = 22; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format.width = 1921; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format.height = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format.quality = 0; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format.quality = 101; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.format = {1920, 1088, false, 50, 1}; }));
  EXPECT_TRUE(refused([](auto& p) { p.header.pose->position[1] = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(
      refused([](auto& p) { p.header.pose->orientation[1] = std::numeric_limits<float>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](auto& p) { p.header.pose->orientation[3] = 0.0f; }));
}

TEST(PicturePieces, RefuseWrongStripes) {
  const auto refused = [](std::uint16_t index, std::vector<std::uint8_t> data) {
    PicturePiece piece{full_header(), {{5, {1}}, {index, std::move(data)}}};
    return reason_of(piece) == Reason::malformed;
  };
  EXPECT_FALSE(refused(6, {0xff, 0x00}));
  EXPECT_TRUE(refused(5, {1}));
  EXPECT_TRUE(refused(4, {1}));
  EXPECT_TRUE(refused(static_cast<std::uint16_t>(full_header().format.stripes()), {1}));
  EXPECT_TRUE(refused(6, {}));
  for (const std::uint8_t marker : {0x01, 0xc4, 0xd0, 0xd7, 0xd8, 0xd9, 0xda, 0xff})
    EXPECT_TRUE(refused(6, {7, 0xff, marker, 0x00}));
  EXPECT_TRUE(refused(6, {7, 0xff}));
  EXPECT_TRUE(refused(6, std::vector<std::uint8_t>(1200, 1)));
}

TEST(PicturePieces, RefuseDamageAndOtherVersions) {
  const auto bytes = encode(two_stripes());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_picture_piece(std::span(bytes).first(size)));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(decode_picture_piece(damaged)) << i;
  }
  auto later = bytes;
  ++later[0];
  EXPECT_EQ(decode_picture_piece(with_checksum(later)).reason(), Reason::not_supported);
}

TEST(PicturePieces, MutationsAreRefusedOrHarmless) {
  StripeEncoder encoder;
  const auto coded = encoder.encode(pictures::textured(96, 64, 3), {96, 64, true, 40, 0}, 200, Time{});
  PictureHeader header;
  header.run = header.frame = 1;
  header.format = coded.format;
  std::vector<std::vector<std::uint8_t>> valid;
  for (const PicturePiece& piece : cut(header, coded.stripes, 500)) valid.push_back(encode(piece));
  std::minstd_rand random(3);
  int decoded = 0, shown = 0;
  for (int i = 0; i < 2000; ++i) {
    auto bytes = valid[random() % valid.size()];
    for (unsigned n = 1 + random() % 6; n > 0; --n)
      bytes[(random() % 8 != 0 ? 32 : 0) + random() % (bytes.size() - 36)] =
          static_cast<std::uint8_t>(random() >> 6);
    const auto piece = decode_picture_piece(with_checksum(bytes));
    if (!piece) continue;
    ++decoded;
    EXPECT_EQ(*decode_picture_piece(encode(*piece)), *piece);
    StripeStore store;
    for (const auto& good : valid) store.take(*decode_picture_piece(good));
    store.take(*piece);
    StripeStore alone;
    alone.take(*piece);
    if (std::uint32_t{piece->header.format.width} * piece->header.format.height > 20'000) continue;
    EXPECT_TRUE(decode_jpeg_tolerant(store.as_jpeg(), 2000, 2000));
    EXPECT_TRUE(decode_jpeg_tolerant(alone.as_jpeg(), 2000, 2000));
    ++shown;
  }
  EXPECT_GT(decoded, 500);
  EXPECT_GT(shown, 500);
}

}  // namespace
}  // namespace adit::perception
