#include "sim/equilibrium/equilibrium.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "sim/inspect/inspect.h"
#include "tests/sim/equilibrium/balanced_body.h"
#include "tests/support/plain_ply.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

TriangleMesh read_cat(const std::string& name) { return parse_plain_ply(read_asset(name)); }

TEST(Equilibrium, BalancesThePressureUpToRounding) {
  // The stiffness of the cat's softest motion is 3e-7 of k, which costs seven of sixteen digits.
  for (const TriangleMesh& mesh : {make_sphere(3.0, 8, 8), make_icosphere(1.0, 3),
                                   make_torus(4.0, 1.5, 16, 16), read_cat("cat_500.ply")}) {
    const SoftBody body = balanced_body(mesh, inflated(mesh, 100.0, 1e5), exact_equilibrium);
    EXPECT_LT(unbalanced(body), 1e-9) << mesh.vertices.size() << " vertices";
  }
}

TEST(Equilibrium, TensionsObeyTheVirial) {
  // The balance at each vertex times its position, summed over all: sum t l = 3 P V, by Euler's
  // theorem for V, whatever the shape. Tolerance as above.
  const double pressure = 100.0, k = 1e5;
  for (const TriangleMesh& mesh :
       {make_icosphere(1.0, 3), make_torus(4.0, 1.5, 16, 16), read_cat("cat_500.ply")}) {
    const SoftBody body = balanced_body(mesh, inflated(mesh, pressure, k), exact_equilibrium);
    const MeshTopology& topology = body.mesh->topology;
    double sum = 0.0;
    for (int e = 0; e < topology.edge_count(); ++e) {
      const auto& [a, b] = topology.edges()[at(e)];
      const double length = (body.positions[b] - body.positions[a]).norm();
      sum += k * (length - body.mesh->rest_lengths[at(e)]) * length;
    }
    const double expected = 3.0 * pressure * volume(topology, body.positions);
    EXPECT_NEAR(sum / expected, 1.0, 1e-9) << mesh.vertices.size() << " vertices";
  }
}

TEST(Equilibrium, OfAnIcosahedronIsTheSameForAllEdges) {
  // 30 edges of the length a and the volume 5 (3 + sqrt 5) a^3 / 12: t = 3 P V / (30 a).
  const double pressure = 50.0, k = 1e4;
  const TriangleMesh mesh = make_icosphere(2.0, 0);
  const SoftBody body = balanced_body(mesh, inflated(mesh, pressure, k), exact_equilibrium);
  const double a = 2.0 / std::sin(0.4 * std::numbers::pi);
  const double tension = pressure * 5.0 * (3.0 + std::sqrt(5.0)) * a * a / 120.0;
  for (const double rest : body.mesh->rest_lengths) EXPECT_NEAR(rest, a - tension / k, 1e-9);
}

TEST(Equilibrium, ABodyLeftAloneDoesNotMove) {
  for (const TriangleMesh& mesh :
       {make_sphere(3.0, 8, 8), make_icosphere(1.0, 2), make_torus(4.0, 1.5, 16, 16)}) {
    World world =
        make_free_world(balanced_body(mesh, inflated(mesh, 20.0, 300.0), exact_equilibrium));
    const VertexArray before = world.soft[0].positions;
    ASSERT_FALSE(run(world, 5.0));
    // Forces of 1e-9 of the pressure's, for seconds, on a body of some metres.
    EXPECT_LT((world.soft[0].positions.rows() - before.rows()).norm(), 1e-7)
        << mesh.vertices.size() << " vertices";
  }
}

TEST(Equilibrium, WithoutItTheSameBodySwells) {
  const TriangleMesh mesh = make_icosphere(1.0, 2);
  SoftBody body = make_body(mesh);
  body.material = inflated(mesh, 20.0, 300.0);
  World world = make_free_world(std::move(body));
  const double before = volume(world.soft[0].mesh->topology, world.soft[0].positions);
  ASSERT_FALSE(run(world, 5.0));
  EXPECT_GT(volume(world.soft[0].mesh->topology, world.soft[0].positions), 1.02 * before);
}

TEST(Equilibrium, OfNoGasIsTheShapeItself) {
  SoftMaterial material;
  material.n = 0.0;
  const SoftBody plain = make_body(make_sphere(3.0, 8, 8));
  const Equilibrium found = find_equilibrium(plain.mesh->topology, plain.positions, material);
  EXPECT_EQ(found.rest_lengths, plain.mesh->rest_lengths);
  EXPECT_EQ(found.residual, 0.0);
}

/// What find_equilibrium says against it.
std::string refusal(const TriangleMesh& mesh, const SoftMaterial& material,
                    const EquilibriumOptions& options = exact_equilibrium) {
  try {
    balanced_body(mesh, material, options);
  } catch (const EquilibriumError& error) {
    return error.what();
  }
  return "accepted";
}

/// The number that follows `name` in a text.
double number_after(const std::string& text, const std::string& name) {
  return std::stod(text.substr(text.find(name) + name.size()));
}

TEST(Equilibrium, ItsRefusalNamesWhatCanBeHeld) {
  for (const TriangleMesh& mesh : {make_sphere(2.0, 8, 8), make_torus(4.0, 1.5, 16, 16)}) {
    SoftMaterial material;
    const std::string message = refusal(mesh, material, {});
    SoftMaterial less = material, stiffer = material;
    less.n = number_after(message, "at most n = ");
    stiffer.k = number_after(message, "at least k = ");
    EXPECT_EQ(refusal(mesh, less, {}), "accepted") << message;
    EXPECT_EQ(refusal(mesh, stiffer, {}), "accepted") << message;
    less.n *= 1.011;  // a unit of the third digit more
    stiffer.k /= 1.011;
    EXPECT_NE(refusal(mesh, less, {}), "accepted") << message;
    EXPECT_NE(refusal(mesh, stiffer, {}), "accepted") << message;
  }
}

TEST(Equilibrium, RefusesWhatHasNone) {
  const TriangleMesh sphere = make_sphere(3.0, 8, 8);
  SoftMaterial material = inflated(sphere, 100.0, 1.0);
  EXPECT_NE(refusal(sphere, material).find("more than the springs can hold"), std::string::npos)
      << refusal(sphere, material);
  material.k = 0.0;
  EXPECT_NE(refusal(sphere, material).find("k = 0"), std::string::npos);

  // All of a box's faces are flat: inside them nothing balances the gas.
  const TriangleMesh box = make_box({1.0, 1.0, 1.0}, 4);
  EXPECT_NE(refusal(box, inflated(box, 100.0, 1e6)).find("unbalanced"), std::string::npos)
      << refusal(box, inflated(box, 100.0, 1e6));

  TriangleMesh inside_out = sphere;
  for (Triangle& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_NE(refusal(inside_out, inflated(sphere, 100.0, 1e4)).find("volume"), std::string::npos);

  const TriangleMesh cat = read_cat("cat_500.ply");
  material = inflated(cat, 100.0, 1e5);
  material.pressure_weighting = PressureWeighting::valence;
  EXPECT_NE(refusal(cat, material).find("net force"), std::string::npos) << refusal(cat, material);
}

TEST(Equilibrium, OtherRestLengthsMustFit) {
  const auto mesh = make_soft_mesh(make_sphere(3.0, 8, 8));
  std::vector<double> lengths(168, 0.5);
  EXPECT_EQ(make_soft_mesh(*mesh, lengths)->rest_lengths, lengths);
  lengths[7] = -0.1;
  EXPECT_THROW(make_soft_mesh(*mesh, lengths), std::invalid_argument);
  lengths[7] = std::nan("");
  EXPECT_THROW(make_soft_mesh(*mesh, lengths), std::invalid_argument);
  lengths.pop_back();
  EXPECT_THROW(make_soft_mesh(*mesh, lengths), std::invalid_argument);
}

/// How far a body is from its rest shape, apart from having moved as a whole.
struct Departure {
  double greatest;  // of a vertex, as a share of the rest shape's height
  double lean;      // of the body's z axis from the vertical, degrees
  double kinetic;   // J
  double crept;     // of the mean, m
};

/// The turn that takes the columns of `from` nearest to those of `to`, both about their means
/// (Kabsch 1976).
Mat3 best_turn(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::JacobiSVD<Mat3> svd(to * from.transpose(),
                                   Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Departure departure(const World& world, const VertexArray& rest) {
  const VertexArray& now = world.soft[0].positions;
  const Eigen::Matrix3Xd from = rest.rows().topRows<3>().colwise() - mean(rest);
  const Eigen::Matrix3Xd to = now.rows().topRows<3>().colwise() - mean(now);
  const Mat3 turn = best_turn(from, to);
  return {(turn * from - to).colwise().norm().maxCoeff() / bounds(rest).size().z(),
          std::acos(std::min(1.0, turn(2, 2))) * 180.0 / std::numbers::pi, energy(world).kinetic,
          (mean(now) - mean(rest)).norm()};
}

/// The cat of 1 kg on the ground, inflated to `pressure` in Pa.
World standing_cat(const std::string& file, double pressure, int steps_per_second) {
  const TriangleMesh mesh = read_cat(file);
  SoftMaterial material = inflated(mesh, pressure, 1000.0);
  material.vertex_mass = 1.0 / static_cast<double>(mesh.vertices.size());
  material.rho_g = 0.05;
  material.surface = {0.0, 1.0};
  World world = make_free_world(balanced_body(mesh, material, {}));
  VertexArray& positions = world.soft[0].positions;
  positions.rows().row(2).array() -= bounds(positions).low.z();
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.settings.ground = ContactMaterial{0.0, 1.0};
  world.settings.steps_per_second = steps_per_second;
  return world;
}

void expect_to_stand(World world, double seconds) {
  const VertexArray rest = world.soft[0].positions;
  ASSERT_FALSE(run(world, seconds));
  const Departure found = departure(world, rest);
  // The goal is 5 % of the height (of the Hausdorff distance, which is at most this).
  EXPECT_LT(found.greatest, 0.03);
  EXPECT_LT(found.lean, 2.0);
  EXPECT_LT(found.crept, 0.05);
  // At 1 kg, a millijoule is 4 cm/s of every vertex: what is left of the sway after setting down.
  EXPECT_LT(found.kinetic, 1e-3);
}

TEST(StandingCat, StandsOnTheGround) {
  expect_to_stand(standing_cat("cat_500.ply", 100.0, 720), 2.5);
}

TEST(StandingCat, StandsWithMoreVerticesToo) {
  expect_to_stand(standing_cat("cat_2000.ply", 100.0, 1440), 1.5);
}

TEST(StandingCat, FallsWithoutGas) {
  World world = standing_cat("cat_500.ply", 0.0, 720);
  const double before = bounds(world.soft[0].positions).size().z();
  ASSERT_FALSE(run(world, 4.0));
  EXPECT_LT(bounds(world.soft[0].positions).size().z(), 0.7 * before);
}

TEST(StandingCat, TensionsKeepItNearerToItsShape) {
  // In free space, so that only the gas acts: with the springs at rest in the shape it swells.
  const auto alone = [](bool tuned) {
    World world = standing_cat("cat_500.ply", 100.0, 720);
    world.settings.gravity.setZero();
    world.settings.ground.reset();
    if (!tuned) world.soft[0].mesh = make_soft_mesh(read_cat("cat_500.ply"));
    const VertexArray rest = world.soft[0].positions;
    EXPECT_FALSE(run(world, 3.0));
    return departure(world, rest).greatest;
  };
  EXPECT_LT(alone(true), 0.9 * alone(false));
}

}  // namespace
}  // namespace pneuma::sim
