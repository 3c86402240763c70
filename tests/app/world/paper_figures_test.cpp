// What the paper's figures show, by number, at the end of their scenes.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "app/files/find_scene.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/step/stepper.h"
#include "sim/swept/closest_points.h"

namespace pneuma::app {
namespace {

using sim::SoftBody;
using sim::Vec3;
using sim::World;

/// `after_step(world, stepper)`.
template <class Visit>
World run_scene(const std::string& name, const Visit& after_step) {
  const scenes::Scene scene = scenes::load_scene(find_scene(name));
  World world = build_world(scene);
  sim::Stepper stepper(world);
  const std::int64_t steps = scenes::frame_count(scene) * scene.settings.steps_per_second /
                             scene.picture.frames_per_second;
  while (world.steps < steps) {
    EXPECT_FALSE(stepper.step(world));
    after_step(world, stepper);
  }
  return world;
}

World world_at_end(const std::string& name) {
  return run_scene(name, [](const World&, const sim::Stepper&) {});
}

const SoftBody& body(const World& world, std::string_view name) {
  return *std::ranges::find(world.soft, name, &SoftBody::name);
}

Vec3 middle(const SoftBody& body) {
  Vec3 sum = Vec3::Zero();
  for (int v = 0; v < body.positions.size(); ++v) sum += body.positions[v];
  return sum / body.positions.size();
}

/// Distance from the axis of a torus, which is upright in these scenes.
double from_axis(const Vec3& place) { return place.head<2>().norm(); }

double outer_radius(const SoftBody& torus) {
  const sim::Bounds bounds = sim::bounds(torus.positions);
  return 0.5 * (bounds.high.x() - bounds.low.x());
}

/// Nearer to the axis than the middle of the tube, and lower than the top of it.
void expect_in_hole(const Vec3& place, const SoftBody& torus, const std::string& name) {
  EXPECT_LT(from_axis(place - middle(torus)), 0.75 * outer_radius(torus)) << name;
  EXPECT_LT(place.z(), sim::bounds(torus.positions).high.z() + 1.5) << name;
}

TEST(PaperFigures, In64TheFirmSphereIsRoundAndTheSoftOneSags) {
  const auto height_over_width = [](const std::string& scene) {
    const Vec3 size = sim::bounds(world_at_end(scene).soft.front().positions).size();
    return size.z() / std::max(size.x(), size.y());
  };
  // Of the paper's pictures, as measured in them to about 0.05.
  EXPECT_NEAR(height_over_width("pressure_firm"), 1.0, 0.05);
  EXPECT_NEAR(height_over_width("pressure_soft"), 0.83, 0.05);
}

TEST(PaperFigures, In65BottomLeftTwoSpheresAndTheCubesAreInTheHole) {
  const World world = world_at_end("torus_three_spheres_four_cubes");
  const SoftBody& torus = body(world, "torus");
  ASSERT_EQ(world.rigid.size(), 4u);
  for (const sim::RigidBox& cube : world.rigid) expect_in_hole(cube.position, torus, cube.name);
  for (const char* sphere : {"left", "right"}) {
    expect_in_hole(middle(body(world, sphere)), torus, sphere);
  }
  EXPECT_GT(from_axis(middle(body(world, "outside")) - middle(torus)), outer_radius(torus));
}

TEST(PaperFigures, WhatIsDroppedIntoATorusIsInItsHole) {
  const World spheres = world_at_end("sphere_in_torus");
  expect_in_hole(middle(body(spheres, "sphere")), body(spheres, "torus"), "sphere");
  const World cubes = world_at_end("torus_four_cubes");
  ASSERT_EQ(cubes.rigid.size(), 4u);
  for (const sim::RigidBox& cube : cubes.rigid) {
    expect_in_hole(cube.position, body(cubes, "torus"), cube.name);
  }
}

/// How far the middles of a torus's 16 sections are from the plane nearest to them, root mean
/// square, over its radius: 0 if it is only turned.
double bend(const SoftBody& torus) {
  constexpr int sections = 16, vertices = 16;
  Eigen::Matrix<double, 3, sections> middles;
  for (int i = 0; i < sections; ++i) {
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < vertices; ++v) sum += torus.positions[i * vertices + v];
    middles.col(i) = sum / vertices;
  }
  middles.colwise() -= middles.rowwise().mean().eval();
  const sim::Mat3 covariance = middles * middles.transpose() / sections;
  const Eigen::SelfAdjointEigenSolver<sim::Mat3> axes(covariance);
  // Of a circle the other two are half its squared radius each.
  return std::sqrt(axes.eigenvalues()(0) / axes.eigenvalues().tail<2>().sum());
}

TEST(PaperFigures, In65TopRightTheTorusIsBentByTheSpheresItLiesOn) {
  double most = 0.0;
  const World world = run_scene("torus_three_spheres", [&](const World& now, const sim::Stepper&) {
    most = std::max(most, bend(body(now, "torus")));
  });
  EXPECT_GT(most, 0.1);
  EXPECT_GT(bend(body(world, "torus")), 0.02);
  EXPECT_LT(bend(body(world_at_end("one_torus"), "torus")), 0.01) << "on the ground it is flat";
}

/// Of the upper half of a ball: how much nearer its nearest vertex is to its middle than all are on
/// average.
double dent(const SoftBody& ball) {
  const Vec3 centre = middle(ball);
  double nearest = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int v = 0; v < ball.positions.size(); ++v) {
    const Vec3 arm = ball.positions[v] - centre;
    sum += arm.norm();
    if (arm.z() > 0.0) nearest = std::min(nearest, arm.norm());
  }
  return 1.0 - nearest * ball.positions.size() / sum;
}

TEST(PaperFigures, In65BottomRightTheCatDentsTheSphereAndSlidesOffIt) {
  double deepest = 0.0;
  const World world = run_scene("cat_on_sphere", [&](const World& now, const sim::Stepper&) {
    deepest = std::max(deepest, dent(body(now, "sphere")));
  });
  const SoftBody& cat = body(world, "cat");
  const SoftBody& sphere = body(world, "sphere");
  EXPECT_GT(deepest, 0.3);
  EXPECT_LT(dent(sphere), 0.1);
  EXPECT_LT(sim::bounds(cat.positions).low.z(), 0.01) << "it is on the ground";
  EXPECT_GT(from_axis(middle(cat) - middle(sphere)), outer_radius(sphere)) << "and beside it";
}

struct Surface {
  sim::TriangleMesh mesh;
  double size = 0.0;  // m, the diagonal of its bounds
};

Surface surface_of(const World& world, const sim::ContactSide& side) {
  Surface surface;
  if (side.kind == sim::SideKind::soft) {
    const SoftBody& soft = world.soft[sim::at(side.body)];
    surface.mesh.triangles = soft.mesh->topology.triangles();
    for (int v = 0; v < soft.positions.size(); ++v) {
      surface.mesh.vertices.push_back(soft.positions[v]);
    }
  } else {
    const sim::RigidBox& box = world.rigid[sim::at(side.body)];
    surface.mesh = sim::make_box(box.size, 1);
    for (Vec3& vertex : surface.mesh.vertices) vertex = box.position + box.orientation * vertex;
  }
  sim::Bounds bounds;
  for (const Vec3& vertex : surface.mesh.vertices) bounds.include(vertex);
  surface.size = bounds.size().norm();
  return surface;
}

/// Whether any vertex of one is nearer to a triangle of the other, or any edge to an edge.
bool are_nearer(const sim::TriangleMesh& one, const sim::TriangleMesh& other, double distance) {
  for (const sim::Triangle& t : other.triangles) {
    const sim::Corners corners = {other.vertices[sim::at(t[0])], other.vertices[sim::at(t[1])],
                                  other.vertices[sim::at(t[2])]};
    for (const Vec3& vertex : one.vertices) {
      if (sim::closest_vertex_triangle(vertex, corners, distance)) return true;
    }
    for (const sim::Triangle& u : one.triangles) {
      for (std::size_t i = 0; i < 9; ++i) {
        const sim::Segment edge = {corners[i % 3], corners[(i + 1) % 3]};
        const sim::Segment side = {one.vertices[sim::at(u[i / 3])],
                                   one.vertices[sim::at(u[(i / 3 + 1) % 3])]};
        if (sim::closest_edge_edge(side, edge, distance)) return true;
      }
    }
  }
  return false;
}

class PaperFigure : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, PaperFigure,
                         testing::Values("two_spheres_contact", "three_spheres_contact",
                                         "sphere_in_torus", "torus_four_cubes",
                                         "torus_three_spheres", "torus_three_spheres_four_cubes",
                                         "cat_on_sphere"));

/// What presses on each other is nearer than a hundredth of the smaller body.
TEST_P(PaperFigure, NoGapShowsBetweenWhatTouches) {
  int touched = 0;
  run_scene(GetParam(), [&](const World& now, const sim::Stepper& stepper) {
    if (now.steps % now.settings.steps_per_second != 0) return;
    for (const sim::Contact& contact : stepper.contacts()) {
      if (contact.second.kind == sim::SideKind::ground) continue;
      const Surface first = surface_of(now, contact.first),
                    second = surface_of(now, contact.second);
      const double gap = 0.01 * std::min(first.size, second.size);
      EXPECT_TRUE(are_nearer(first.mesh, second.mesh, gap) ||
                  are_nearer(second.mesh, first.mesh, gap))
          << sim::time(now);
      ++touched;
    }
  });
  EXPECT_GT(touched, 0);
}

}  // namespace
}  // namespace pneuma::app
