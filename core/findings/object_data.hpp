// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/findings/finding.hpp"

namespace adit::findings {

/// What a robot's own detector knows of an object beside its place.
struct ObjectData {
  double sigma{};  ///< Standard deviation of the place, m, (0, 655].
  double score{};  ///< The best one, [0, 1].
  bool operator==(const ObjectData&) const = default;
};

/// Data of a finding: a tag and a version, sigma in cm and the score in 1/255, 8 bytes.
store::Bytes encode_object(const ObjectData& object);
/// Nothing: the finding is not of a robot's own detector.
std::optional<ObjectData> read_object(const Finding& finding);

}  // namespace adit::findings
