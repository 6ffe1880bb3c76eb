// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <ceres/ceres.h>

#include <array>

#include "nav/control/ilqr.hpp"

/// The problem that Ilqr solves, put to Ceres: all controls of the horizon as one block within its bounds,
/// the same costs as residuals, derivatives by automatic differentiation.
namespace adit::nav::test {

template <class T>
void twist(const model::Unicycle&, const T* v, T* t) {
  t[0] = v[0], t[1] = T(0), t[2] = v[1];
}
template <class T>
void twist(const model::Car& m, const T* v, T* t) {
  t[0] = v[0], t[1] = T(0), t[2] = v[0] * tan(v[1]) / m.wheelbase;
}
template <class T>
void twist(const model::Holonomic&, const T* v, T* t) {
  t[0] = v[0], t[1] = v[1], t[2] = v[2];
}

template <class Model>
class CeresProblem {
 public:
  using Solver = Ilqr<Model>;
  static constexpr int kN = Solver::kHorizon, kV = Model::kVelocities;
  static constexpr int kControls = kN * kV, kResiduals = kN * (3 + 3 * kV);

  struct Params {
    Model model{};
    typename Solver::Limits limits{};
    IlqrParams costs{};
    double dt{};
  };

  CeresProblem(const Params& params, const typename Solver::X& start,
               const std::array<Reference, kN>& references)
      : params_(params), start_(start), references_(references) {}

  /// The least cost from zero controls on.
  double solve() {
    controls_.fill(0.0);
    ceres::Problem::Options keep;
    keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(keep);
    ceres::AutoDiffCostFunction<CeresProblem, kResiduals, kControls> cost(this, ceres::DO_NOT_TAKE_OWNERSHIP);
    problem.AddResidualBlock(&cost, nullptr, controls_.data());
    for (int i = 0; i < kControls; ++i) {
      problem.SetParameterLowerBound(controls_.data(), i, -params_.limits.rate[i % kV]);
      problem.SetParameterUpperBound(controls_.data(), i, params_.limits.rate[i % kV]);
    }
    ceres::Solver::Options options;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-10;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return 2 * summary.final_cost;  // Ceres halves the squares
  }

  template <class T>
  bool operator()(const T* controls, T* out) const {
    const IlqrParams& c = params_.costs;
    T x[3] = {T(start_[0]), T(start_[1]), T(start_[2])};
    T v[kV];
    for (int i = 0; i < kV; ++i) v[i] = T(start_[3 + i]);
    for (int k = 0; k < kN; ++k) {
      const Reference& r = references_[static_cast<std::size_t>(k)];
      T t[3];
      for (int i = 0; i < kV; ++i) v[i] += params_.dt * controls[k * kV + i];
      twist(params_.model, v, t);
      const T mid = x[2] + 0.5 * params_.dt * t[2];
      x[0] += params_.dt * (cos(mid) * t[0] - sin(mid) * t[1]);
      x[1] += params_.dt * (sin(mid) * t[0] + cos(mid) * t[1]);
      x[2] += params_.dt * t[2];
      const double often = std::sqrt(k + 1 == kN ? c.terminal : 1.0);
      const double cy = std::cos(r.pose.yaw), sy = std::sin(r.pose.yaw);
      const T dx = x[0] - r.pose.x, dy = x[1] - r.pose.y;
      *out++ = often * std::sqrt(c.along) * (cy * dx + sy * dy);
      *out++ = often * std::sqrt(c.across) * (cy * dy - sy * dx);
      *out++ = often * std::sqrt(c.yaw) * (x[2] - r.pose.yaw);
      const auto wanted = params_.model.inverse(r.twist);
      for (int i = 0; i < kV; ++i) {
        const double limit = params_.limits.velocity[i];
        *out++ = often * std::sqrt(c.velocity) * (v[i] - wanted[i]);
        const T over = (v[i] < 0.0 ? -v[i] : v[i]) - limit;
        *out++ = over > 0.0 ? T(often * std::sqrt(c.limit) / limit * over) : T(0);
        *out++ = std::sqrt(c.effort) / params_.limits.rate[i] * controls[k * kV + i];
      }
    }
    return true;
  }

 private:
  Params params_;
  typename Solver::X start_;
  std::array<Reference, kN> references_;
  std::array<double, kControls> controls_{};
};

}  // namespace adit::nav::test
