// What an implicit step minimises, with every term of it at work.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/soft/minimise_energy.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {

/// A step's energy with every term in it, at a crumpled body of which some springs are stretched
/// and some pressed, with vertices that friction holds, and others that slide.
struct MinimiserCase {
  SoftBody body;
  IncrementalPotential energy;
  EnergyPoint point;

  explicit MinimiserCase(const TriangleMesh& mesh, double noise = 0.3)
      : body(make_body(mesh)), energy(*body.mesh), point(*body.mesh) {
    perturb(body, noise, 1);
    point.positions.rows() = body.positions.rows();
    energy.inertia = 200.0;
    energy.target.rows() = body.mesh->rest_positions.rows();
    energy.stiffness = 300.0;
    energy.rest_lengths = body.mesh->rest_lengths;
    energy.gas.strength = 5000.0;
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

inline TriangleMesh ball() { return make_sphere(3.0, 5, 6); }

}  // namespace pneuma::sim
