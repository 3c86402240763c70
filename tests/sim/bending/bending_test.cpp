// The hinges of a surface: their energy against closed forms, their derivatives against differences
// of it.
#include "sim/soft/bending.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/rotation.h"
#include "sim/soft/incremental_potential.h"
#include "tests/sim/bending/bent_body.h"

namespace pneuma::sim {
namespace {

SoftBody bent(const TriangleMesh& mesh, double amount) { return bent(mesh, amount, 5); }

/// Four triangles: the vertices across each edge are joined by an edge themselves.
TriangleMesh tetrahedron() {
  return {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.2, 1.1, 0.0}, {0.3, 0.2, 0.9}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

std::vector<SoftBody> bent_bodies() {
  return {bent(tetrahedron(), 0.1), bent(make_box({2.0, 1.0, 0.5}, 2), 0.1),
          bent(make_icosphere(1.0, 1), 0.15), bent(make_torus(2.0, 0.7, 7, 6), 0.1)};
}

VertexArray forces(const SoftBody& body) {
  VertexArray result(body.positions.size());
  add_bending_forces(*body.mesh->hinges, body.positions, rigidity, 1, result);
  return result;
}

/// At positions with one coordinate moved.
template <class Value>
auto moved(SoftBody body, int v, int axis, double by, const Value& value) {
  body.positions[v][axis] += by;
  return value(body);
}

TEST(Bending, NothingBendsAShapeAtRestWhereverItIsAndWhateverItsSize) {
  SoftBody body = bent(make_box({2.0, 1.0, 0.5}, 2), 0.0);
  const auto energy = [&] { return bending_energy(*body.mesh, body.positions, rigidity); };
  // Angles to rounding, squared.
  EXPECT_LT(energy(), 1e-12);
  const Mat3 rotation = rotation_of_degrees({20.0, 70.0, -40.0}).toRotationMatrix();
  for (int v = 0; v < body.positions.size(); ++v) {
    body.positions[v] = 3.0 * rotation * Vec3(body.positions[v]);
  }
  EXPECT_LT(energy(), 1e-12);
}

/// Of a single hinge each, which is never taken together with others.
std::vector<HingeTable> one_by_one(const HingeTable& all) {
  std::vector<HingeTable> hinges;
  for (std::size_t e = 0; e < all.corners.size(); ++e) {
    hinges.push_back({{all.corners[e]}, {all.weights[e]}, {all.rest[e]}, {all.areas[e]}});
  }
  return hinges;
}

TEST(Bending, HingesTakenFourAtATimeAreTheSameToTheLastBit) {
  for (SoftBody body : bent_bodies()) {
    // The second time triangles are crushed, so that some cannot be taken together.
    for (const double squeezed : {1.0, 0.5}) {
      body.positions.rows().row(0) *= squeezed;
      double energy = 0.0;
      VertexArray force(body.positions.size());
      for (const HingeTable& hinge : one_by_one(*body.mesh->hinges)) {
        energy += bending_energy(hinge, body.positions, 1.0);
        add_bending_forces(hinge, body.positions, rigidity, 1, force);
      }
      EXPECT_EQ(bending_energy(*body.mesh->hinges, body.positions, 1.0), energy);
      EXPECT_EQ(forces(body).rows(), force.rows());
    }
  }
}

void expect_forces_to_be_the_slope_of_the_energy(const SoftBody& body) {
  const double h = 1e-6;  // truncation h^2 E''' and rounding 1e-16 E / h are near 1e-9 of a force
  const VertexArray force = forces(body);
  ASSERT_GT(force.rows().norm(), 1.0);
  const auto energy = [](const SoftBody& b) {
    return bending_energy(*b.mesh, b.positions, rigidity);
  };
  for (int v = 0; v < force.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const double slope =
          (moved(body, v, axis, h, energy) - moved(body, v, axis, -h, energy)) / (2.0 * h);
      EXPECT_NEAR(-slope, force[v][axis], 1e-6 * force.rows().norm());
    }
  }
}

TEST(Bending, ForcesAreTheSlopeOfTheEnergy) {
  for (const SoftBody& body : bent_bodies()) expect_forces_to_be_the_slope_of_the_energy(body);
}

TEST(Bending, ForcesPushAndTurnNothingAsAWhole) {
  for (const SoftBody& body : bent_bodies()) {
    expect_to_push_and_turn_nothing_as_a_whole(forces(body), body);
  }
}

/// Bodies of which some triangles have lost most of their area or are turned over.
std::vector<SoftBody> crushed_bodies() {
  std::vector<SoftBody> bodies = bent_bodies();
  for (SoftBody& body : bodies) {
    for (int v = 0; v < body.positions.size(); ++v) body.positions[v].x() *= 0.2;
  }
  return bodies;
}

TEST(Bending, ForcesOfCrushedBodiesAreTheSlopeOfTheEnergy) {
  for (const SoftBody& body : crushed_bodies()) {
    expect_forces_to_be_the_slope_of_the_energy(body);
    expect_to_push_and_turn_nothing_as_a_whole(forces(body), body);
  }
}

/// As the apex of one triangle goes through the edge: energy and forces change evenly, and nothing
/// is stiffer than (15/8 / 0.8)^2 times what the hinge is at rest.
TEST(Bending, ATriangleTurnsOverWithoutAJump) {
  const double weight = 1.5, stiffness = rigidity * weight;  // K / height^2, of a height of 1 m
  const double bound = std::pow(15.0 / 8.0 / 0.8, 2) * stiffness;
  for (const HingeAngle& rest : {HingeAngle{1.0, 0.0}, HingeAngle{0.6, 0.8}}) {
    const HingeTable hinges{{{0, 1, 2, 3}}, {weight}, {rest}, {{0.5, 0.5}}};
    VertexArray x(4), last(4);
    x[1] = Vec3(1.0, 0.0, 0.0);
    x[3] = Vec3(0.6, -1.0, 0.0);
    double last_energy = 0.0;
    const double step = 1e-4;
    for (double height = 1.2; height > -1.2; height -= step) {
      x[2] = Vec3(0.4, height, 1e-7);
      VertexArray force(4);
      add_bending_forces(hinges, x, rigidity, 1, force);
      const double energy = bending_energy(hinges, x, rigidity);
      if (height < 1.2) {
        EXPECT_LT(std::abs(energy - last_energy), 2.5 * stiffness * step) << height;
        EXPECT_LT((force.rows().col(2) - last.rows().col(2)).norm(), 1.01 * bound * step) << height;
      }
      last.rows() = force.rows();
      last_energy = energy;
    }
  }
}

TEST(Bending, HessianIsTheSlopeOfTheForces) {
  const double h = 1e-6;
  std::vector<SoftBody> bodies = bent_bodies();
  for (SoftBody& body : crushed_bodies()) bodies.push_back(std::move(body));
  for (const SoftBody& body : bodies) {
    const MeshTopology& topology = body.mesh->topology;
    IncrementalPotential energy(*body.mesh);
    energy.rest_lengths = body.mesh->rest_lengths;
    energy.bending = rigidity;
    EnergyPoint point(*body.mesh);
    point.positions = body.positions;
    ASSERT_TRUE(evaluate(*body.mesh, energy, point));
    VertexMatrix matrix(topology, body.mesh->hinges.get());
    hessian_without_rank_one(*body.mesh, energy, point, opposite_vertices(topology), matrix);
    for (int v = 0; v < body.positions.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        VertexArray unit(body.positions.size()), column(body.positions.size());
        unit[v][axis] = 1.0;
        matrix.multiply(unit, column);
        const auto rows = [&](const SoftBody& b) { return VertexArray::Rows(forces(b).rows()); };
        const VertexArray::Rows slope =
            (moved(body, v, axis, h, rows) - moved(body, v, axis, -h, rows)) / (2.0 * h);
        // Of forces of some 1e2 N, rounding 1e-14 / h, and truncation.
        EXPECT_LT((slope + column.rows()).norm(), 1e-6 * column.rows().norm() + 1e-5);
      }
    }
    for (int axis = 0; axis < 3; ++axis) matrix.fix(1, axis);
    VertexArray unit(body.positions.size()), column(body.positions.size());
    unit[1] = Vec3(1.0, 2.0, 3.0);
    matrix.multiply(unit, column);
    EXPECT_EQ(column.rows(), unit.rows());
  }
}

TEST(Bending, AtTheRestAngleTheHessianIsTheSquareOfItsRoot) {
  const SoftBody body = bent(make_icosphere(1.0, 1), 0.0);
  for (int e = 0; e < body.mesh->topology.edge_count(); ++e) {
    const auto root = hinge_stiffness_root(*body.mesh->hinges, body.positions, rigidity, e);
    const HingeHessian whole = hinge_hessian(*body.mesh->hinges, body.positions, rigidity, e);
    EXPECT_LT((whole - root * root.transpose()).norm(), 1e-12 * whole.norm());
  }
}

/// A sheet that is flat at rest, rolled up to a torus of the radii R and r: half the rigidity times
/// the integral of the squared sum of its curvatures, of which Willmore's energy is a quarter, pi^2
/// (R/r)^2 / sqrt((R/r)^2 - 1). By Gauss and Bonnet the product of the curvatures adds nothing.
TEST(Bending, OfASheetRolledUpToATorusIsThatOfAPlate) {
  const double ratio = 3.0;
  const double expected =
      2.0 * rigidity * std::pow(std::numbers::pi * ratio, 2) / std::sqrt(ratio * ratio - 1.0);
  double last_error = 1.0;
  for (const int slices : {16, 32}) {
    SoftBody body = bent(make_torus(ratio, 1.0, 3 * slices, slices), 0.0);
    HingeTable flat = *body.mesh->hinges;
    std::ranges::fill(flat.rest, HingeAngle{});
    SoftMesh mesh = *body.mesh;
    mesh.hinges = std::make_shared<const HingeTable>(std::move(flat));
    const double error = std::abs(bending_energy(mesh, body.positions, rigidity) / expected - 1.0);
    // Second order: angles of 2 pi / slices.
    EXPECT_LT(error, 10.0 / (slices * slices));
    EXPECT_LT(error, 0.5 * last_error);
    last_error = error;
  }
}

TEST(Bending, ATriangleWithoutHeightIsSoft) {
  // A vertex on a face of a box, near one of its edges: slivers.
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.push_back({0.5, 1e-6, 0.0});
  mesh.triangles[0] = {0, 2, 4};
  mesh.triangles.push_back({4, 2, 1});
  mesh.triangles.push_back({0, 4, 1});
  const SoftBody body = bent(mesh, 0.0);
  for (int e = 0; e < body.mesh->topology.edge_count(); ++e) {
    const auto root = hinge_stiffness_root(*body.mesh->hinges, body.positions, rigidity, e);
    EXPECT_LT(root.squaredNorm(), 1e4 * rigidity);  // 1/m^2: unsoftened some 1e18
  }
}

}  // namespace
}  // namespace pneuma::sim
