#include "sim/response/contact_side.h"

#include <limits>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {
namespace {

std::span<const int> vertices(const SoftBody& body, const ContactSide& side) {
  return body.mesh->topology.feature_vertices(side.feature);
}

}  // namespace

double side_mass(const World& world, const ContactSide& side) {
  switch (side.kind) {
    case BodyKind::soft: {
      const SoftBody& body = world.soft[at(side.body)];
      return body.material.vertex_mass * static_cast<double>(vertices(body, side).size());
    }
    case BodyKind::rigid:
      return world.rigid[at(side.body)].mass;
    case BodyKind::ground:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

Vec3 velocity_at(const World& world, const ContactSide& side, const Vec3& point) {
  switch (side.kind) {
    case BodyKind::soft: {
      const SoftBody& body = world.soft[at(side.body)];
      const auto feature = vertices(body, side);
      Vec3 sum = Vec3::Zero();
      for (const int v : feature) sum += body.velocities[v];
      return sum / static_cast<double>(feature.size());
    }
    case BodyKind::rigid: {
      const RigidBox& box = world.rigid[at(side.body)];
      return box.velocity + box.angular_velocity.cross(point - box.position);
    }
    case BodyKind::ground:
      break;
  }
  return Vec3::Zero();
}

double inverse_mass_along(const World& world, const ContactSide& side, const Vec3& point,
                          const Vec3& direction) {
  const double linear = 1.0 / side_mass(world, side);
  if (side.kind != BodyKind::rigid) return linear;
  const RigidBox& box = world.rigid[at(side.body)];
  const Vec3 turn = (point - box.position).cross(direction);
  return linear + turn.dot(world_inverse_inertia(box) * turn);
}

void apply_impulse(World& world, const ContactSide& side, const Vec3& point, const Vec3& impulse) {
  switch (side.kind) {
    case BodyKind::soft: {
      SoftBody& body = world.soft[at(side.body)];
      const Vec3 change = impulse / side_mass(world, side);
      for (const int v : vertices(body, side)) body.velocities[v] += change;
      break;
    }
    case BodyKind::rigid: {
      RigidBox& box = world.rigid[at(side.body)];
      box.velocity += impulse / box.mass;
      box.angular_velocity += world_inverse_inertia(box) * (point - box.position).cross(impulse);
      break;
    }
    case BodyKind::ground:
      break;
  }
}

void displace(World& world, const ContactSide& side, const Vec3& displacement) {
  switch (side.kind) {
    case BodyKind::soft: {
      SoftBody& body = world.soft[at(side.body)];
      for (const int v : vertices(body, side)) body.positions[v] += displacement;
      break;
    }
    case BodyKind::rigid:
      world.rigid[at(side.body)].position += displacement;
      break;
    case BodyKind::ground:
      break;
  }
}

const Surface& surface(const World& world, const ContactSide& side) {
  switch (side.kind) {
    case BodyKind::soft:
      return world.soft[at(side.body)].material.surface;
    case BodyKind::rigid:
      return world.rigid[at(side.body)].surface;
    case BodyKind::ground:
      break;
  }
  return *world.settings.ground;
}

}  // namespace pneuma::sim
