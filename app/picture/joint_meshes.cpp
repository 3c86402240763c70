#include "app/picture/joint_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/picture/tube.h"
#include "sim/joints/body_springs.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using render::Colour;
using render::Vec3f;

constexpr int tube_sides = 8;  // of a tube
constexpr int rings_per_turn = 16;
constexpr int rings_of_pipe = 2;
constexpr int turns_of_spring = 9;
constexpr float straight = 0.12f;  // of a spring's length, at either end
// Of the length that it has at the start.
constexpr double wire_of_length = 0.018;
constexpr double coil_of_length = 0.075;
// Of the smaller body's extent.
constexpr double pipe_of_size = 0.045;
/// A shorter spring is as wide as one of this length: of one whose ends touch at the start nothing
/// would be seen.
constexpr double least_length_of_size = 0.35;

const Colour steel(0.55f, 0.57f, 0.60f);
const Colour brass(0.72f, 0.58f, 0.30f);

int ring_count(int turns) { return turns > 0 ? turns * rings_per_turn + 1 : rings_of_pipe; }

/// Rings of vertices one after the other, closed at both ends.
std::shared_ptr<const render::MeshShape> tube_shape(int rings, const Colour& colour) {
  auto shape = std::make_shared<render::MeshShape>();
  const auto vertex = [](int ring, int side) {
    return static_cast<std::uint32_t>(ring * tube_sides + side % tube_sides);
  };
  add_tube(0, rings, tube_sides, *shape);
  for (int side = 1; side + 1 < tube_sides; ++side) {
    shape->triangles.push_back({vertex(0, 0), vertex(0, side + 1), vertex(0, side)});
    shape->triangles.push_back(
        {vertex(rings - 1, 0), vertex(rings - 1, side), vertex(rings - 1, side + 1)});
  }
  shape->colours.assign(static_cast<std::size_t>(rings * tube_sides), colour);
  return shape;
}

/// The vertex of each of two bodies that is nearest to the middle of the other.
std::pair<sim::SpringEnd, sim::SpringEnd> nearest_ends(const sim::World& world,
                                                       const sim::Valve& valve) {
  const auto end = [&](int body, int other) {
    const sim::VertexArray& positions = world.soft[sim::at(body)].positions;
    const sim::Vec3 middle = sim::mean(world.soft[sim::at(other)].positions);
    int nearest = 0;
    for (int v = 1; v < positions.size(); ++v) {
      if ((positions[v] - middle).squaredNorm() < (positions[nearest] - middle).squaredNorm()) {
        nearest = v;
      }
    }
    return sim::SpringEnd{body, {nearest}};
  };
  return {end(valve.first, valve.second), end(valve.second, valve.first)};
}

/// m, of the smaller one of two soft bodies.
double smaller_size(const sim::World& world, int first, int second) {
  const auto diagonal = [&](int body) {
    return sim::bounds(world.soft[sim::at(body)].positions).size().norm();
  };
  return std::min(diagonal(first), diagonal(second));
}

/// m, of which a spring's wire and coil are parts.
double drawn_length(const sim::World& world, const sim::BodySpring& spring) {
  const double size = smaller_size(world, spring.first.body, spring.second.body);
  return std::max(
      {spring.rest_length, sim::spring_between(world, spring).norm(), least_length_of_size * size});
}

/// A tube about a line that winds around the axis from a to b.
struct Coil : LineAxes {
  Vec3f a;
  float length;

  Coil(const Vec3f& from, const Vec3f& to)
      : LineAxes(to - from), a(from), length((to - from).norm()) {}

  Vec3f radial(float angle) const { return std::cos(angle) * across + std::sin(angle) * other; }
};

}  // namespace

JointMeshes::JointMeshes(const sim::World& world) {
  for (const sim::BodySpring& spring : world.springs) {
    const double length = drawn_length(world, spring);
    joints_.push_back({spring.first, spring.second, tube_shape(ring_count(turns_of_spring), steel),
                       turns_of_spring, static_cast<float>(wire_of_length * length),
                       static_cast<float>(coil_of_length * length)});
  }
  for (const sim::Valve& valve : world.valves) {
    auto [first, second] = nearest_ends(world, valve);
    const double size = smaller_size(world, valve.first, valve.second);
    joints_.push_back({std::move(first), std::move(second), tube_shape(rings_of_pipe, brass), 0,
                       static_cast<float>(pipe_of_size * size), 0.0f});
  }
}

void JointMeshes::add(const sim::World& world, render::Frame& frame) const {
  for (const Joint& joint : joints_) {
    const auto place = [&](const sim::SpringEnd& end) -> Vec3f {
      return sim::middle(world.soft[sim::at(end.body)].positions, end.vertices).cast<float>();
    };
    const Coil coil(place(joint.first), place(joint.second));
    const int rings = ring_count(joint.turns);
    const auto centre = [&](float part) -> Vec3f {
      const float winding = std::clamp((part - straight) / (1.0f - 2.0f * straight), 0.0f, 1.0f);
      const float angle =
          2.0f * std::numbers::pi_v<float> * static_cast<float>(joint.turns) * winding;
      const float room = std::min({1.0f, part / straight, (1.0f - part) / straight});
      return coil.a + part * coil.length * coil.along +
             room * joint.coil_radius * coil.radial(angle);
    };
    render::Mesh mesh;
    mesh.shape = joint.shape;
    mesh.roughness = 0.3f;
    for (int ring = 0; ring < rings; ++ring) {
      const float part = static_cast<float>(ring) / static_cast<float>(rings - 1);
      const float step = 0.5f / static_cast<float>(rings);
      const Vec3f here = centre(part);
      const Vec3f ahead = centre(std::min(1.0f, part + step)) - centre(std::max(0.0f, part - step));
      const Vec3f tangent = ahead.norm() > 0.0f ? Vec3f(ahead.normalized()) : coil.along;
      const Vec3f one = (coil.across - coil.across.dot(tangent) * tangent).normalized();
      const Vec3f two = tangent.cross(one);
      for (int side = 0; side < tube_sides; ++side) {
        const float angle =
            2.0f * std::numbers::pi_v<float> * static_cast<float>(side) / tube_sides;
        const Vec3f normal = std::cos(angle) * one + std::sin(angle) * two;
        mesh.positions.push_back(here + joint.radius * normal);
        mesh.normals.push_back(normal);
      }
    }
    frame.meshes.push_back(std::move(mesh));
  }
}

}  // namespace pneuma::app
