// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding.hpp"

#include <algorithm>
#include <cmath>

#include "core/store/pack.hpp"

namespace adit::findings {
namespace {

constexpr store::StateFormat kFormat{{'F', 'I', 'N', 'D'}, 2, 1024};
constexpr const char* kPrefix = "finding-";

bool valid_robot(const std::string& name) {
  return name.size() <= 32 && name.find('.') == std::string::npos && store::valid_file_name(name);
}

}  // namespace

bool valid(const Finding& f) {
  return valid_robot(f.key.robot) && f.key.id != 0 && !f.kind.empty() && f.kind.size() <= Finding::kKind &&
         f.text.size() <= Finding::kText && f.data.size() <= Finding::kData &&
         std::all_of(f.position.begin(), f.position.end(), [](double v) { return std::isfinite(v); });
}

bool same_content(const Finding& a, const Finding& b) {
  Finding other = b;
  other.revision = a.revision;
  return a == other;
}

store::Bytes to_file(const Finding& f) {
  store::Packer out;
  out.text(f.key.robot).put(f.key.id).put(f.revision).flag(f.withdrawn).text(f.kind).put(f.importance);
  for (const double value : f.position) out.put(value);
  out.put(f.stamp).text(f.text).put(static_cast<std::uint16_t>(f.data.size())).raw(f.data);
  return store::encode_envelope(kFormat, 0, out.bytes());
}

FindingFile read_finding(std::span<const std::uint8_t> bytes) {
  const store::State state = store::decode_envelope(kFormat, bytes);
  const bool first_version = state.found == store::LoadStatus::older && state.version == 1;
  if (state.found != store::LoadStatus::good && !first_version) return {state.found, std::nullopt};
  store::Unpacker in(state.payload);
  Finding f{};
  f.key.robot = in.text(32);
  f.key.id = in.get<std::uint64_t>();
  if (!first_version) {
    f.revision = in.get<std::uint32_t>();
    f.withdrawn = in.flag();
  }
  f.kind = in.text(Finding::kKind);
  f.importance = in.get<std::uint8_t>();
  for (double& value : f.position) value = in.number();
  f.stamp = in.get<std::uint64_t>();
  f.text = in.text(Finding::kText);
  const std::size_t size = in.count(Finding::kData);
  if (!in.good() || in.rest().size() != size) return {};
  f.data.assign(in.rest().begin(), in.rest().end());
  if (!valid(f)) return {};
  return {store::LoadStatus::good, std::move(f)};
}

std::string id_text(std::uint64_t id) {
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[id >> shift & 15];
  return text;
}

std::string file_name(const Key& key) { return kPrefix + key.robot + "-" + id_text(key.id); }

// Robot names contain no point; a file name with one is a renamed file.
bool is_finding_file(const std::string& name) {
  return name.starts_with(kPrefix) && name.find('.') == std::string::npos;
}

}  // namespace adit::findings
