// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "nav/control/motion_model.hpp"

namespace adit::nav {

/// Desired state of the robot at one instant of the horizon.
struct Reference {
  Pose2 pose{};    ///< Odometry frame.
  Twist2 twist{};  ///< Body frame.
};

/// Weights and limits of the solver Ilqr.
struct IlqrParams {
  double along{2.0};     ///< Cost of the error along the reference's heading, 1/m2, (0, 1e4].
  double across{30.0};   ///< Cost of the error across it, 1/m2, (0, 1e4].
  double yaw{4.0};       ///< Cost of the heading error, 1/rad2, [0, 1e4].
  double velocity{0.4};  ///< Cost of the error of the velocity states, [0, 1e4].
  double effort{0.05};   ///< Cost of the controls, relative to their limits, (0, 1e3].
  double limit{60.0};  ///< Cost of a velocity state's excess over its limit, squared and relative, [0, 1e5].
  double terminal{4.0};    ///< Factor on the state cost of the last instant, [0, 100].
  int iterations{6};       ///< Maximum number of iterations, [1, 100].
  double tolerance{1e-3};  ///< Stops when an iteration lowers the cost by a smaller fraction, [0, 1].
};

/// Iterative LQR with box limits on the controls: control-limited DDP with Gauss-Newton Hessians (W. Li and
/// E. Todorov 2004; Y. Tassa, N. Mansard and E. Todorov, "Control-limited differential dynamic programming",
/// ICRA 2014). Limits of the velocity states are soft; where `Limits::hard` is set, they narrow the box of
/// the controls instead. All sizes are fixed and nothing is allocated. Each solve starts from the last
/// solution, shifted by one step.
template <class Model, int Horizon = 50>
class Ilqr {
 public:
  static constexpr int kHorizon = Horizon;
  static constexpr int kV = Model::kVelocities;
  static constexpr int kX = 3 + kV;
  using V = Eigen::Matrix<double, kV, 1>;
  using X = Eigen::Matrix<double, kX, 1>;

  /// Limits of the absolute values of the velocity states and of their rates.
  struct Limits {
    V velocity{V::Ones()};
    V rate{V::Ones()};
    /// 1: the limit of this velocity state is never exceeded, as for a car's steering; 0: excess has a cost.
    V hard{V::Zero()};
  };
  /// Result of a solve: its final cost and number of iterations.
  struct Report {
    double cost{};
    int iterations{};
  };

  Ilqr(Model model, const Limits& limits, const IlqrParams& params, double dt)
      : model_(model), limits_(limits), params_(params), dt_(dt) {
    reset();
  }

  /// Discards the last solution, for example when the path changes.
  void reset() { controls_.fill(V::Zero()); }

  /// Computes the controls of least cost from `start`; `references` belong to the instants dt, 2 dt, ...
  /// Horizon dt.
  Report solve(const X& start, const std::array<Reference, Horizon>& references) {
    std::move(controls_.begin() + 1, controls_.end(), controls_.begin());
    prepare(references);
    states_[0] = start;
    double cost = roll_out(controls_, states_);
    double damping = 0.0;
    Report report{};
    for (; report.iterations < params_.iterations; ++report.iterations) {
      if (!improve(damping)) {
        damping = std::max(1e-6, 10 * damping);
        if (damping > 1e6) break;
        continue;
      }
      const double before = cost;
      if (!search(cost)) {
        damping = std::max(1e-3, 10 * damping);
        if (damping > 1e6) break;
        continue;
      }
      damping *= 0.2;
      if (before - cost <= params_.tolerance * before) {
        ++report.iterations;
        break;
      }
    }
    report.cost = cost;
    return report;
  }

  const std::array<V, Horizon>& controls() const { return controls_; }
  /// The state after `k` steps, [0, Horizon].
  const X& state(int k) const { return states_[k]; }
  /// The cost of applying `controls` from `start`, for comparisons.
  double cost(const X& start, const std::array<Reference, Horizon>& references,
              const std::array<V, Horizon>& controls) {
    prepare(references);
    states_[0] = start;
    return roll_out(controls, states_);
  }

 private:
  using Gain = Eigen::Matrix<double, kV, kX>;
  using Square = Eigen::Matrix<double, kX, kX>;
  using Input = Eigen::Matrix<double, kV, kV>;
  using Column = Eigen::Matrix<double, kX, kV>;
  struct Goal {
    double x, y, yaw, cos, sin;
    V velocity;
  };

  void prepare(const std::array<Reference, Horizon>& references) {
    for (std::size_t k = 0; k < Horizon; ++k) {
      const Reference& r = references[k];
      goals_[k] = {r.pose.x,
                   r.pose.y,
                   r.pose.yaw,
                   std::cos(r.pose.yaw),
                   std::sin(r.pose.yaw),
                   model_.inverse(r.twist)};
    }
  }

  /// Limits of the controls where the velocity states are `v`.
  struct Box {
    V low, high;
  };
  Box box(const V& v) const {
    Box box{-limits_.rate, limits_.rate};
    for (int i = 0; i < kV; ++i) {
      if (limits_.hard[i] <= 0) continue;
      box.low[i] = std::clamp((-limits_.velocity[i] - v[i]) / dt_, -limits_.rate[i], limits_.rate[i]);
      box.high[i] = std::clamp((limits_.velocity[i] - v[i]) / dt_, -limits_.rate[i], limits_.rate[i]);
    }
    return box;
  }

  /// One step of the dynamics: the control changes the velocity states, then the pose moves along the mean
  /// heading.
  X next(const X& x, const V& u) const {
    X y;
    const V v = x.template tail<kV>() + dt_ * u;
    const Eigen::Vector3d t = model_.twist(v);
    const double mid = x[2] + 0.5 * dt_ * t[2];
    const double c = std::cos(mid), s = std::sin(mid);
    y[0] = x[0] + dt_ * (c * t[0] - s * t[1]);
    y[1] = x[1] + dt_ * (s * t[0] + c * t[1]);
    y[2] = x[2] + dt_ * t[2];
    y.template tail<kV>() = v;
    return y;
  }

  double stage_cost(const X& x, const V& u, std::size_t k) const {
    const Goal& g = goals_[k];
    const double dx = x[0] - g.x, dy = x[1] - g.y;
    const double along = g.cos * dx + g.sin * dy, across = -g.sin * dx + g.cos * dy;
    const double yaw = wrap_angle(x[2] - g.yaw);
    double cost = params_.along * along * along + params_.across * across * across + params_.yaw * yaw * yaw;
    const V v = x.template tail<kV>();
    cost += params_.velocity * (v - g.velocity).squaredNorm();
    for (int i = 0; i < kV; ++i) {
      const double over = std::max(0.0, std::fabs(v[i]) - limits_.velocity[i]) / limits_.velocity[i];
      cost += params_.limit * over * over;
    }
    cost *= k + 1 == Horizon ? params_.terminal : 1.0;
    return cost + params_.effort * u.cwiseQuotient(limits_.rate).squaredNorm();
  }

  double roll_out(const std::array<V, Horizon>& controls, std::array<X, Horizon + 1>& states) const {
    double cost = 0.0;
    for (std::size_t k = 0; k < Horizon; ++k) {
      states[k + 1] = next(states[k], controls[k]);
      cost += stage_cost(states[k + 1], controls[k], k);
    }
    return cost;
  }

  /// Computes half the gradient and the Gauss-Newton Hessian of the state cost at one instant.
  void expand(const X& x, std::size_t k, X& gradient, Square& hessian) const {
    const Goal& g = goals_[k];
    const double dx = x[0] - g.x, dy = x[1] - g.y;
    const double along = g.cos * dx + g.sin * dy, across = -g.sin * dx + g.cos * dy;
    gradient[0] = params_.along * along * g.cos - params_.across * across * g.sin;
    gradient[1] = params_.along * along * g.sin + params_.across * across * g.cos;
    gradient[2] = params_.yaw * wrap_angle(x[2] - g.yaw);
    hessian.setZero();
    hessian(0, 0) = params_.along * g.cos * g.cos + params_.across * g.sin * g.sin;
    hessian(1, 1) = params_.along * g.sin * g.sin + params_.across * g.cos * g.cos;
    hessian(0, 1) = hessian(1, 0) = (params_.along - params_.across) * g.cos * g.sin;
    hessian(2, 2) = params_.yaw;
    for (int i = 0; i < kV; ++i) {
      const double v = x[3 + i], limit = limits_.velocity[i], over = std::fabs(v) - limit;
      gradient[3 + i] = params_.velocity * (v - g.velocity[i]);
      hessian(3 + i, 3 + i) = params_.velocity;
      if (over > 0) {
        gradient[3 + i] += params_.limit * std::copysign(over, v) / (limit * limit);
        hessian(3 + i, 3 + i) += params_.limit / (limit * limit);
      }
    }
    if (k + 1 == Horizon) {
      gradient *= params_.terminal;
      hessian *= params_.terminal;
    }
  }

  /// The backward pass. Returns false when it needs more damping.
  bool improve(double damping) {
    X value = X::Zero();
    Square curve = Square::Zero();
    for (int step = Horizon - 1; step >= 0; --step) {
      const auto k = static_cast<std::size_t>(step);
      X gradient;
      Square hessian;
      expand(states_[k + 1], k, gradient, hessian);
      value += gradient;
      curve += hessian;

      // Derivatives of the dynamics: a: by the yaw and the new velocity states; b: by the control.
      const X& x = states_[k];
      const V v = states_[k + 1].template tail<kV>();
      const Eigen::Vector3d t = model_.twist(v);
      const Eigen::Matrix<double, 3, kV> j = model_.jacobian(v);
      const double mid = x[2] + 0.5 * dt_ * t[2];
      const double c = std::cos(mid), s = std::sin(mid);
      const double by_yaw_x = dt_ * (-s * t[0] - c * t[1]), by_yaw_y = dt_ * (c * t[0] - s * t[1]);
      Square a = Square::Identity();
      a(0, 2) = by_yaw_x;
      a(1, 2) = by_yaw_y;
      for (int i = 0; i < kV; ++i) {
        a(0, 3 + i) = dt_ * (c * j(0, i) - s * j(1, i)) + 0.5 * dt_ * by_yaw_x * j(2, i);
        a(1, 3 + i) = dt_ * (s * j(0, i) + c * j(1, i)) + 0.5 * dt_ * by_yaw_y * j(2, i);
        a(2, 3 + i) = dt_ * j(2, i);
      }
      const Column b = dt_ * a.template rightCols<kV>();

      const V& u = controls_[k];
      const V weight = params_.effort * limits_.rate.cwiseAbs2().cwiseInverse();
      const Column curve_b = curve * b;
      const V qu = b.transpose() * value + weight.cwiseProduct(u);
      const Gain qux = curve_b.transpose() * a;
      Input quu = b.transpose() * curve_b;
      quu.diagonal() += weight + V::Constant(damping);
      V change;
      Gain gain;
      const Box free = box(x.template tail<kV>());
      if (!limited(quu, qu, qux, free.low - u, free.high - u, change, gain)) return false;
      open_[k] = change;
      gains_[k] = gain;
      const X by_x = a.transpose() * value;
      value = by_x + gain.transpose() * (quu * change + qu) + qux.transpose() * change;
      Square next_curve = a.transpose() * curve * a;
      next_curve += gain.transpose() * quu * gain + gain.transpose() * qux + qux.transpose() * gain;
      curve = 0.5 * (next_curve + next_curve.transpose());
    }
    return true;
  }

  /// Minimises a quadratic within a box by projected Newton steps. Controls at their limit get no feedback
  /// gain.
  static bool limited(const Input& quu, const V& qu, const Gain& qux, const V& low, const V& high, V& change,
                      Gain& gain) {
    std::array<bool, kV> held{};
    change = V::Zero().cwiseMax(low).cwiseMin(high);
    for (int round = 0; round <= kV; ++round) {
      const V slope = qu + quu * change;
      for (int i = 0; i < kV; ++i)
        held[i] = (change[i] <= low[i] && slope[i] > 0) || (change[i] >= high[i] && slope[i] < 0);
      Input free = quu;
      V pull = -slope;
      for (int i = 0; i < kV; ++i) {
        if (!held[i]) continue;
        free.row(i).setZero();
        free.col(i).setZero();
        free(i, i) = 1.0;
        pull[i] = 0.0;
      }
      const Eigen::LLT<Input> solver(free);
      if (solver.info() != Eigen::Success) return false;
      const V step = solver.solve(pull);
      const V moved = (change + step).cwiseMax(low).cwiseMin(high);
      const bool done = (moved - change).cwiseAbs().maxCoeff() < 1e-9 || moved == change + step;
      change = moved;
      if (!done && round < kV) continue;
      Gain wanted = -qux;
      for (int i = 0; i < kV; ++i)
        if (held[i]) wanted.row(i).setZero();
      gain = solver.solve(wanted);
      break;
    }
    return true;
  }

  /// The forward pass, a line search with decreasing steps. Returns false when no step lowers the cost.
  bool search(double& cost) {
    for (double share = 1.0; share > 0.02; share *= 0.5) {
      trial_states_[0] = states_[0];
      double sum = 0.0;
      for (std::size_t k = 0; k < Horizon; ++k) {
        X off = trial_states_[k] - states_[k];
        off[2] = wrap_angle(off[2]);
        const Box free = box(trial_states_[k].template tail<kV>());
        trial_controls_[k] =
            (controls_[k] + share * open_[k] + gains_[k] * off).cwiseMax(free.low).cwiseMin(free.high);
        trial_states_[k + 1] = next(trial_states_[k], trial_controls_[k]);
        sum += stage_cost(trial_states_[k + 1], trial_controls_[k], k);
        if (!(sum < cost)) break;
      }
      if (!(sum < cost)) continue;  // Written so that a cost that is not a number fails.
      std::swap(states_, trial_states_);
      std::swap(controls_, trial_controls_);
      cost = sum;
      return true;
    }
    return false;
  }

  Model model_;
  Limits limits_;
  IlqrParams params_;
  double dt_;
  std::array<X, Horizon + 1> states_{}, trial_states_{};
  std::array<V, Horizon> controls_{}, trial_controls_{}, open_{};
  std::array<Gain, Horizon> gains_{};
  std::array<Goal, Horizon> goals_{};
};

}  // namespace adit::nav
