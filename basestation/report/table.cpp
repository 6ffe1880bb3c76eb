// SPDX-License-Identifier: Apache-2.0
#include "basestation/report/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace adit::station {
namespace {

bool is_number(const std::string& cell) {
  return cell.find_first_not_of("0123456789+-.%") == std::string::npos;
}

}  // namespace

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  std::vector<bool> right, digits;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    width.resize(std::max(width.size(), rows[r].size()), 0);
    right.resize(width.size(), rows.size() > 1);
    digits.resize(width.size(), false);
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      width[c] = std::max(width[c], rows[r][c].size());
      if (r == 0) continue;
      if (!is_number(rows[r][c])) right[c] = false;
      if (rows[r][c].find_first_of("0123456789") != std::string::npos) digits[c] = true;
    }
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(width[c] - row[c].size(), ' ');
      line += right[c] && digits[c] ? space + row[c] : row[c] + space;
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string short_age(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  if (seconds < 99.5) return fixed(seconds, 0) + "s";
  if (seconds < 99.5 * 60.0) return fixed(seconds / 60.0, 0) + "m";
  return fixed(seconds / 3600.0, 0) + "h";
}

std::string ago(double seconds) {
  if (!std::isfinite(seconds) || seconds < 5.0) return {};
  if (seconds < 99.5) return fixed(seconds, 0) + " s ago";
  if (seconds < 99.5 * 60.0) return fixed(seconds / 60.0, 0) + " min ago";
  return fixed(seconds / 3600.0, 0) + " h ago";
}

}  // namespace adit::station
