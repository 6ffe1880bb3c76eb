// SPDX-License-Identifier: Apache-2.0
#include "nav/control/ilqr.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/nav/ceres_problem.hpp"
#include "tests/nav/wave.hpp"

namespace adit::nav::test {
namespace {

template <class Model>
class IlqrTest : public testing::Test {
 public:
  using Solver = Ilqr<Model>;
  using X = typename Solver::X;
  using References = std::array<Reference, Solver::kHorizon>;

  static References ahead(double t, double speed = 0.7) {
    References references;
    for (std::size_t k = 0; k < references.size(); ++k)
      references[k] = wave(t + kWaveDt * static_cast<double>(k + 1), speed);
    return references;
  }
  static X at(const Pose2& pose, const Twist2& twist) {
    X x;
    x.template head<3>() << pose.x, pose.y, pose.yaw;
    x.template tail<Model::kVelocities>() = Bench<Model>::model().inverse(twist);
    return x;
  }
  static Solver make(const IlqrParams& params = {}) {
    return Solver(Bench<Model>::model(), Bench<Model>::limits(), params, kWaveDt);
  }
  Solver solver = make();
};
using Models = testing::Types<model::Unicycle, model::Car, model::Holonomic>;
TYPED_TEST_SUITE(IlqrTest, Models);

TYPED_TEST(IlqrTest, KeepsToAWaveWithinMillimetres) {
  auto x = this->at({0, 0.1, 0.5}, {0.5, 0, 0});
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const auto references = this->ahead(kWaveDt * i);
    this->solver.solve(x, references);
    x = this->solver.state(1);
    const Pose2& r = references.front().pose;
    const double across = -std::sin(r.yaw) * (x[0] - r.x) + std::cos(r.yaw) * (x[1] - r.y);
    if (i > 40) worst = std::max(worst, std::fabs(across));
  }
  EXPECT_LT(worst, 0.01);
}

TYPED_TEST(IlqrTest, ControlsStayInTheirBox) {
  // Far off and the wrong way round: everything that there is, and not more.
  const auto x = this->at({-1, 2, 2.5}, {});
  this->solver.solve(x, this->ahead(0, 1.4));
  bool reached = false;
  for (const auto& u : this->solver.controls())
    for (int i = 0; i < TypeParam::kVelocities; ++i) {
      const double limit = Bench<TypeParam>::limits().rate[i];
      EXPECT_LE(std::fabs(u[i]), limit + 1e-12);
      reached |= std::fabs(u[i]) > limit - 1e-9;
    }
  EXPECT_TRUE(reached);
}

TYPED_TEST(IlqrTest, NoSmallChangeOfAnyControlIsBetter) {
  // A local optimum within the box, by a check that shares nothing with the solver's derivatives.
  IlqrParams params;
  params.iterations = 100;
  params.tolerance = 1e-12;
  auto exact = this->make(params);
  const auto x = this->at({0, 0.3, 0.3}, {0.2, 0, 0});
  const auto references = this->ahead(0);
  const double best = exact.solve(x, references).cost;
  auto controls = exact.controls();
  for (std::size_t k = 0; k < controls.size(); ++k)
    for (int i = 0; i < TypeParam::kVelocities; ++i)
      for (const double change : {-1e-3, 1e-3}) {
        auto other = controls;
        const double limit = Bench<TypeParam>::limits().rate[i];
        other[k][i] = std::clamp(other[k][i] + change, -limit, limit);
        EXPECT_GE(exact.cost(x, references, other), best - 1e-7) << "step " << k << " control " << i;
      }
}

TYPED_TEST(IlqrTest, CostIsAsLowAsThatOfCeres) {
  IlqrParams params;
  params.iterations = 100;
  params.tolerance = 1e-10;
  for (const Pose2& pose : {Pose2{0, 0.1, 0.5}, Pose2{0, 0.4, 0.2}, Pose2{-0.3, -0.2, 1.0}}) {
    const auto x = this->at(pose, {0.3, 0, 0});
    const auto references = this->ahead(0);
    const double ours = this->make(params).solve(x, references).cost;
    const double theirs =
        CeresProblem<TypeParam>({Bench<TypeParam>::model(), Bench<TypeParam>::limits(), params, kWaveDt}, x,
                                references)
            .solve();
    EXPECT_LE(ours, 1.001 * theirs);
    EXPECT_GE(ours, 0.9 * theirs) << "Ceres ends a little early; more apart is another problem";
  }
}

TYPED_TEST(IlqrTest, AJacobianIsTheDerivativeOfTheTwist) {
  const TypeParam model = Bench<TypeParam>::model();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  for (int n = 0; n < 20; ++n) {
    typename TypeParam::V v;
    for (int i = 0; i < TypeParam::kVelocities; ++i) v[i] = any(random);
    for (int i = 0; i < TypeParam::kVelocities; ++i) {
      auto more = v, less = v;
      more[i] += 1e-6;
      less[i] -= 1e-6;
      const Eigen::Vector3d slope = (model.twist(more) - model.twist(less)) / 2e-6;
      EXPECT_LT((slope - model.jacobian(v).col(i)).norm(), 1e-6);
    }
  }
}

TYPED_TEST(IlqrTest, IgnoresInputThatIsNotFinite) {
  auto references = this->ahead(0);
  references[7].pose.x = std::nan("");
  this->solver.solve(this->at({}, {}), references);
  for (const auto& u : this->solver.controls()) EXPECT_TRUE(u.allFinite());
  this->solver.reset();
  EXPECT_LT(this->solver.solve(this->at({}, {}), this->ahead(0)).cost, 1e6);
}

}  // namespace
}  // namespace adit::nav::test
