#include "sim/potential/contact_potential.h"

#include <algorithm>

#include "sim/mesh/vec4d.h"
#include "sim/potential/mollifier.h"

namespace pneuma::sim {
namespace {

/// Whether boxes along the axes about both features of a pair are further apart than its reach.
bool is_far(const ContactPair& pair, const VertexReader& x) {
  const Vec4d a = x[pair.vertices[0]], b = x[pair.vertices[1]];
  const Vec4d c = x[pair.vertices[2]], d = x[pair.vertices[3]];
  const Vec4d low = pair.is_edges ? min(a, b) : a, high = pair.is_edges ? max(a, b) : a;
  const Vec4d other_low = pair.is_edges ? min(c, d) : min(b, min(c, d));
  const Vec4d other_high = pair.is_edges ? max(c, d) : max(b, max(c, d));
  return !all_of_lanes((low - other_high <= pair.reach) & (other_low - high <= pair.reach));
}

PairCorners corners(const std::array<int, 4>& vertices, const VertexArray& positions) {
  return {positions[vertices[0]], positions[vertices[1]], positions[vertices[2]],
          positions[vertices[3]]};
}

/// Calls take(contact, energy) for every one that is within its reach.
template <class Take>
void for_each_active(const ContactSurfaces& surfaces, const VertexArray& positions,
                     const std::vector<ContactPair>& pairs, const Take& take) {
  const VertexReader x(positions);
  ActiveContact contact;
  for (const ContactPair& pair : pairs) {
    if (is_far(pair, x)) continue;
    const PairCorners at_corners = corners(pair.vertices, positions);
    contact.point =
        pair.is_edges ? nearest_edge_edge(at_corners) : nearest_vertex_triangle(at_corners);
    if (contact.point.distance >= pair.reach) continue;
    contact.vertices = pair.vertices;
    contact.first = pair.first;
    contact.second = pair.second;
    contact.reach = pair.reach;
    contact.strength = pair.weight * surfaces.stiffness();
    contact.barrier = barrier_at(contact.point.distance, contact.reach, contact.strength);
    contact.threshold = pair.mollifier;
    contact.mollifier =
        pair.is_edges ? mollifier_value(squared_cross(at_corners), pair.mollifier) : 1.0;
    contact.restitution = pair.restitution;
    contact.friction = pair.friction;
    take(contact);
  }
}

template <class Take>
void for_each_on_ground(const ContactSurfaces& surfaces, const VertexArray& positions,
                        const Take& take) {
  if (!surfaces.ground()) return;
  for (int s = 0; s < surfaces.count(); ++s) {
    const ContactSurface& surface = surfaces[s];
    if (!surface.is_mobile) continue;
    const ContactMaterial material = combine(surface.material, *surfaces.ground());
    for (int i = 0; i < surface.vertex_count; ++i) {
      const int v = surface.first_vertex + i;
      const double height = positions[v].z() + surface.reach;
      if (height >= surface.reach || !surfaces.is_mobile(v)) continue;
      ActiveContact contact;
      contact.vertices = {v, v, v, v};
      contact.count = 1;
      contact.first = s;
      contact.point.weights = {1.0, 0.0, 0.0, 0.0};
      contact.point.apart = {0.0, 0.0, height};
      contact.point.distance = height;
      contact.reach = surface.reach;
      contact.strength = surface.areas[at(i)] * surfaces.stiffness();
      contact.barrier = barrier_at(height, contact.reach, contact.strength);
      contact.restitution = material.restitution;
      contact.friction = material.friction;
      take(contact);
    }
  }
}

void add_weighted(const ActiveContact& contact, const Vec3& value, VertexArray& sum) {
  for (int i = 0; i < contact.count; ++i) {
    sum[contact.vertices[at(i)]] += contact.point.weights[at(i)] * value;
  }
}

/// N, on the first side, beside the gradient's.
Vec3 dissipative_force(const ActiveContact& contact, const Vec3& velocity, double speed) {
  const Vec3 normal = contact.point.normal();
  const double parting = normal.dot(velocity);
  const double taken = (1.0 - contact.restitution * contact.restitution) *
                       parting_ramp(parting / speed).slope * contact.push();
  Vec3 force = -taken * normal;
  const Vec3 sliding = velocity - parting * normal;
  const double size = sliding.norm();
  if (size > 0.0 && contact.friction > 0.0) {
    const double braking =
        contact.friction * (contact.push() - taken) * smooth_friction(size / speed).slope;
    force -= braking / size * sliding;
  }
  return force;
}

}  // namespace

double find_active(const ContactSurfaces& surfaces, const VertexArray& positions,
                   const std::vector<ContactPair>& pairs, std::vector<ActiveContact>& active) {
  active.clear();
  double energy = 0.0;
  const auto take = [&](const ActiveContact& contact) {
    energy += contact.mollifier * contact.barrier.value;
    active.push_back(contact);
  };
  for_each_on_ground(surfaces, positions, take);
  for_each_active(surfaces, positions, pairs, take);
  return energy;
}

double contact_energy(const ContactSurfaces& surfaces, const VertexArray& positions,
                      const std::vector<ContactPair>& pairs) {
  double energy = 0.0;
  const auto take = [&](const ActiveContact& contact) {
    energy += contact.mollifier * contact.barrier.value;
  };
  for_each_on_ground(surfaces, positions, take);
  for_each_active(surfaces, positions, pairs, take);
  return energy;
}

double contact_energy(const World& world) {
  const ContactSurfaces surfaces(world);
  VertexArray positions(surfaces.vertex_count()), velocities(surfaces.vertex_count());
  surfaces.gather(world, positions, velocities);
  surfaces.place_boxes(world, positions);
  std::vector<ContactPair> pairs;
  PairFinder(surfaces).find(positions, positions, 0.0, pairs);
  return contact_energy(surfaces, positions, pairs);
}

PairCorners corners_of(const ActiveContact& contact, const VertexArray& positions) {
  return corners(contact.vertices, positions);
}

void add_gradient(const std::vector<ActiveContact>& active, const VertexArray& positions,
                  VertexArray& gradient) {
  for (const ActiveContact& contact : active) {
    add_weighted(contact, -contact.push() * contact.point.normal(), gradient);
    if (!contact.is_mollified()) continue;
    const Vec12 by_mollifier =
        contact.barrier.value *
        mollifier(corners_of(contact, positions), contact.threshold).gradient;
    for (int i = 0; i < 4; ++i) {
      gradient[contact.vertices[at(i)]] += by_mollifier.segment<3>(3 * i);
    }
  }
}

Mat12 contact_hessian(const ActiveContact& contact, const VertexArray& positions) {
  const PairCorners x = corners_of(contact, positions);
  const Vec12 slope = distance_gradient(contact.point);
  const FunctionValue& b = contact.barrier;
  Mat12 hessian =
      b.curvature * slope * slope.transpose() + b.slope * distance_hessian(x, contact.point);
  if (!contact.is_mollified()) return hessian;
  const Mollifier m = mollifier(x, contact.threshold);
  return m.value * hessian +
         b.slope * (m.gradient * slope.transpose() + slope * m.gradient.transpose()) +
         b.value * m.hessian;
}

Vec3 relative_velocity(const ActiveContact& contact, const VertexArray& velocities) {
  Vec3 velocity = Vec3::Zero();
  for (int i = 0; i < contact.count; ++i) {
    velocity += contact.point.weights[at(i)] * velocities[contact.vertices[at(i)]];
  }
  return velocity;
}

Vec3 contact_force(const ActiveContact& contact, const Vec3& velocity,
                   double regularisation_speed) {
  return contact.push() * contact.point.normal() +
         dissipative_force(contact, velocity, regularisation_speed);
}

void add_forces(const std::vector<ActiveContact>& active, const VertexArray& positions,
                const VertexArray& velocities, double regularisation_speed, VertexArray& forces) {
  for (const ActiveContact& contact : active) {
    const Vec3 velocity = relative_velocity(contact, velocities);
    add_weighted(contact, contact_force(contact, velocity, regularisation_speed), forces);
    if (!contact.is_mollified()) continue;
    const Vec12 by_mollifier =
        contact.barrier.value *
        mollifier(corners_of(contact, positions), contact.threshold).gradient;
    for (int i = 0; i < 4; ++i) {
      forces[contact.vertices[at(i)]] -= by_mollifier.segment<3>(3 * i);
    }
  }
}

}  // namespace pneuma::sim
