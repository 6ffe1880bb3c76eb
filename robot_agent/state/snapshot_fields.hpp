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
/// The accuracy of a place, which has a section of its own: states of earlier versions have none.
void put_sigma(store::Packer& out, const StoredFrames& place);
void put(store::Packer& out, const nav::Area& area);
void put(store::Packer& out, const StoredAnswers& from);

/// Unpack one field each; check `in.good()` afterwards. The authority has no stops.
StoredAuthority authority(store::Unpacker& in);
std::vector<Party> stops(store::Unpacker& in);
StoredBehaviour behaviour(store::Unpacker& in);
StoredFrames place(store::Unpacker& in);
/// Reads it into `place`; false when it is none.
bool read_sigma(store::Unpacker& in, StoredFrames& place);
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
