// The pieces that implicit steps are made of: the energy's derivatives, the matrix and its solver.
// The minimiser made of them: minimise_energy_test.cpp.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "sim/base/block_inverse.h"
#include "sim/mesh/rotation.h"
#include "sim/soft/conjugate_gradients.h"
#include "sim/soft/implicit_step.h"
#include "sim/soft/minimise_energy.h"
#include "sim/soft/vertex_matrix.h"
#include "tests/sim/minimiser_case.h"

namespace pneuma::sim {
namespace {

/// Gas that heats up when it is pressed together, in air of a pressure below and above its own.
void fill_with_air(MinimiserCase& c, double ambient) {
  c.energy.gas = {5000.0, 1.4, 60.0, ambient};
  ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
}

void expect_gradient(MinimiserCase& c) {
  const Eigen::VectorXd gradient = c.gradient();
  const double h = 1e-5;
  Eigen::VectorXd difference(c.size());
  for (int i = 0; i < c.size(); ++i) {
    const auto energy = [&] { return c.point.energy; };
    difference[i] = (c.moved(i, h, energy) - c.moved(i, -h, energy)) / (2.0 * h);
  }
  // Truncation h^2 E''' / 6 about 1e-9 of the gradient's thousand N, rounding 1e-16 E / h = 1e-7 N.
  EXPECT_LT((difference - gradient).norm() / gradient.norm(), 1e-8);
}

/// Column by column, from what the matrix makes of unit vectors when it is solved: M^-1 of it.
Eigen::MatrixXd dense(const VertexMatrix& matrix, int vertices) {
  Eigen::MatrixXd inverse(3 * vertices, 3 * vertices);
  for (int i = 0; i < 3 * vertices; ++i) {
    VertexArray unit(vertices);
    unit.rows()(i % 3, i / 3) = 1.0;
    matrix.solve(unit);
    inverse.col(i) = MinimiserCase::flat(unit);
  }
  return inverse.inverse();
}

Eigen::MatrixXd hessian_by_differences(MinimiserCase& c) {
  const double h = 1e-5;
  Eigen::MatrixXd result(c.size(), c.size());
  for (int i = 0; i < c.size(); ++i) {
    const auto gradient = [&] { return c.gradient(); };
    result.col(i) = (c.moved(i, h, gradient) - c.moved(i, -h, gradient)) / (2.0 * h);
  }
  return result;
}

TEST(IncrementalPotential, GradientEqualsFiniteDifferences) {
  MinimiserCase c(ball());
  expect_gradient(c);
  for (const double ambient : {20.0, 200.0}) {
    fill_with_air(c, ambient);
    expect_gradient(c);
  }
}

void expect_hessian(MinimiserCase& c) {
  VertexMatrix matrix(c.mesh().topology);
  hessian_without_rank_one(c.mesh(), c.energy, c.point, opposite_vertices(c.mesh().topology),
                           matrix);
  ASSERT_TRUE(matrix.factorize());
  const Eigen::VectorXd area = MinimiserCase::flat(c.point.volume_gradient);
  const Eigen::MatrixXd whole =
      dense(matrix, c.point.positions.size()) +
      pressure_slope(c.energy.gas, c.point.volume) * area * area.transpose();
  const Eigen::MatrixXd difference = hessian_by_differences(c);
  // As above, inverted twice.
  EXPECT_LT((difference - whole).norm() / whole.norm(), 1e-7) << c.energy.gas.exponent;
  // Sylvester's law, against the eigenvalues themselves.
  const Eigen::MatrixXd sparse = dense(matrix, c.point.positions.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(sparse);
  EXPECT_EQ(matrix.negative_count(), (solver.eigenvalues().array() < 0.0).count());
}

TEST(IncrementalPotential, HessianEqualsFiniteDifferencesOfTheGradient) {
  for (const double noise : {0.02, 0.3}) {
    MinimiserCase c(ball(), noise);
    expect_hessian(c);
    for (const double ambient : {20.0, 200.0}) {
      fill_with_air(c, ambient);
      expect_hessian(c);
    }
  }
}

TEST(VertexMatrix, FixingTakesACoordinateOut) {
  MinimiserCase c(ball());
  VertexMatrix matrix(c.mesh().topology);
  hessian_without_rank_one(c.mesh(), c.energy, c.point, opposite_vertices(c.mesh().topology),
                           matrix);
  ASSERT_TRUE(matrix.factorize());
  Eigen::MatrixXd expected = dense(matrix, c.point.positions.size());
  for (const auto& [vertex, axis] : {std::pair{0, 2}, std::pair{7, 2}, std::pair{13, 0}}) {
    matrix.fix(vertex, axis);
    expected.row(3 * vertex + axis).setZero();
    expected.col(3 * vertex + axis).setZero();
    expected(3 * vertex + axis, 3 * vertex + axis) = 1.0;
  }
  ASSERT_TRUE(matrix.factorize());
  const Eigen::MatrixXd pinned = dense(matrix, c.point.positions.size());
  EXPECT_LT((pinned - expected).norm() / expected.norm(), 1e-10);  // inverted twice
}

TEST(BlockInverse, StaysPositiveDefiniteWhereOneDirectionIsFarStiffer) {
  const Mat3 turned = rotation_of_degrees({20.0, 35.0, 50.0}).toRotationMatrix();
  for (const double stiff : {1.0, 1e4, 1e8, 1e12, 1e14}) {
    const Mat3 block = turned * Vec3(stiff, 1.0, 2.0).asDiagonal() * turned.transpose();
    const Mat3 symmetric = 0.5 * (block + block.transpose());
    Mat3 inverse;
    ASSERT_TRUE(base::invert_positive_definite(symmetric, inverse)) << stiff;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inverse);
    EXPECT_GT(solver.eigenvalues()[0], 0.0) << stiff;
    // Rounding of the block's entries, which are as large as its stiffness.
    EXPECT_NEAR(solver.eigenvalues()[2], 1.0, 1e-14 + 1e-15 * stiff) << stiff;
  }
}

TEST(BlockInverse, KnowsWhatIsNotPositiveDefinite) {
  const Mat3 turned = rotation_of_degrees({20.0, 35.0, 50.0}).toRotationMatrix();
  Mat3 inverse;
  for (const Vec3& values : {Vec3(-1.0, 1.0, 1.0), Vec3(1.0, -1.0, 1.0), Vec3(1.0, 1.0, -1.0),
                             Vec3(-1.0, -1.0, 1.0), Vec3(std::nan(""), 1.0, 1.0)}) {
    const Mat3 block = turned * values.asDiagonal() * turned.transpose();
    EXPECT_FALSE(base::invert_positive_definite(block, inverse)) << values.transpose();
  }
}

TEST(VertexMatrix, ProductsAreThoseOfTheDenseMatrix) {
  MinimiserCase c(ball(), 0.3);
  VertexMatrix matrix(c.mesh().topology);
  hessian_without_rank_one(c.mesh(), c.energy, c.point, opposite_vertices(c.mesh().topology),
                           matrix);
  ASSERT_TRUE(matrix.factorize());
  const int count = c.point.positions.size();
  const Eigen::MatrixXd whole = dense(matrix, count);
  VertexArray product(count);
  matrix.multiply(c.energy.target, product);
  const Eigen::VectorXd expected = whole * MinimiserCase::flat(c.energy.target);
  const double tolerance = 1e-10;  // inverted twice
  EXPECT_LT((MinimiserCase::flat(product) - expected).norm(), tolerance * expected.norm());
  for (int v = 0; v < count; ++v) {
    EXPECT_LT((matrix.diagonal_block(v) - whole.block<3, 3>(3 * v, 3 * v)).norm(),
              tolerance * whole.norm());
  }
}

/// S and q at the case's point.
struct Hessian {
  VertexMatrix matrix;
  VertexArray rank_one;

  explicit Hessian(MinimiserCase& c)
      : matrix(c.mesh().topology), rank_one(c.point.positions.size()) {
    hessian_without_rank_one(c.mesh(), c.energy, c.point, opposite_vertices(c.mesh().topology),
                             matrix);
    rank_one.rows() =
        std::sqrt(pressure(c.energy, c.point) / c.point.volume) * c.point.volume_gradient.rows();
  }
};

VertexArray random_rows(int count) {
  VertexArray rows(count);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int v = 0; v < count; ++v) {
    for (int axis = 0; axis < 3; ++axis) rows[v][axis] = uniform(random);
  }
  return rows;
}

TEST(VertexMatrix, MultipliesAndShowsItsDiagonal) {
  MinimiserCase c(ball());
  Hessian hessian(c);
  ASSERT_TRUE(hessian.matrix.factorize());
  const int vertices = c.point.positions.size();
  const Eigen::MatrixXd whole = dense(hessian.matrix, vertices);
  const VertexArray values = random_rows(vertices);
  VertexArray product(vertices);
  hessian.matrix.multiply(values, product);
  const Eigen::VectorXd expected = whole * MinimiserCase::flat(values);
  EXPECT_LT((MinimiserCase::flat(product) - expected).norm() / expected.norm(),
            1e-10);  // inverted twice
  for (int v = 0; v < vertices; ++v) {
    const Mat3 block = whole.block<3, 3>(3 * v, 3 * v);
    EXPECT_LT((hessian.matrix.diagonal_block(v) - block).norm() / block.norm(), 1e-10);
  }
}

/// The direction that conjugate gradients find, beside that of the whole Hessian: their distance in
/// the Hessian's own norm, which the residual bounds, over the latter's.
double direction_error(Hessian& hessian, const Eigen::MatrixXd& sparse,
                       const VertexArray& gradient) {
  const Eigen::VectorXd q = MinimiserCase::flat(hessian.rank_one);
  const Eigen::MatrixXd whole = sparse + q * q.transpose();
  VertexArray direction(gradient.size());
  ConjugateGradients gradients(gradient.size());
  EXPECT_EQ(gradients.solve(hessian.matrix, hessian.rank_one, gradient, direction),
            ConjugateGradients::End::solved);
  const Eigen::VectorXd found = MinimiserCase::flat(direction);
  const Eigen::VectorXd expected = -whole.ldlt().solve(MinimiserCase::flat(gradient));
  const Eigen::VectorXd error = found - expected;
  EXPECT_LT(found.dot(MinimiserCase::flat(gradient)), 0.0);
  return std::sqrt(error.dot(whole * error) / expected.dot(whole * expected));
}

/// Its residual is a thousandth; with H of a condition up to 100 beside its diagonal the error in
/// this norm is ten times that at most.
constexpr double greatest_direction_error = 1e-2;

TEST(ConjugateGradients, FindTheDirectionThatTheWholeHessianGives) {
  MinimiserCase c(ball(), 0.02);
  Hessian hessian(c);
  ASSERT_TRUE(hessian.matrix.factorize());
  const int vertices = c.point.positions.size();
  const Eigen::MatrixXd sparse = dense(hessian.matrix, vertices);
  EXPECT_LT(direction_error(hessian, sparse, random_rows(vertices)), greatest_direction_error);
}

TEST(ConjugateGradients, LeavePinnedCoordinatesAlone) {
  MinimiserCase c(ball(), 0.02);
  Hessian hessian(c);
  const int vertices = c.point.positions.size();
  VertexArray gradient = random_rows(vertices);
  for (const int v : {0, 7, 13}) {
    hessian.matrix.fix(v, 2);
    gradient[v].z() = hessian.rank_one[v].z() = 0.0;
  }
  ASSERT_TRUE(hessian.matrix.factorize());
  EXPECT_LT(direction_error(hessian, dense(hessian.matrix, vertices), gradient),
            greatest_direction_error);
  VertexArray direction(vertices);
  ConjugateGradients gradients(vertices);
  gradients.solve(hessian.matrix, hessian.rank_one, gradient, direction);
  for (const int v : {0, 7, 13}) EXPECT_EQ(direction[v].z(), 0.0);
}

TEST(ConjugateGradients, SolveWhatOnlyTheRankOneTermMakesPositive) {
  MinimiserCase c(ball());
  Hessian hessian(c);
  const int vertices = c.point.positions.size();
  hessian.matrix.set_identity(1.0);
  for (int e = 0; e < c.mesh().topology.edge_count(); ++e) {
    hessian.matrix.add_between(e, mat3x4(0.05 * Mat3::Identity()));
  }
  hessian.matrix.add(4, mat3x4(Mat3(Vec3(-1.5, 0.0, 0.0).asDiagonal())));
  hessian.rank_one.rows().setZero();
  hessian.rank_one[4].x() = 1.5;
  ASSERT_TRUE(hessian.matrix.factorize());
  ASSERT_EQ(hessian.matrix.negative_count(), 1);
  EXPECT_LT(direction_error(hessian, dense(hessian.matrix, vertices), random_rows(vertices)),
            greatest_direction_error);
}

TEST(ConjugateGradients, SeeThatAMatrixIsNotPositive) {
  const SoftBody body = make_body(ball());
  const int vertices = body.positions.size();
  const VertexArray none(vertices), gradient = random_rows(vertices);
  VertexArray direction(vertices);
  ConjugateGradients gradients(vertices);
  VertexMatrix matrix(body.mesh->topology);
  matrix.set_identity(-1.0);
  EXPECT_EQ(gradients.solve(matrix, none, gradient, direction),
            ConjugateGradients::End::not_positive);
  // The blocks on the diagonal are, but between the ends of an edge is more.
  matrix.set_identity(1.0);
  for (int e = 0; e < body.mesh->topology.edge_count(); ++e) {
    matrix.add_between(e, mat3x4(Mat3::Identity()));
  }
  EXPECT_EQ(gradients.solve(matrix, none, gradient, direction),
            ConjugateGradients::End::not_positive);
}

TEST(ConjugateGradients, GiveUpWhereSpringsAreStiff) {
  MinimiserCase c(ball(), 0.0);
  c.energy.inertia = 1e-9;
  c.energy.gas.strength = 0.0;
  ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
  Hessian hessian(c);
  const int vertices = c.point.positions.size();
  VertexArray direction(vertices);
  ConjugateGradients gradients(vertices);
  EXPECT_EQ(gradients.solve(hessian.matrix, hessian.rank_one, random_rows(vertices), direction),
            ConjugateGradients::End::too_slow);
  const auto promises = ConjugateGradients::promises_to_be_quick;
  EXPECT_FALSE(promises(vertices, c.energy.stiffness, c.energy.inertia));
  EXPECT_TRUE(promises(vertices, c.energy.stiffness, 200.0));
}

}  // namespace
}  // namespace pneuma::sim
