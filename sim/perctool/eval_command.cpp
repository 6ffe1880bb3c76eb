// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/cloud/evaluation.hpp"
#include "sim/perctool/commands.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::perctool {
namespace {

nlohmann::ordered_json as_json(const ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse}};
}

void print(const char* title, const ErrorStatistics& s) {
  std::printf("%s\n\n", title);
  for (const auto& [name, value] : {std::pair{"max", s.max},
                                    {"mean", s.mean},
                                    {"median", s.median},
                                    {"min", s.min},
                                    {"rmse", s.rmse},
                                    {"sse", s.sse},
                                    {"std", s.std}})
    std::printf("%10s\t%.6f\n", name, value);
  std::puts("");
}

}  // namespace

int eval(const EvalOptions& options) {
  const auto truth = read_tum(options.truth);
  if (!truth) return report_error("perctool", truth.error());
  const auto estimate = read_tum(options.estimate);
  if (!estimate) return report_error("perctool", estimate.error());
  const auto result = evaluate(*truth, *estimate,
                               {.max_diff = options.max_diff,
                                .align = options.align,
                                .delta = options.delta,
                                .delta_in_metres = options.unit == "m"});
  if (!result) return report_error("perctool", result.error());
  if (options.json) {
    const nlohmann::ordered_json out{{"poses", result->poses},
                                     {"length", result->length},
                                     {"aligned", options.align},
                                     {"ate", as_json(result->ate)},
                                     {"ate_deg", as_json(result->ate_deg)},
                                     {"pairs", result->pairs},
                                     {"delta", options.delta},
                                     {"unit", options.unit},
                                     {"rpe", as_json(result->rpe)},
                                     {"rpe_deg", as_json(result->rpe_deg)}};
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  std::printf("%zu poses, %.3f m\n\n", result->poses, result->length);
  print(options.align ? "ATE, m (with SE(3) Umeyama alignment)" : "ATE, m (not aligned)", result->ate);
  print("RPE, m", result->rpe);
  print("RPE, degrees", result->rpe_deg);
  return 0;
}

}  // namespace adit::sim::perctool
