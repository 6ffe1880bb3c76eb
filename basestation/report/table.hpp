#pragma once
#include <string>
#include <vector>

namespace adit::station {

/// Columns of text, aligned: the first row is the heading. A column whose cells below the heading are all
/// numbers or
/// "-" is aligned right.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// A number with `decimals` digits, without a negative zero; "-" when not finite.
std::string fixed(double value, int decimals);

}  // namespace adit::station
