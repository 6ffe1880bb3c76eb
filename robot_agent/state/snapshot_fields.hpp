// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/store/pack.hpp"
#include "robot_agent/state/snapshot.hpp"

/// The fields of a snapshot, packed and unpacked. Private to robot_agent/state.
namespace adit::agent::fields {

inline constexpr std::size_t kName = 32;

void put(store::Packer& out, const KeptAuthority& authority);
void put(store::Packer& out, const std::vector<Party>& stops);
void put(store::Packer& out, const KeptBehaviour& behaviour);
void put(store::Packer& out, const StoredFrames& place);
void put(store::Packer& out, const nav::Area& area);
void put(store::Packer& out, const KeptAnswers& from);

/// Unpack one field each; check `in.good()` afterwards. The authority has no stops.
KeptAuthority authority(store::Unpacker& in);
std::vector<Party> stops(store::Unpacker& in);
KeptBehaviour behaviour(store::Unpacker& in);
StoredFrames place(store::Unpacker& in);
nav::Area area(store::Unpacker& in);
KeptAnswers answers(store::Unpacker& in);

// Each returns its argument in the form in which it is written: bounded, and without invalid values. A value
// that was read must equal its own sanitized form.
KeptAuthority sanitized(KeptAuthority authority);  ///< Without its stops.
std::vector<Party> sanitized(std::vector<Party> stops);
KeptBehaviour sanitized(KeptBehaviour behaviour);
StoredFrames sanitized(StoredFrames place);

void put(store::Packer& out, const KeptMode& mode);
KeptMode mode(store::Unpacker& in);
KeptMode sanitized(KeptMode mode);
KeptAnswers sanitized(KeptAnswers from);
std::uint8_t sanitized_battery(std::uint8_t level);

}  // namespace adit::agent::fields
