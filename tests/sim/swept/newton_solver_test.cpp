// Solvers of contact impulses beside each other: Gauss-Seidel iterations, conjugate ones and
// Newton's method; and the sparse factorisation beside Eigen's.
#include "sim/swept/newton_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <deque>
#include <random>
#include <set>

#include "sim/rigid/inertia.h"
#include "sim/swept/conjugate_iterations.h"
#include "sim/swept/gauss_seidel.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

TEST(EnvelopeCholesky, SolvesAsADenseFactorisation) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  EnvelopeCholesky sparse;
  for (int size = 1; size < 40; ++size) {
    std::vector<int> first(at(size));
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i) first[at(i)] = std::max(0, i - static_cast<int>(random() % 9));
    sparse.reset(first);
    for (int i = 0; i < size; ++i) {
      for (int j = first[at(i)]; j < i; ++j) dense(i, j) = dense(j, i) = any(random);
      dense(i, i) = 10.0 + any(random);
      for (int j = first[at(i)]; j <= i; ++j) sparse.entry(i, j) = dense(i, j);
    }
    std::vector<double> x(at(size));
    for (double& value : x) value = any(random);
    const Eigen::VectorXd right = Eigen::VectorXd::Map(x.data(), size);
    ASSERT_TRUE(sparse.factor());
    sparse.solve(x);
    EXPECT_LT((dense * Eigen::VectorXd::Map(x.data(), size) - right).norm(), 1e-13) << size;
  }
}

/// Rows in groups that begin in the same column, as those of a body do, are reduced together.
TEST(EnvelopeCholesky, SolvesForGroupsOfRowsAsADenseFactorisation) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  EnvelopeCholesky sparse;
  for (int group = 1; group < 15; ++group) {
    const int size = 8 * group;
    std::vector<int> first(at(size));
    for (int i = 0; i < size; i += group) {
      std::fill_n(first.begin() + i, group, std::max(0, i - static_cast<int>(random() % 30)));
    }
    sparse.reset(first);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i) {
      for (int j = first[at(i)]; j < i; ++j) dense(i, j) = dense(j, i) = any(random);
      dense(i, i) = 40.0 + any(random);
      for (int j = first[at(i)]; j <= i; ++j) sparse.entry(i, j) = dense(i, j);
    }
    const Eigen::VectorXd right = Eigen::VectorXd::Constant(size, 1.0);
    std::vector<double> x(at(size), 1.0);
    ASSERT_TRUE(sparse.factor());
    sparse.solve(x);
    EXPECT_LT((dense * Eigen::VectorXd::Map(x.data(), size) - right).norm(), 1e-13) << group;
  }
}

TEST(EnvelopeCholesky, SaysWhenAMatrixIsNotPositive) {
  EnvelopeCholesky matrix;
  matrix.reset(std::vector{0, 0});
  matrix.entry(0, 0) = 1.0;
  matrix.entry(1, 0) = 2.0;
  matrix.entry(1, 1) = 1.0;
  EXPECT_FALSE(matrix.factor());
}

/// Cubes of 2 m on each other and on the ground, falling at 1 m/s: the impulses at their corners
/// must stop them.
class StackOfNodes {
 public:
  explicit StackOfNodes(const std::vector<double>& masses) {
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const RigidBox box =
          make_rigid({2.0, 2.0, 2.0}, {0.0, 0.0, 1.0 + 2.0 * static_cast<double>(i)}, masses[i]);
      changes_.push_back(make_box_change(box, box.position, box.orientation));
    }
    for (std::size_t i = 0; i < masses.size(); ++i) {
      for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
          const Vec3 point(x, y, 2.0 * static_cast<double>(i));
          const SweptSide below = i > 0 ? SweptSide(changes_[i - 1], point) : SweptSide();
          impulses_.emplace_back(SweptSide(changes_[i], point), below, Vec3::UnitZ(), 0.5);
          impulses_.back().aim(i > 0 ? 0.0 : 1.0, Vec3::Zero());  // the cube below falls as fast
        }
      }
    }
    for (SweptImpulse& impulse : impulses_) pointers_.push_back(&impulse);
    for (int i = 0; i < static_cast<int>(impulses_.size()); ++i) {
      nodes_.push_back({i / 4, i / 4 - 1, -1, -1, -1, -1});
    }
  }

  std::span<SweptImpulse* const> impulses() const { return pointers_; }
  /// The cubes that each impulse moves.
  std::span<const ImpulseNodes> nodes() const { return nodes_; }
  double iterate(double tolerance, int iterations) {
    return GaussSeidel(changes_.size()).correct(pointers_, nodes_, tolerance, iterations);
  }
  /// m/s and rad/s, by which a cube is not yet stopped.
  double error() const {
    double worst = 0.0;
    for (const BoxChange& change : changes_) {
      const Vec3 missing = Vec3::UnitZ() - to_vec3(change.velocity);
      worst = std::max({worst, missing.norm(), to_vec3(change.angular_velocity).norm()});
    }
    return worst;
  }

 private:
  std::deque<BoxChange> changes_;
  std::deque<SweptImpulse> impulses_;
  std::vector<SweptImpulse*> pointers_;
  std::vector<ImpulseNodes> nodes_;
};

void improve_with_growing_penalty(StackOfNodes& stack) {
  NewtonSolver solver;
  ASSERT_TRUE(solver.begin(stack.impulses()));
  for (double penalty = 1e3; penalty < 1e9; penalty *= 30.0) {
    ASSERT_TRUE(solver.improve(penalty));
  }
}

TEST(NewtonSolver, StopsAStackThatIterationsDoNotStop) {
  StackOfNodes stack(std::vector(20, 1.0)), iterated(std::vector(20, 1.0));
  improve_with_growing_penalty(stack);
  EXPECT_LT(stack.error(), 1e-6);
  iterated.iterate(0.0, 10'000);
  EXPECT_GT(iterated.error(), 0.01);
}

TEST(GaussSeidel, EndsWhereNoCorrectionIsLeft) {
  constexpr double tolerance = 1e-4;
  StackOfNodes stack(std::vector(6, 1.0));
  EXPECT_LE(stack.iterate(tolerance, 100'000), tolerance);
  for (SweptImpulse* impulse : stack.impulses()) EXPECT_LE(impulse->correct(), 2.0 * tolerance);
  EXPECT_LT(stack.error(), 0.02);  // the tolerance, times what is left in a stack of six by then
}

/// What has settled is not touched for the sake of what has not.
TEST(GaussSeidel, CorrectsOnlyWhatDependsOnTheUnsettled) {
  StackOfNodes tall(std::vector(20, 1.0)), low(std::vector(2, 1.0)), alone(std::vector(2, 1.0));
  std::vector<SweptImpulse*> impulses(low.impulses().begin(), low.impulses().end());
  std::vector<ImpulseNodes> nodes(low.nodes().begin(), low.nodes().end());
  impulses.insert(impulses.end(), tall.impulses().begin(), tall.impulses().end());
  for (ImpulseNodes of_tall : tall.nodes()) {
    for (int& node : of_tall) node += node < 0 ? 0 : 2;
    nodes.push_back(of_tall);
  }
  constexpr double tolerance = 1e-3;
  EXPECT_GT(GaussSeidel(22).correct(impulses, nodes, tolerance, 200), tolerance);
  EXPECT_LE(alone.iterate(tolerance, 200), tolerance);
  for (std::size_t i = 0; i < low.impulses().size(); ++i) {
    EXPECT_EQ(low.impulses()[i]->normal_impulse(), alone.impulses()[i]->normal_impulse());
  }
}

void iterate_conjugately(StackOfNodes& stack, int iterations) {
  ConjugateIterations conjugate;
  conjugate.begin(stack.impulses());
  conjugate.correct(0.0, iterations);
}

/// Of boxes many are corrected at once, each as by itself.
TEST(ConjugateIterations, BeginWithOneCorrectionOfEach) {
  StackOfNodes stack({1.0, 2.0}), iterated({1.0, 2.0});
  iterate_conjugately(stack, 1);
  iterated.iterate(0.0, 1);
  for (std::size_t i = 0; i < stack.impulses().size(); ++i) {
    const SweptImpulse &one = *stack.impulses()[i], &other = *iterated.impulses()[i];
    EXPECT_NEAR(one.normal_impulse(), other.normal_impulse(), 1e-13) << i;
    EXPECT_LT((one.friction_impulse() - other.friction_impulse()).norm(), 1e-13) << i;
  }
}

TEST(ConjugateIterations, NeedAFractionOfThePlainOnes) {
  StackOfNodes stack(std::vector(8, 1.0)), iterated(std::vector(8, 1.0));
  iterate_conjugately(stack, 200);
  iterated.iterate(0.0, 1'000);
  EXPECT_LT(stack.error(), iterated.error());
}

TEST(ConjugateIterations, EndWithinTheLimits) {
  for (const int iterations : {1, 2, 3, 5, 8, 13}) {
    StackOfNodes stack(std::vector(20, 1.0));
    iterate_conjugately(stack, iterations);
    for (const SweptImpulse* impulse : stack.impulses()) {
      EXPECT_GE(impulse->normal_impulse(), 0.0);
      EXPECT_LE(impulse->friction_impulse().norm(), 0.5 * impulse->normal_impulse() + 1e-12);
    }
  }
}

/// Boxes go on by themselves, and their impulses too.
TEST(ConjugateIterations, GiveBoxesTheMomentumOfTheImpulses) {
  StackOfNodes stack(std::vector(20, 1.0));
  iterate_conjugately(stack, 13);
  std::set<const BoxChange*> boxes;
  Vec3 momentum = Vec3::Zero(), given = Vec3::Zero();
  for (const SweptImpulse* impulse : stack.impulses()) {
    for (const SweptSide* side : {&impulse->first(), &impulse->second()}) {
      if (!side->box() || !boxes.insert(side->box()).second) continue;
      momentum += to_vec3(side->box()->velocity) / side->box()->inverse_mass;
    }
  }
  for (const SweptImpulse* impulse : stack.impulses().first(4)) given += impulse->given();
  EXPECT_GT(given.z(), 1.0);
  EXPECT_LT((momentum - given).norm(), 1e-12 * given.z());
}

TEST(NewtonSolver, StopsAStackAsIterationsWithoutEndDo) {
  StackOfNodes stack(std::vector(3, 1.0)), iterated(std::vector(3, 1.0));
  improve_with_growing_penalty(stack);
  iterated.iterate(0.0, 10'000);
  EXPECT_LT(stack.error(), 1e-8);
  EXPECT_LT(iterated.error(), 1e-8);
}

TEST(NewtonSolver, StopsAThousandKilogramsOnCubesOfOne) {
  std::vector<double> masses(10, 1.0);
  masses.back() = 1000.0;
  StackOfNodes stack(masses);
  improve_with_growing_penalty(stack);
  EXPECT_LT(stack.error(), 1e-5);
  double carried = 0.0;
  for (const SweptImpulse* impulse : stack.impulses().first(4)) carried += impulse->given().z();
  EXPECT_NEAR(carried, 1009.0, 0.01);
}

TEST(NewtonSolver, LeavesAloneWhatIsTooLarge) {
  StackOfNodes stack(std::vector(1000, 1.0));
  NewtonSolver solver;
  EXPECT_FALSE(solver.begin(stack.impulses()));
  for (const SweptImpulse* impulse : stack.impulses()) EXPECT_EQ(impulse->normal_impulse(), 0.0);
}

/// Of the step of one impulse, by central differences, wherever clamped, sticking or sliding: the
/// stiffness is that of the impulse, symmetric and not negative, so that -given is the gradient of
/// a convex function.
TEST(NewtonSolver, ImpulsesRespondByTheGradientOfAConvexFunction) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const RigidBox box = make_rigid({1.0, 2.0, 0.5}, Vec3::Zero(), 3.0);
  for (int i = 0; i < 200; ++i) {
    BoxChange change = make_box_change(box, box.position, box.orientation);
    const Vec3 normal = Vec3(any(random), any(random), any(random)).normalized();
    SweptImpulse impulse(SweptSide(change, {0.5, any(random), 0.25}), {}, normal, 0.5);
    impulse.aim(any(random), {any(random), any(random), any(random)});
    impulse.start_from(0.3 + 0.3 * any(random), Vec3::Zero());
    const Vec3 at_change(any(random), any(random), any(random));
    const auto response = impulse.respond(to_vec4d(at_change), 2.0);
    constexpr double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const auto up = impulse.respond(to_vec4d(at_change + h * Vec3::Unit(k)), 2.0);
      const auto down = impulse.respond(to_vec4d(at_change - h * Vec3::Unit(k)), 2.0);
      const Vec3 slope = to_vec3(up.given - down.given) / (2.0 * h);
      EXPECT_LT((slope + response.stiffness.col(k)).norm(), 1e-5) << i;
    }
    const Mat3& stiffness = response.stiffness;
    EXPECT_TRUE(stiffness.isApprox(stiffness.transpose(), 1e-12) || stiffness.isZero()) << i;
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(stiffness, Eigen::EigenvaluesOnly);
    EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-12 * stiffness.norm()) << i;
  }
}

}  // namespace
}  // namespace pneuma::sim
