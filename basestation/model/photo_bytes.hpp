// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "basestation/model/outcome.hpp"
#include "core/findings/photo_file.hpp"
#include "core/result/result.hpp"
#include "core/store/disk.hpp"

/// The bytes of a photo on their way from the station to a front end: as base64 in the object for scripts of
/// an outcome.
namespace adit::station {

std::string base64_of(std::span<const std::uint8_t> bytes);
/// Error: malformed (another character, padding or length than base64_of() writes).
Result<store::Bytes> bytes_of_base64(std::string_view text);

/// The word for a part of a photo in requests, and back; nothing: it is none.
std::string_view word_of(findings::PhotoPart part);
std::optional<findings::PhotoPart> photo_part_from(std::string_view word);

/// Reads FoundPhoto::id; nothing: it is none.
std::optional<std::uint64_t> photo_id_from(std::string_view text);

/// The object for scripts of an outcome with these bytes.
nlohmann::json photo_json(std::span<const std::uint8_t> jpeg);
/// Reads such an outcome, on any thread; the bytes are not checked. Errors: as of health_of(); out_of_range
/// (findings::check_photo_size()).
Result<store::Bytes> photo_of(const CommandOutcome& outcome);

}  // namespace adit::station
