// SPDX-License-Identifier: Apache-2.0
// Defects of where a robot says it is.
#include "core/config/perception_level.hpp"
#include "sim/defects/decorations.hpp"
#include "sim/defects/radio_interceptor.hpp"

namespace adit::sim {
namespace {

class SigmaSmall final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_state(radio::RobotState& state) override {
    constexpr double kDrift = 0.05;        // m/s
    constexpr std::uint16_t kStated = 10;  // mm
    if (!begin_) begin_ = now();
    state.x(static_cast<float>(state.x() + kDrift * seconds(now() - *begin_)));
    state.sigma(kStated);
    state.localisation(static_cast<std::uint8_t>(Localisation::ok));
  }

 private:
  std::optional<Time> begin_{};
};

/// States a deviation of 0.4 m that nothing else of the robot knows of.
class SigmaNotKept final : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;
  void on_state(radio::RobotState& state) override {
    constexpr std::uint16_t kStated = 400;  // mm
    state.sigma(kStated);
    state.localisation(static_cast<std::uint8_t>(Localisation::ok));
  }
};

}  // namespace

namespace decorations {

Decoration sigma_not_kept(const Subject& s) { return on_wires<SigmaNotKept>(s); }
Decoration sigma_small(const Subject& s) { return on_wires<SigmaSmall>(s); }

}  // namespace decorations
}  // namespace adit::sim
