// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/findings/finding.hpp"
#include "core/store/pack.hpp"

namespace adit::findings {

inline Finding some(std::uint64_t id, std::uint8_t importance = 1, const std::string& robot = "r1") {
  Finding f;
  f.key = {robot, id};
  f.kind = "artifact";
  f.importance = importance;
  f.position = {1.5, -2.0, 0.25};
  f.stamp = 123456789;
  f.text = "a red backpack";
  f.data = {1, 2, 3};
  return f;
}

/// The file of a finding as releases before revisions (version 1) and before owners (version 2) wrote it.
inline store::Bytes file_of_version(std::uint16_t version, const Finding& f) {
  store::Packer out;
  out.text(f.key.robot).put(f.key.id);
  if (version == 2) out.put(f.revision).flag(f.withdrawn);
  out.text(f.kind).put(f.importance);
  for (const double value : f.position) out.put(value);
  out.put(f.stamp).text(f.text).put(static_cast<std::uint16_t>(f.data.size())).raw(f.data);
  return store::encode_envelope({{'F', 'I', 'N', 'D'}, version, 1024}, 0, out.bytes());
}

}  // namespace adit::findings
