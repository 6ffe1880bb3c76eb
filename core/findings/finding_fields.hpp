// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/findings/finding.hpp"
#include "core/store/pack.hpp"

namespace adit::findings {

/// Versions of the content of a finding, in files and in pieces: 1 has no revision, 2 no owner, anchor and
/// photo.
inline constexpr std::uint8_t kFirstVersion = 1, kVersion = 3;

/// Appends the content of a finding of kVersion: all but the robot and the owner.
void pack_fields(store::Packer& out, const Finding& finding);
/// Reads the content that pack_fields() wrote, or that of an older version, as it is in pieces. After content
/// of another form in.good() is false.
void unpack_fields(store::Unpacker& in, std::uint8_t version, Finding& finding);
/// Reads what all versions have in common, in files and in pieces: from the kind to the data.
void unpack_content(store::Unpacker& in, Finding& finding);
/// Number of bytes that pack_fields() appends.
std::size_t packed_size(const Finding& finding);

}  // namespace adit::findings
