// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/photo_bytes.hpp"

#include <algorithm>
#include <charconv>

#include "basestation/model/json_reader.hpp"
#include "core/findings/photo.hpp"

namespace adit::station {

using findings::PhotoPart;

namespace {

constexpr std::string_view kBase64 = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

Error not_base64() { return {Reason::malformed, "a photo's bytes are no base64"}; }

}  // namespace

std::string base64_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = (bits << 8) | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kBase64[(bits >> (18 - 6 * k)) & 63] : '=';
  }
  return text;
}

Result<store::Bytes> bytes_of_base64(std::string_view text) {
  if (text.size() % 4 != 0) return not_base64();
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  store::Bytes bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool pad = i >= text.size() - padding;
    const std::size_t value = pad ? 0 : kBase64.find(text[i]);
    if (value == std::string_view::npos) return not_base64();
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    if (i % 4 != 3) continue;
    for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    bits = 0;
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

std::string_view word_of(PhotoPart part) { return part == PhotoPart::picture ? "picture" : "thumbnail"; }

std::optional<PhotoPart> photo_part_from(std::string_view word) {
  for (const PhotoPart part : {PhotoPart::thumbnail, PhotoPart::picture})
    if (word == word_of(part)) return part;
  return std::nullopt;
}

std::optional<std::uint64_t> photo_id_from(std::string_view text) {
  std::uint64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
  if (text.size() != 16 || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return id;
}

nlohmann::json photo_json(std::span<const std::uint8_t> jpeg) { return {{"jpeg", base64_of(jpeg)}}; }

Result<store::Bytes> photo_of(const CommandOutcome& outcome) {
  if (outcome.exit_code != kExitDone) return {Reason::no_answer, outcome.error};
  const auto object = nlohmann::json::parse(outcome.json, nullptr, false);
  std::string wrong, jpeg;
  JsonReader in(object, wrong);
  in.read("jpeg", jpeg);
  if (!wrong.empty()) return {Reason::malformed, "a photo's '" + wrong + "' does not fit"};
  if (const auto readable = findings::check_photo_size(jpeg.size() / 4 * 3); !readable)
    return readable.error();
  return bytes_of_base64(jpeg);
}

}  // namespace adit::station
