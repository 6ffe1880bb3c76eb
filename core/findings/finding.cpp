// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/findings/finding_fields.hpp"

namespace adit::findings {
namespace {

constexpr store::StateFormat kFormat{{'F', 'I', 'N', 'D'}, kVersion, 1024};
constexpr const char* kPrefix = "finding-";

bool valid_robot(const std::string& name) {
  return name.size() <= 32 && name.find('.') == std::string::npos && store::valid_file_name(name);
}

bool valid_anchor(const Anchor& anchor) {
  return std::isfinite(anchor.yaw) && std::all_of(anchor.offset.begin(), anchor.offset.end(), [](float v) {
           return std::abs(v) <= Anchor::kFarthest;  // False for NaN.
         });
}

/// Reads what files of version 1 and 2 hold.
void read_old(store::Unpacker& in, std::uint8_t version, Finding& f) {
  f.key.id = in.get<std::uint64_t>();
  if (version > kFirstVersion) {
    f.revision = in.get<std::uint32_t>();
    f.withdrawn = in.flag();
  }
  unpack_content(in, f);
}

}  // namespace

bool valid(const PhotoRef& photo) {
  return photo.content != 0 && photo.bytes != 0 && photo.bytes <= PhotoRef::kMaxBytes &&
         photo.thumbnail <= PhotoRef::kMaxThumbnail;
}

bool valid(const Finding& f) {
  return valid_robot(f.key.robot) && f.key.id != 0 && !f.kind.empty() && f.kind.size() <= Finding::kKind &&
         f.text.size() <= Finding::kText && f.data.size() <= Finding::kData &&
         std::all_of(f.position.begin(), f.position.end(), [](double v) { return std::isfinite(v); }) &&
         (!f.anchor || valid_anchor(*f.anchor)) && (!f.photo || valid(*f.photo));
}

bool same_content(const Finding& a, const Finding& b) {
  Finding other = b;
  other.revision = a.revision;
  other.anchor = a.anchor;
  return a == other;
}

store::Bytes to_file(const Finding& f) {
  store::Packer out;
  out.text(f.key.robot).put(f.key.owner);
  pack_fields(out, f);
  return store::encode_envelope(kFormat, 0, out.bytes());
}

FindingFile read_finding(std::span<const std::uint8_t> bytes) {
  const store::State state = store::decode_envelope(kFormat, bytes);
  const bool older = state.found == store::LoadStatus::older && state.version >= kFirstVersion;
  if (state.found != store::LoadStatus::good && !older) return {state.found, std::nullopt};
  store::Unpacker in(state.payload);
  Finding f{};
  f.key.robot = in.text(32);
  if (older) {
    read_old(in, static_cast<std::uint8_t>(state.version), f);
  } else {
    f.key.owner = in.array<std::tuple_size_v<Owner>>();
    unpack_fields(in, kVersion, f);
  }
  if (!in.done() || !valid(f)) return {};
  return {store::LoadStatus::good, std::move(f)};
}

std::string id_text(std::uint64_t id) {
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[id >> shift & 15];
  return text;
}

std::string owner_text(const Owner& owner) {
  std::string text;
  for (const std::uint8_t byte : owner)
    (text += "0123456789abcdef"[byte >> 4]) += "0123456789abcdef"[byte & 15];
  return text;
}

bool read_owner(std::string_view text, Owner& owner) {
  owner = {};
  if (text.empty()) return true;
  if (text.size() != 2 * owner.size()) return false;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const char* digits = text.data() + 2 * i;
    const auto [end, error] = std::from_chars(digits, digits + 2, owner[i], 16);
    if (error != std::errc() || end != digits + 2) return false;
  }
  return true;
}

std::string file_name(const Key& key) {
  return kPrefix + key.robot + "-" + id_text(key.id) +
         (key.owner == Owner{} ? "" : "-" + owner_text(key.owner));
}

// Robot names contain no point; a file name with one is a renamed file.
bool is_finding_file(const std::string& name) {
  return name.starts_with(kPrefix) && name.find('.') == std::string::npos;
}

}  // namespace adit::findings
