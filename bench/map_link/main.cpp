// SPDX-License-Identifier: Apache-2.0
// bench_map_link: what a map takes on thin links, as tables.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "bench/map_link/rows.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

constexpr int kFailed = 2;  ///< A file is missing, or the bench itself has a defect.

int failed(const Error& error) {
  fmt::print(stderr, "bench_map_link: {}\n", error.text);
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Bytes and seconds that maps take on thin links, beside other ways to send them.",
               "bench_map_link"};
  app.footer(
      "Rows: coding (bytes a m2 by voxel size), 17 (bytes of a mission), 18 (age of the station's map), 19 "
      "(after a\n"
      "cut), 20 (a closure). Exit status: 1 when the station's map is not the robot's, 2 when a file is "
      "missing.\n\n"
      "Example: bench_map_link --rows 17,18 --quick");
  std::vector<std::string> rows{"coding", "17", "18", "19", "20"};
  RowOptions options;
  double length = 60.0;
  bool mission = true;
  app.add_option("--rows", rows, "to print")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::IsMember({"coding", "17", "18", "19", "20"}));
  app.add_flag("--quick", options.quick, "one world and two minutes; without `coding`");
  app.add_flag("--alone", options.alone, "this project only, without the other ways");
  app.add_option("--seed", options.seed, "of the drives and of the losses")->capture_default_str();
  app.add_option("--length", length, "of a drive of `coding`, m")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 500.0));
  app.add_flag("--mission,!--no-mission", mission, "`coding`: what a drive sends in all")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  options.rows = {rows.begin(), rows.end()};
  if (options.rows.contains("coding") && !options.quick)
    if (const auto done = print_coding(length, mission); !done) return failed(done.error());
  const auto different = print_mission_rows(options);
  if (!different) return failed(different.error());
  if (options.rows.contains("20")) {
    fmt::print(
        "\nA closure that moves 100 submaps (row 20)\n\n| link | bytes | datagrams | acknowledgements | s | "
        "|\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    for (const char* link : {"mesh_500k", "mesh_100k"})
      if (const auto done = print_closure(link, options.seed); !done) return failed(done.error());
  }
  return *different == 0 ? 0 : 1;
}
