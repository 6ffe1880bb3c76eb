// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/model/text.hpp"  // fixed(), for those who fill the rows.

namespace adit::station {

/// Formats rows as aligned columns; the first row is the heading. A column whose cells below the heading are
/// all numbers or "-", with one number at least, is aligned right.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// Formats an age, s, in a few characters: 59s, 12m, 30h; "-" if not finite.
std::string short_age(double seconds);
/// Formats an age, s, for a sentence: "12 s ago", "3 min ago", "30 h ago"; "" below 5 s.
std::string ago(double seconds);

}  // namespace adit::station
