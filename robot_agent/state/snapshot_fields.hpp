// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/store/pack.hpp"
#include "robot_agent/state/snapshot.hpp"

/// The fields of a snapshot, packed and unpacked. Private to robot_agent/state.
namespace adit::agent::fields {

inline constexpr std::size_t kName = 32;

void put(store::Packer& out, const StoredAuthority& authority);
void put(store::Packer& out, const std::vector<Party>& stops);
void put(store::Packer& out, const StoredBehaviour& behaviour);
void put(store::Packer& out, const StoredFrames& place);
void put(store::Packer& out, const nav::Area& area);
void put(store::Packer& out, const StoredAnswers& from);

/// Unpack one field each; check `in.good()` afterwards. The authority has no stops.
StoredAuthority authority(store::Unpacker& in);
std::vector<Party> stops(store::Unpacker& in);
StoredBehaviour behaviour(store::Unpacker& in);
StoredFrames place(store::Unpacker& in);
nav::Area area(store::Unpacker& in);
StoredAnswers answers(store::Unpacker& in);

// Each returns its argument in the form in which it is written: bounded, and without invalid values. A value
// that was read must equal its own sanitized form.
StoredAuthority sanitized(StoredAuthority authority);  ///< Without its stops.
std::vector<Party> sanitized(std::vector<Party> stops);
StoredBehaviour sanitized(StoredBehaviour behaviour);
StoredFrames sanitized(StoredFrames place);

void put(store::Packer& out, const StoredMode& mode);
StoredMode mode(store::Unpacker& in);
StoredMode sanitized(StoredMode mode);
StoredAnswers sanitized(StoredAnswers from);
std::uint8_t sanitized_battery(std::uint8_t level);

}  // namespace adit::agent::fields
