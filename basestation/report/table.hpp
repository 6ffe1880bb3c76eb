#pragma once
#include <string>
#include <vector>

namespace adit::station {

/// Columns of text, aligned: the first row is the heading. A column whose cells below the heading are all
/// numbers or "-", with one number at least, is aligned right.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// A number with `decimals` digits, without a negative zero; "-" when not finite.
std::string fixed(double value, int decimals);

/// How long ago, in a few characters: 59s, 12m, 30h; "-" when not finite.
std::string short_age(double seconds);
/// The same for a sentence: "12 s ago", "3 min ago", "30 h ago"; "" for what is just now (below 5 s).
std::string ago(double seconds);

}  // namespace adit::station
