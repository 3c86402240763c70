// The pieces that implicit steps are made of: the energy's derivatives, the matrix, the minimiser.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "sim/soft/conjugate_gradients.h"
#include "sim/soft/implicit_step.h"
#include "sim/soft/minimise_energy.h"
#include "sim/soft/vertex_matrix.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// A step's energy with every term in it, at a crumpled body of which some springs are stretched
/// and some pressed, with vertices that friction holds, and others that slide.
struct Case {
  SoftBody body;
  IncrementalPotential energy;
  EnergyPoint point;

  explicit Case(const TriangleMesh& mesh, double noise = 0.3)
      : body(make_body(mesh)), energy(*body.mesh), point(*body.mesh) {
    perturb(body, noise, 1);
    point.positions.rows() = body.positions.rows();
    energy.inertia = 200.0;
    energy.target.rows() = body.mesh->rest_positions.rows();
    energy.stiffness = 300.0;
    energy.rest_lengths = body.mesh->rest_lengths;
    energy.gas = 5000.0;
    energy.friction = true;
    energy.regularisation_length = 0.2;
    energy.friction_anchor.rows() = body.mesh->rest_positions.rows();
    std::fill(energy.friction_bound.begin(), energy.friction_bound.end(), 10.0);
    EXPECT_TRUE(evaluate(*body.mesh, energy, point));
  }

  const SoftMesh& mesh() const { return *body.mesh; }
  int size() const { return 3 * point.positions.size(); }

  Eigen::VectorXd gradient() {
    VertexArray rows(point.positions.size());
    gradient_without_gas(mesh(), energy, point, rows);
    rows.rows() -= pressure(energy, point) * point.volume_gradient.rows();
    return flat(rows);
  }

  static Eigen::VectorXd flat(const VertexArray& values) {
    Eigen::VectorXd result(3 * values.size());
    for (int v = 0; v < values.size(); ++v) result.segment<3>(3 * v) = values[v];
    return result;
  }

  /// `value` at a place moved by `h` along one coordinate.
  template <class Function>
  auto moved(int coordinate, double h, const Function& value) {
    double& x = point.positions.rows()(coordinate % 3, coordinate / 3);
    const double here = x;
    x = here + h;
    EXPECT_TRUE(evaluate(mesh(), energy, point));
    const auto result = value();
    x = here;
    EXPECT_TRUE(evaluate(mesh(), energy, point));
    return result;
  }
};

TriangleMesh ball() { return make_sphere(3.0, 5, 6); }

TEST(IncrementalPotential, GradientEqualsFiniteDifferences) {
  Case c(ball());
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
    inverse.col(i) = Case::flat(unit);
  }
  return inverse.inverse();
}

Eigen::MatrixXd hessian_by_differences(Case& c) {
  const double h = 1e-5;
  Eigen::MatrixXd result(c.size(), c.size());
  for (int i = 0; i < c.size(); ++i) {
    const auto gradient = [&] { return c.gradient(); };
    result.col(i) = (c.moved(i, h, gradient) - c.moved(i, -h, gradient)) / (2.0 * h);
  }
  return result;
}

TEST(IncrementalPotential, HessianEqualsFiniteDifferencesOfTheGradient) {
  for (const double noise : {0.02, 0.3}) {
    Case c(ball(), noise);
    VertexMatrix matrix(c.mesh().topology);
    hessian_without_rank_one(c.mesh(), c.energy, c.point, opposite_vertices(c.mesh().topology),
                             matrix);
    ASSERT_TRUE(matrix.factorize());
    const Eigen::VectorXd area = Case::flat(c.point.volume_gradient);
    const Eigen::MatrixXd whole =
        dense(matrix, c.point.positions.size()) +
        pressure(c.energy, c.point) / c.point.volume * area * area.transpose();
    const Eigen::MatrixXd difference = hessian_by_differences(c);
    EXPECT_LT((difference - whole).norm() / whole.norm(), 1e-7)
        << noise;  // as above, inverted twice
    // Sylvester's law, against the eigenvalues themselves.
    const Eigen::MatrixXd sparse = dense(matrix, c.point.positions.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(sparse);
    EXPECT_EQ(matrix.negative_count(), (solver.eigenvalues().array() < 0.0).count());
  }
}

TEST(VertexMatrix, FixingTakesACoordinateOut) {
  Case c(ball());
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

/// S and q at the case's point.
struct Hessian {
  VertexMatrix matrix;
  VertexArray rank_one;

  explicit Hessian(Case& c) : matrix(c.mesh().topology), rank_one(c.point.positions.size()) {
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
  Case c(ball());
  Hessian hessian(c);
  ASSERT_TRUE(hessian.matrix.factorize());
  const int vertices = c.point.positions.size();
  const Eigen::MatrixXd whole = dense(hessian.matrix, vertices);
  const VertexArray values = random_rows(vertices);
  VertexArray product(vertices);
  hessian.matrix.multiply(values, product);
  const Eigen::VectorXd expected = whole * Case::flat(values);
  EXPECT_LT((Case::flat(product) - expected).norm() / expected.norm(), 1e-10);  // inverted twice
  for (int v = 0; v < vertices; ++v) {
    const Mat3 block = whole.block<3, 3>(3 * v, 3 * v);
    EXPECT_LT((hessian.matrix.diagonal_block(v) - block).norm() / block.norm(), 1e-10);
  }
}

/// The direction that conjugate gradients find, beside that of the whole Hessian: their distance in
/// the Hessian's own norm, which the residual bounds, over the latter's.
double direction_error(Hessian& hessian, const Eigen::MatrixXd& sparse,
                       const VertexArray& gradient) {
  const Eigen::VectorXd q = Case::flat(hessian.rank_one);
  const Eigen::MatrixXd whole = sparse + q * q.transpose();
  VertexArray direction(gradient.size());
  ConjugateGradients gradients(gradient.size());
  EXPECT_EQ(gradients.solve(hessian.matrix, hessian.rank_one, gradient, direction),
            ConjugateGradients::End::solved);
  const Eigen::VectorXd found = Case::flat(direction);
  const Eigen::VectorXd expected = -whole.ldlt().solve(Case::flat(gradient));
  const Eigen::VectorXd error = found - expected;
  EXPECT_LT(found.dot(Case::flat(gradient)), 0.0);
  return std::sqrt(error.dot(whole * error) / expected.dot(whole * expected));
}

/// Its residual is a thousandth; with H of a condition up to 100 beside its diagonal the error in
/// this norm is ten times that at most.
constexpr double greatest_direction_error = 1e-2;

TEST(ConjugateGradients, FindTheDirectionThatTheWholeHessianGives) {
  Case c(ball(), 0.02);
  Hessian hessian(c);
  ASSERT_TRUE(hessian.matrix.factorize());
  const int vertices = c.point.positions.size();
  const Eigen::MatrixXd sparse = dense(hessian.matrix, vertices);
  EXPECT_LT(direction_error(hessian, sparse, random_rows(vertices)), greatest_direction_error);
}

TEST(ConjugateGradients, LeavePinnedCoordinatesAlone) {
  Case c(ball(), 0.02);
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
  Case c(ball());
  Hessian hessian(c);
  const int vertices = c.point.positions.size();
  hessian.matrix.set_identity(1.0);
  for (int e = 0; e < c.mesh().topology.edge_count(); ++e) {
    hessian.matrix.add_between(e, 0.05 * Mat3::Identity());
  }
  hessian.matrix.add(4, Vec3(-1.5, 0.0, 0.0).asDiagonal());
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
  for (int e = 0; e < body.mesh->topology.edge_count(); ++e)
    matrix.add_between(e, Mat3::Identity());
  EXPECT_EQ(gradients.solve(matrix, none, gradient, direction),
            ConjugateGradients::End::not_positive);
}

TEST(ConjugateGradients, GiveUpWhereSpringsAreStiff) {
  Case c(ball(), 0.0);
  c.energy.inertia = 1e-9;
  c.energy.gas = 0.0;
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

/// What holds at a least value on or above the floor: no force but that of the floor, upwards.
void expect_least(Case& c, EnergyMinimiser& minimiser) {
  minimiser.update_gradient(c.energy);
  c.point = minimiser.point();
  const Eigen::VectorXd gradient = c.gradient();
  for (int v = 0; v < c.point.positions.size(); ++v) {
    const double floor_force = minimiser.floor_force(c.energy, v);
    if (c.energy.ground) {
      EXPECT_GE(c.point.positions[v].z(), c.energy.floor[at(v)]);
    }
    // N: the tolerance of 1e-10 m times a stiffness of some thousand N/m.
    EXPECT_LT((gradient.segment<3>(3 * v) - Vec3(0.0, 0.0, floor_force)).norm(), 1e-5) << v;
  }
}

TEST(EnergyMinimiser, EndsWhereNoForceIsLeftButThatOfTheFloor) {
  for (const bool ground : {false, true}) {
    for (const auto& [noise, gas] : {std::pair{0.02, 5000.0}, std::pair{0.3, 5000.0},
                                     std::pair{1.5, 5000.0}, std::pair{0.3, 0.0}}) {
      Case c(make_sphere(3.0, 8, 8), noise);
      c.energy.ground = ground;
      c.energy.gas = gas;
      for (int v = 0; v < c.point.positions.size(); ++v) {
        c.energy.floor[at(v)] = ground ? std::min(-2.0, c.point.positions[v].z()) : -1e9;
        c.energy.target[v].z() -= 1.5;
      }
      ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
      const double start = c.point.energy;
      EnergyMinimiser minimiser(c.mesh());
      minimiser.point() = c.point;
      const MinimiserReport report = minimiser.minimise(c.energy, 1e-10);
      EXPECT_TRUE(report.converged);
      EXPECT_LT(minimiser.point().energy, start);
      EXPECT_GT(minimiser.point().volume, 0.0);
      expect_least(c, minimiser);
    }
  }
}

TEST(EnergyMinimiser, FindsTheOnlyMinimumOfSpringsInClosedForm) {
  // Without gas and with rest lengths of zero E is quadratic: A (x - y) + s L x = 0, L the graph's
  // Laplacian. By conjugate gradients, and by factors, of which one solution is exact.
  for (const auto& [stiffness, iterations] : {std::pair{300.0, 4}, std::pair{3e4, 2}}) {
    Case c(ball(), 0.3);
    c.energy.gas = 0.0;
    c.energy.friction = false;
    c.energy.stiffness = stiffness;
    std::fill(c.energy.rest_lengths.begin(), c.energy.rest_lengths.end(), 0.0);
    ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
    const int vertices = c.point.positions.size();
    Eigen::MatrixXd system = c.energy.inertia * Eigen::MatrixXd::Identity(vertices, vertices);
    for (const auto& [a, b] : c.mesh().topology.edges()) {
      system(a, a) += c.energy.stiffness;
      system(b, b) += c.energy.stiffness;
      system(a, b) -= c.energy.stiffness;
      system(b, a) -= c.energy.stiffness;
    }
    const Eigen::MatrixXd expected =
        system.ldlt().solve(c.energy.inertia * c.energy.target.rows().transpose()).transpose();
    EnergyMinimiser minimiser(c.mesh());
    minimiser.point() = c.point;
    const MinimiserReport report = minimiser.minimise(c.energy, 1e-10);
    EXPECT_LE(report.iterations, iterations);
    EXPECT_EQ(report.factorizations, stiffness == 300.0 ? 0 : 1);
    EXPECT_LT((minimiser.point().positions.rows() - expected).norm(), 1e-10);
  }
}

TEST(EnergyMinimiser, KnowsNothingOfTheBodyBefore) {
  // One with gas, of a volume far from 1 m^3, and then one without.
  Case full(ball()), empty(ball());
  empty.energy.gas = 0.0;
  ASSERT_TRUE(evaluate(empty.mesh(), empty.energy, empty.point));
  EnergyMinimiser used(full.mesh()), fresh(full.mesh());
  used.point() = full.point;
  EXPECT_TRUE(used.minimise(full.energy, 1e-10).converged);
  used.forget();
  for (EnergyMinimiser* minimiser : {&used, &fresh}) {
    minimiser->point().positions.rows() = empty.point.positions.rows();
    ASSERT_TRUE(evaluate(empty.mesh(), empty.energy, minimiser->point()));
    EXPECT_TRUE(minimiser->minimise(empty.energy, 1e-10).converged);
  }
  EXPECT_EQ(used.point().positions.rows(), fresh.point().positions.rows());
}

TEST(EnergyMinimiser, IsNotStoppedByOneKinkOfFrictionAfterTheOther) {
  // A light body that is blown up against the ground: dozens of vertices come to rest there in one
  // step. One after the other they took up to 55 iterations here, and 131 with 2,562 vertices.
  World world;
  world.settings.integrator = Integrator::implicit_euler;
  SoftBody body = make_body(make_icosphere(3.0, 3), {0.0, 0.0, 3.2});
  body.material.k = 1.0;
  body.material.n = 1.0;
  body.material.vertex_mass = 20.0 / body.positions.size();
  ImplicitScratch scratch(*body.mesh);
  int pushed = 0;
  for (int step = 0; step < 8; ++step) {
    const SoftState start{body.positions, body.velocities};
    const ImplicitReport report = implicit_step(*body.mesh, body.material, world.settings, start,
                                                body.positions, body.velocities, scratch);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 20) << step;  // of up to four rounds of friction
    pushed = static_cast<int>(std::count(scratch.pushed.begin(), scratch.pushed.end(), 1));
  }
  EXPECT_GT(pushed, 50);
}

TEST(EnergyMinimiser, ComesBackFromAVolumeOfAlmostNothing) {
  // The pressure of 5,000 J in 1e-12 m^3 is that of the inside of the sun.
  Case c(make_sphere(3.0, 8, 8), 0.0);
  for (int v = 0; v < c.point.positions.size(); ++v) c.point.positions[v].z() *= 1e-14;
  ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
  ASSERT_LT(c.point.volume, 1e-12);
  EnergyMinimiser minimiser(c.mesh());
  minimiser.point() = c.point;
  EXPECT_TRUE(minimiser.minimise(c.energy, 1e-10).converged);
  expect_least(c, minimiser);
}

}  // namespace
}  // namespace pneuma::sim
