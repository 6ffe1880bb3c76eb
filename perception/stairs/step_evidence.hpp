// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bitset>
#include <optional>
#include <span>
#include <vector>

#include "perception/stairs/step_model.hpp"

namespace adit::perception {

/// The part of a StepModel that exists, and what speaks for it.
struct FlightEvidence {
  int first{}, last{};     ///< Risers.
  double right{}, left{};  ///< Ends of the treads across, m.
  double spread{};         ///< Root mean square of the points' distances from the steps, m.
  double plane_spread{};   ///< The same from one plane, as of a ramp.
  double unequal{};        ///< Root mean square of the offsets of risers, or of treads, from equal steps, m.
  double independent{};    ///< Number of independent measurements.
  double clean{};          ///< Share of the points beside the steps that lie on them.
};

/// Finds which steps of a model exist.
class StepEvidence {
 public:
  /// @param points  Of the region; `core_right` to `core_left`: the part across in which the region lies for
  /// sure, m.
  std::optional<FlightEvidence> weigh(const StepFit& fit, std::span<const SlopePoint> points,
                                      double core_right, double core_left);

 private:
  static constexpr int kSteps = 64, kMiddle = kSteps / 2;
  static constexpr int kStrips = 128;
  static constexpr double kStrip = 0.05;  ///< m
  using Strips = std::bitset<kStrips>;
  struct Face {
    Strips strips{};
    double count{}, sum{};
  };
  /// A point on the steps' side of the model.
  struct Placed {
    float u, v, h, off;
    int step;
    bool riser;
  };
  enum class Seen { no, hardly, clearly };

  void count_core(double right, double left, double tolerance);
  bool seen(const Face& face) const;
  Seen riser_seen(int k) const;
  bool find_chain(FlightEvidence& out) const;
  bool find_width(FlightEvidence& out, double tolerance, double middle);
  void compare(FlightEvidence& out, double tolerance);

  StepModel model_{};
  double core_strips_{};
  std::vector<Placed> placed_{};
  std::array<Face, kSteps> risers_{}, treads_{};
  std::array<int, kSteps> above_risers_{}, before_risers_{};
};

}  // namespace adit::perception
