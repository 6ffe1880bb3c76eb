// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/result/result.hpp"

namespace adit::bench {

/// What the program was asked to run.
struct RowOptions {
  std::vector<std::string> platforms{"wheeled", "tracked", "legged"};
  int goals{100};             ///< Of each platform.
  int seeds{20};              ///< Of each door and of the straight drive.
  int impossible{60};         ///< Goals where no robot can stand.
  std::uint64_t first{1};     ///< The first seed.
  double minutes{0};          ///< Each part of a row ends after so long, with the runs so far, min; 0: never.
  std::string clouds{};       ///< Folder of street scans; empty: none.
  std::string poses{};        ///< Of base_link at each of them, TUM; empty: none.
  double lidar_height{1.73};  ///< Of the street scans above the ground, m.
  bool each{false};           ///< Prints a line for each run that was not as it should be.
  std::string save{};         ///< Folder for the scenarios of those runs; empty: none.
};

/// One line of the table.
struct RowResult {
  std::string what{}, measured{}, goal{}, before{};
  bool ok{};
};
using RowResults = std::vector<RowResult>;

Result<RowResults> goals_row(const RowOptions& options);
Result<RowResults> doors_row(const RowOptions& options);
Result<RowResults> straight_row(const RowOptions& options);
Result<RowResults> impossible_row(const RowOptions& options);
Result<RowResults> tilt_row(const RowOptions& options);
Result<RowResults> street_row(const RowOptions& options);

/// Shows progress on stderr: "goals tracked 12/100".
class Progress {
 public:
  Progress(std::string name, int total, double minutes);
  /// Counts one; false when the row's time is over.
  bool next();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  std::string name_;
  int done_{0}, total_;
  double end_;
};

}  // namespace adit::bench
