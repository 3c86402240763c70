#include "sim/equilibrium/held_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "sim/inspect/inspect.h"
#include "tests/sim/equilibrium/balanced_body.h"

namespace pneuma::sim {
namespace {

SoftBody held_body(const TriangleMesh& mesh, const SoftMaterial& material) {
  SoftBody body = make_body(mesh);
  body.material = material;
  body.mesh = held_mesh(*body.mesh, body.positions, material);
  return body;
}

TEST(HeldShape, AsksNoMoreOfSpringsThanItMust) {
  for (const TriangleMesh& mesh :
       {make_sphere(3.0, 8, 8), make_icosphere(1.0, 3), make_torus(4.0, 1.5, 16, 16)}) {
    const SoftMaterial material = inflated(mesh, 100.0, 1e5);
    EXPECT_EQ(held_body(mesh, material).mesh->rest_lengths,
              balanced_body(mesh, material, {}).mesh->rest_lengths);
  }
}

TEST(HeldShape, OfFineSpheresIsBalancedToo) {
  // At the default softening a quarter of the pressure is left, and of the last a third: too much.
  for (const TriangleMesh& mesh :
       {make_icosphere(3.0, 4), make_sphere(3.0, 36, 36), make_sphere(3.0, 48, 48)}) {
    const SoftBody body = held_body(mesh, inflated(mesh, 100.0, 1e5));
    EXPECT_LT(unbalanced(body), 0.03) << mesh.vertices.size() << " vertices";
    EXPECT_TRUE(is_stable(*body.mesh, body.positions, body.material));
  }
}

TEST(HeldShape, GivesWayWhereSpringsCannotBearMore) {
  const TriangleMesh mesh = make_sphere(3.0, 36, 36);
  const SoftBody plain = make_body(mesh);
  SoftMaterial material = inflated(mesh, 100.0, 1e5);
  material.k *= 0.5 * material.n / max_held_gas(*plain.mesh, plain.positions, material);
  const double left = unbalanced(held_body(mesh, material));
  EXPECT_GT(left, 0.03);
  EXPECT_LT(left, EquilibriumOptions{}.max_residual);
}

TEST(HeldShape, TheMostGasHeldIsThatBetweenAcceptedAndRefused) {
  const TriangleMesh mesh = make_icosphere(1.0, 2);
  const SoftBody body = make_body(mesh);
  SoftMaterial material;
  const double most = max_held_gas(*body.mesh, body.positions, material);
  material.n = 0.999 * most;
  EXPECT_NO_THROW(held_mesh(*body.mesh, body.positions, material));
  material.n = 1.001 * most;
  EXPECT_THROW(held_mesh(*body.mesh, body.positions, material), EquilibriumError);
}

TEST(HeldShape, GasThatOnlyBalancesTheAirNeedsNoTension) {
  SoftBody body = make_body(make_icosphere(1.0, 2));
  body.material.ambient_pressure = 1000.0;
  body.material.n = 1000.0 * volume_of(body) / (gas_constant * body.material.temperature);
  // In proportion, what rounding leaves of the pressure.
  const auto held = held_mesh(*body.mesh, body.positions, body.material);
  for (std::size_t e = 0; e < held->rest_lengths.size(); ++e) {
    EXPECT_NEAR(held->rest_lengths[e], body.mesh->rest_lengths[e], 1e-9);
  }
}

/// Directions but rigid motions in which the energy falls, from differences of the simulation's own
/// forces.
int falling_directions(const SoftBody& body) {
  const int count = body.positions.size();
  AccelerationScratch scratch(*body.mesh);
  const SoftAcceleration acceleration(*body.mesh, body.material, Vec3::Zero(), scratch);
  const auto forces = [&](int coordinate, double shift) {
    VertexArray moved = body.positions, result(count);
    moved[coordinate / 3][coordinate % 3] += shift;
    acceleration(moved, body.velocities, result);
    return Eigen::VectorXd(result.rows().topRows<3>().reshaped());
  };
  const double h = 1e-5;  // m: truncation and rounding of the differences meet near 1e-9 of k
  Eigen::MatrixXd stiffness(3 * count, 3 * count), rigid(3 * count, 6);
  for (int c = 0; c < 3 * count; ++c) {
    stiffness.col(c) = (forces(c, -h) - forces(c, h)) / (2.0 * h);
    const Vec3 axis = Vec3::Unit(c % 3);
    for (int i = 0; i < 3; ++i) {
      rigid(c, i) = axis[i];
      rigid(c, 3 + i) = axis.dot(Vec3::Unit(i).cross(Vec3(body.positions[c / 3])));
    }
  }
  const Eigen::MatrixXd across =
      Eigen::HouseholderQR<Eigen::MatrixXd>(rigid).householderQ() *
      Eigen::MatrixXd::Identity(3 * count, 3 * count).rightCols(3 * count - 6);
  const Eigen::MatrixXd inner = across.transpose() * stiffness * across;
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                     0.5 * (inner + inner.transpose()), Eigen::EigenvaluesOnly)
                                     .eigenvalues();
  return static_cast<int>((values.array() < 0.0).count());
}

/// Its springs k, times the least that can hold it.
SoftBody barely_held(const TriangleMesh& mesh, double times) {
  const SoftBody plain = make_body(mesh);
  SoftMaterial material = inflated(mesh, 100.0, 1e6);
  material.k *= times * material.n / max_held_gas(*plain.mesh, plain.positions, material);
  material.k_max = 2.0 * material.k;
  return held_body(mesh, material);
}

TEST(HeldShape, IsStableWhereNoEigenvalueIsBelowZero) {
  const TriangleMesh slim = make_torus(6.0, 2.0, 24, 10), round = make_torus(6.0, 2.0, 16, 16);
  int folding = 0;
  for (const auto& body :
       {barely_held(slim, 1.01), barely_held(slim, 1.3), barely_held(round, 1.01),
        barely_held(round, 1.3), barely_held(make_sphere(3.0, 8, 8), 1.01)}) {
    const int falling = falling_directions(body);
    folding += falling > 0 ? 1 : 0;
    EXPECT_EQ(is_stable(*body.mesh, body.positions, body.material), falling == 0) << falling;
  }
  EXPECT_GE(folding, 1);
  EXPECT_LE(folding, 4);
}

/// The fraction by which the volume has changed 8 s after every vertex was pushed by up to 1 mm.
double change_after_a_push(SoftBody body) {
  const double start = volume_of(body);
  perturb(body, 1e-3, 1);
  body.velocities = VertexArray(body.positions.size());
  body.material.vertex_mass = 0.05;
  body.material.rho_g = 0.02;
  World world = make_free_world(std::move(body));
  world.settings.integrator = Integrator::implicit_euler;
  EXPECT_FALSE(run(world, 8.0));
  return std::abs(volume_of(world.soft[0]) / start - 1.0);
}

TEST(HeldShape, AboveItsStableStiffnessNoPushFoldsIt) {
  const TriangleMesh mesh = make_torus(6.0, 2.0, 32, 16);
  const SoftBody least = barely_held(mesh, 1.01);
  const double k = stable_stiffness(*least.mesh, least.positions, least.material);
  EXPECT_GT(k, 1.3 * least.material.k);
  EXPECT_LT(k, 2.0 * least.material.k);
  const auto held_with = [&](double stiffness) {
    SoftMaterial material = least.material;
    material.k = stiffness;
    material.k_max = 2.0 * stiffness;
    return held_body(mesh, material);
  };
  const SoftBody held = held_with(k), folding = held_with(k / 1.03);
  EXPECT_TRUE(is_stable(*held.mesh, held.positions, held.material));
  EXPECT_FALSE(is_stable(*folding.mesh, folding.positions, folding.material));
  EXPECT_LT(change_after_a_push(held), 0.01);  // what softening leaves unbalanced
  EXPECT_GT(change_after_a_push(least), 0.05);
}

}  // namespace
}  // namespace pneuma::sim
