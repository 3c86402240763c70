#include "sim/inspect/inspect.h"

#include <algorithm>

#include "sim/collision/find_body_contacts.h"
#include "sim/inspect/state_energy.h"
#include "sim/joints/body_springs.h"
#include "sim/joints/gas_flow.h"
#include "sim/mesh/hash_vertices.h"
#include "sim/potential/box_inertia.h"
#include "sim/potential/contact_potential.h"
#include "sim/rigid/inertia.h"
#include "sim/soft/bending.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/spring_force.h"

namespace pneuma::sim {
namespace {

void add_list(base::Hash& hash, const std::vector<int>& values) {
  hash.add(static_cast<std::uint64_t>(values.size()));
  for (const int value : values) hash.add(value);
}

/// Of a FeatureImpulse or a FrictionSlip.
template <typename OfFeatures>
void add_features(base::Hash& hash, const OfFeatures& known) {
  add_list(hash,
           {known.first, static_cast<int>(known.first_feature.kind), known.first_feature.index,
            known.second, static_cast<int>(known.second_feature.kind), known.second_feature.index});
}

Energy& operator+=(Energy& sum, const Energy& term) {
  sum.kinetic += term.kinetic;
  sum.spring += term.spring;
  sum.gas += term.gas;
  sum.gravity += term.gravity;
  return sum;
}

Energy energy(const SoftBody& body, const VertexArray& positions, const VertexArray& velocities,
              const Vec3& gravity) {
  const SoftMaterial& material = body.material;
  Energy result;
  if (is_kinematic(body)) return result;  // of no finite mass
  result.kinetic = 0.5 * material.vertex_mass * velocities.rows().squaredNorm();
  result.spring = spring_energy(*body.mesh, positions, material.k) +
                  bending_energy(*body.mesh, positions, material.bending);
  result.gas = gas_energy(material, volume(body.mesh->topology, positions));
  result.gravity = -material.vertex_mass * positions.size() * gravity.dot(mean(positions));
  return result;
}

/// Of bodies that are at rest: of others they are where these are.
void add_quiet_places(base::Hash& hash, const World& world) {
  const Vec3* place = world.quiet_places.data();
  for (std::size_t i = 0; i < world.soft.size() && !world.quiet_places.empty(); ++i) {
    for (int v = 0; v < world.soft[i].positions.size(); ++v, ++place) {
      if (world.rest[i].quiet_steps > 0) add(hash, *place);
    }
  }
}

}  // namespace

Energy energy(const SoftBody& body, const Vec3& gravity) {
  return energy(body, body.positions, body.velocities, gravity);
}

Energy energy(const SoftBody& body, const SoftState& state, const Vec3& gravity) {
  return energy(body, state.positions, state.velocities, gravity);
}

Energy energy(const RigidBox& box, const Vec3& gravity) {
  return energy(box, state_of(box), gravity);
}

Energy energy(const RigidBox& box, const RigidState& state, const Vec3& gravity) {
  Energy result;
  if (box.is_kinematic) return result;  // likewise
  result.kinetic = kinetic_energy(box, state);
  result.gravity = -box.mass * gravity.dot(state.position);
  return result;
}

Energy energy(const World& world) {
  Energy sum;
  for (const SoftBody& body : world.soft) sum += energy(body, world.settings.gravity);
  for (const RigidBox& box : world.rigid) sum += energy(box, world.settings.gravity);
  sum.spring += spring_energy_between_bodies(world);
  if (world.settings.contact == ContactMethod::potential) sum.contact = contact_energy(world);
  return sum;
}

Momentum momentum(const SoftBody& body) {
  Momentum sum;
  if (is_kinematic(body)) return sum;
  for (int v = 0; v < body.positions.size(); ++v) {
    const Vec3 linear = body.material.vertex_mass * body.velocities[v];
    sum.linear += linear;
    sum.angular += Vec3(body.positions[v]).cross(linear);
  }
  return sum;
}

Momentum momentum(const World& world) {
  Momentum sum;
  for (const SoftBody& body : world.soft) {
    const Momentum term = momentum(body);
    sum.linear += term.linear;
    sum.angular += term.angular;
  }
  for (const RigidBox& box : world.rigid) {
    if (box.is_kinematic) continue;
    const Vec3 linear = box.mass * box.velocity;
    sum.linear += linear;
    sum.angular += box.position.cross(linear) + spin(box);
  }
  return sum;
}

Bounds bounds(const World& world) {
  Bounds all;
  for (const SoftBody& body : world.soft) all.include(bounds(body.positions));
  for (const RigidBox& box : world.rigid) all.include(placed_box(box).bounds);
  return all;
}

std::uint64_t state_hash(const World& world) {
  base::Hash hash;
  hash.add(static_cast<std::uint64_t>(world.steps));
  for (const SoftBody& body : world.soft) {
    add(hash, body.positions);
    add(hash, body.velocities);
  }
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (!has_gas_flow(world, static_cast<int>(i))) continue;
    hash.add(world.soft[i].material.n);
    hash.add(world.soft[i].material.temperature);
  }
  for (const RigidBox& box : world.rigid) {
    add(hash, box.position);
    add(hash, box.velocity);
    add(hash, box.angular_velocity);
    for (const double q : box.orientation.coeffs()) hash.add(q);
  }
  // Beside swept contacts they are only shown.
  if (world.settings.contact == ContactMethod::impulses) {
    for (const ParticlePair& pair : world.particles) {
      add_list(hash, {pair.first, pair.second});
      add_list(hash, pair.first_features);
      add_list(hash, pair.second_features);
      hash.add(static_cast<std::uint64_t>(pair.near));
    }
  }
  for (const WarmStartImpulse& impulse : world.warm_start_impulses) {
    add_list(hash, {impulse.first, impulse.second});
    add(hash, impulse.point);
    add(hash, impulse.impulse);
    if (impulse.is_of_start) hash.add(std::uint64_t{1});
  }
  for (const FeatureImpulse& impulse : world.feature_impulses) {
    add_features(hash, impulse);
    add(hash, impulse.impulse);
    if (impulse.is_of_start) hash.add(std::uint64_t{1});
  }
  for (const FrictionSlip& slip : world.friction_slips) {
    add_features(hash, slip);
    add(hash, slip.slip);
  }
  for (const DepenetratingPair& pair : world.depenetrating)
    add_list(hash, {pair.first, pair.second});
  for (std::size_t i = 0; i < world.lost_energy.size(); ++i) {
    if (world.lost_energy[i] == 0.0) continue;
    hash.add(static_cast<std::uint64_t>(i));
    hash.add(world.lost_energy[i]);
  }
  for (std::size_t i = 0; i < world.rest.size(); ++i) {
    const auto& [quiet_steps, group] = world.rest[i];
    if (quiet_steps > 0 || group >= 0) add_list(hash, {static_cast<int>(i), quiet_steps, group});
  }
  add_quiet_places(hash, world);
  return hash.value();
}

}  // namespace pneuma::sim
