// The fast loops over springs and rings beside the plain ones, on rings of three to nine vertices.
#include <gtest/gtest.h>

#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/ring_forces.h"
#include "sim/soft/spring_force.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Numbers of edges that are and are not multiples of four: 6, 9, 15, 168, 120, 768, 27.
std::vector<SoftBody> shapes() {
  const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  std::vector<SoftBody> result;
  for (const TriangleMesh& mesh :
       {tetrahedron, make_sphere(1.0, 2, 3), make_sphere(2.0, 2, 5), make_sphere(3.0, 8, 8),
        make_icosphere(3.0, 1), make_torus(6.0, 2.0, 16, 16), make_sphere(2.0, 2, 9)}) {
    // Far from the origin, where differences of positions are all that has digits.
    result.push_back(make_body(mesh, {30.0, -20.0, 10.0}));
    perturb(result.back(), 0.05, static_cast<unsigned>(result.size()));
  }
  return result;
}

std::vector<double> coefficients(const SoftBody& body, double dashpot) {
  std::vector<double> result(body.mesh->rest_lengths.size());
  spring_coefficients(*body.mesh, body.positions, body.velocities, body.material.k, dashpot,
                      result);
  return result;
}

TEST(ForceKernels, SpringCoefficientsAreThoseOfSingleSprings) {
  for (const SoftBody& body : shapes()) {
    for (const double dashpot : {0.0, dashpot_constant(body.material)}) {
      const std::vector<double> fast = coefficients(body, dashpot);
      for (std::size_t e = 0; e < fast.size(); ++e) {
        const auto& [a, b] = body.mesh->topology.edges()[e];
        const double plain = spring_coefficient(
            body.positions[b] - body.positions[a], body.velocities[b] - body.velocities[a],
            body.mesh->rest_lengths[e], body.material.k, dashpot);
        // A dozen roundings of 1e-16 each, of terms that may cancel: k is their size.
        EXPECT_NEAR(fast[e], plain, 1e-14 * body.material.k);
      }
    }
  }
}

TEST(ForceKernels, SpringsAtRestPullAtNothingToTheLastBit) {
  for (SoftBody body : shapes()) {
    body.positions = body.mesh->rest_positions;
    body.velocities.rows().setZero();
    for (const double s : coefficients(body, 0.5)) EXPECT_EQ(s, 0.0);
  }
}

TEST(ForceKernels, RingsGatherTheSpringsAndTheVolumeGradient) {
  for (const SoftBody& body : shapes()) {
    const MeshTopology& topology = body.mesh->topology;
    const std::vector<double> s = coefficients(body, 0.5);
    RingForces forces(topology.vertex_count());
    const double fast_volume = gather_rings(body.mesh->tables, body.positions, s, forces);

    VertexArray springs(topology.vertex_count()), gradient(topology.vertex_count());
    for (std::size_t e = 0; e < s.size(); ++e) {
      const auto& [a, b] = topology.edges()[e];
      const Vec3 pull = s[e] * (body.positions[b] - body.positions[a]);
      springs[a] += pull;
      springs[b] -= pull;
    }
    volume_gradient(topology, body.positions, gradient);
    // The same few terms of a vertex in another order, some dozen roundings of 1e-16.
    const double spring_scale = springs.rows().colwise().norm().maxCoeff();
    const double gradient_scale = gradient.rows().colwise().norm().maxCoeff();
    for (int v = 0; v < topology.vertex_count(); ++v) {
      const Vec3 fast_springs = forces.rows()[RingForces::springs(v)];
      const Vec3 fast_gradient = forces.rows()[RingForces::six_volume_gradients(v)] / 6.0;
      EXPECT_LT((fast_springs - springs[v]).norm(), 1e-13 * spring_scale);
      EXPECT_LT((fast_gradient - gradient[v]).norm(), 1e-14 * gradient_scale);
    }
    EXPECT_EQ(forces.rows().rows().row(3).norm(), 0.0) << "the layout's fourth row stays zero";
    // Signed tetrahedra about another point: some hundred terms of the volume's size.
    const double plain_volume = volume(topology, body.positions);
    EXPECT_NEAR(fast_volume, plain_volume, 1e-13 * plain_volume);
  }
}

}  // namespace
}  // namespace pneuma::sim
