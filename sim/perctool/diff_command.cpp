// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/perctool/commands.hpp"
#include "sim/perctool/octree_diff.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::perctool {

int diff(const DiffOptions& options) {
  const auto a = read_map(options.a);
  if (!a) return report_error("perctool", a.error());
  const auto b = read_map(options.b);
  if (!b) return report_error("perctool", b.error());
  const auto result = compare(*a, *b);
  if (!result) return report_error("perctool", result.error());
  if (options.json) {
    const nlohmann::ordered_json out{{"resolution", a->resolution},
                                     {"equal", result->equal},
                                     {"missing", result->missing},
                                     {"more", result->more},
                                     {"different", result->different},
                                     {"share", result->share()},
                                     {"leaves", {a->leaves.size(), b->leaves.size()}}};
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  std::printf("%llu cells equal (%.2f %%), %llu missing, %llu more, %llu different\n",
              static_cast<unsigned long long>(result->equal), 100.0 * result->share(),
              static_cast<unsigned long long>(result->missing), static_cast<unsigned long long>(result->more),
              static_cast<unsigned long long>(result->different));
  return 0;
}

}  // namespace adit::sim::perctool
