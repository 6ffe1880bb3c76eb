// SPDX-License-Identifier: Apache-2.0
#include "core/findings/stairs_data.hpp"

#include <cmath>

#include "core/store/pack.hpp"

namespace adit::findings {
namespace {

constexpr std::uint8_t kStairsVersion = 1;
constexpr double kUnit = 1e-4;  // m and rad

std::int64_t units(double value) { return std::llround(value / kUnit); }
double value_of(std::int64_t units) { return static_cast<double>(units) * kUnit; }

}  // namespace

store::Bytes encode_stairs(const Staircase& s) {
  store::Packer out;
  out.put(kStairsVersion).put(static_cast<std::uint8_t>(s.steps));
  for (const double value : {s.heading, s.rise, s.run, s.width, s.sigma.place, s.sigma.heading, s.sigma.rise,
                             s.sigma.run, s.sigma.width})
    out.zigzag(units(value));
  return out.bytes();
}

Result<Staircase> stairs_of(const Finding& finding) {
  const auto malformed = [](const char* what) {
    return Error{Reason::malformed, std::string("a staircase: ") + what};
  };
  if (finding.kind != kStairs) return malformed("the finding is something else");
  if (finding.data.empty()) return malformed("no data");
  if (finding.data[0] != kStairsVersion) return {Reason::wrong_protocol, "a staircase of another version"};
  store::Unpacker in(std::span(finding.data).subspan(1));
  Staircase s;
  s.foot = {finding.position[0], finding.position[1], finding.position[2]};
  s.steps = in.get<std::uint8_t>();
  for (double* value : {&s.heading, &s.rise, &s.run, &s.width, &s.sigma.place, &s.sigma.heading,
                        &s.sigma.rise, &s.sigma.run, &s.sigma.width})
    *value = value_of(in.zigzag());
  if (!in.done()) return malformed("truncated, or bytes behind its end");
  // Rounding may lead out of the circle by half a unit.
  if (std::abs(s.heading) <= M_PI + kUnit) s.heading = std::remainder(s.heading, 2 * M_PI);
  if (!valid(s)) return malformed("its values are out of range");
  return s;
}

}  // namespace adit::findings
