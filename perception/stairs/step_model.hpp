// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

namespace adit::perception {

/// A point beside steps: uphill, to the left, and up, m, from the centre of a region.
using SlopePoint = Eigen::Vector3f;

/// Steps of equal rise and run without end. Edge k, where riser k ends above and tread k begins, is at
/// (edge_u + k run, edge_h + k rise).
struct StepModel {
  double edge_u{}, edge_h{};  ///< m
  double run{}, rise{};       ///< m
  double turn{};              ///< Of the direction of climbing, from the region's, to the left, rad.
  double eye_u{}, eye_h{};    ///< Of the sensor: it sees no riser from above, and no tread from below.

  double along(const SlopePoint& p) const { return p.x() + turn * p.y(); }
  double across(const SlopePoint& p) const { return p.y() - turn * p.x(); }
  double riser_u(int k) const { return edge_u + k * run; }
  double tread_h(int k) const { return edge_h + k * rise; }
  /// The tread above or below a place.
  int tread_at(double u) const { return static_cast<int>(std::floor((u - edge_u) / run)); }
  /// The riser in front of or behind a height.
  int riser_at(double h) const { return static_cast<int>(std::ceil((h - edge_h) / rise)); }

  bool sees_tread(int k) const { return tread_h(k) < eye_h - 0.02; }
  /// Whether a tread is so far below the sensor that its points are many.
  bool sees_well(int k) const { return tread_h(k) < eye_h - 0.3; }
  bool sees_riser(int k) const { return riser_u(k) > eye_u; }

  /// The nearest riser or tread that the sensor sees, and the signed distance from its face, m: uphill of a
  /// riser, above a tread.
  struct Nearest {
    int step{};
    bool riser{};
    double off{};
    bool beyond_edge{};  ///< The point is not on the face, but beyond its edge: a neighbour that is not seen.
  };
  Nearest nearest(double u, double h) const;
};

/// A model and how well it fits.
struct StepFit {
  static constexpr double kMostOff = 0.08;  ///< m
  static constexpr double kEdge = 0.2;  ///< Weight of edges beside faces: where points end is less certain.
  StepModel model{};
  double spread{};  ///< Root mean square of the distances, m, of those within kMostOff.
  double share{};   ///< Of the points that are within kMostOff.
  Eigen::Matrix2d rise_covariance{Eigen::Matrix2d::Zero()};  ///< Of edge_h and rise, for a spread of 1 m.
  Eigen::Matrix3d run_covariance{Eigen::Matrix3d::Zero()};   ///< Of edge_u, run and turn, likewise.
  double edge_squares{};  ///< Of seen edges from the model's: median of the squares, m2.

  /// Mean square of the distances, in which none counts as more than kMostOff, and of the edges', m2.
  double cost() const {
    return share * spread * spread + (1.0 - share) * kMostOff * kMostOff + kEdge * edge_squares;
  }
};

/// Fits steps to points that lie about a plane through the origin which rises by `slope`: periods from the
/// periodogram of the distances from the plane (Lomb 1976), then Gauss-Newton with Huber's weights.
class StepFitter {
 public:
  static constexpr double kMostOff = StepFit::kMostOff;
  static constexpr double kHuber = 0.015;  ///< m

  /// The models of the strongest periods, the best first; empty when there are too few points.
  /// How periodic the points' distances from the plane are: the share of their squares that one wave
  /// explains.
  double periodicity(std::span<const SlopePoint> points, double slope);
  /// `eye`: of the sensor, in the frame of the points; `most`: periods that are tried.
  const std::vector<StepFit>& fit(std::span<const SlopePoint> points, double slope, const SlopePoint& eye,
                                  std::size_t most);
  /// From a model that is nearly right.
  static StepFit refine(std::span<const SlopePoint> points, StepModel start);

 private:
  struct Bin {
    double sum{}, weight{};
  };
  /// A face's points: along it, and its place across.
  struct Edge {
    std::vector<float> along{};
    double across{};
  };
  static constexpr int kSlots = 64;
  using Edges = std::vector<Edge>;
  /// Returns StepFit::edge_squares.
  static double measure_edges(const StepModel& model, Edges& risers, Edges& treads, Eigen::Matrix3d& a,
                              Eigen::Vector3d& b, Eigen::Matrix2d& c, Eigen::Vector2d& d);
  /// A wave of the distances along the slope.
  struct Wave {
    double frequency{};  ///< 1/m
    double power{};      ///< Share of the squares that it explains.
    double phase{};
  };
  void fill(std::span<const SlopePoint> points, double slope);
  void find_waves();

  std::vector<Bin> bins_{};
  double mean_{}, drift_{};  ///< Of the distances at the origin, m, and along the slope.
  std::vector<Wave> waves_{};
  std::vector<StepFit> fits_{};
};

}  // namespace adit::perception
