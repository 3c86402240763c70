#include "sim/response/contact_side.h"

#include <algorithm>
#include <cmath>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {

BoxMass box_mass(const RigidBox& box) {
  return {1.0 / box.mass, mat3x4(world_inverse_inertia(box))};
}

SolverSide::SolverSide(World& world, std::span<const BoxMass> masses, const ContactSide& side,
                       const Vec3& point) {
  switch (side.kind) {
    case SideKind::soft: {
      soft_ = &world.soft[at(side.body)];
      const auto vertices = soft_->mesh->topology.feature_vertices(side.feature);
      vertex_count_ = static_cast<int>(vertices.size());
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices_[i] = vertices[i];
        velocities_[i] = soft_->velocities.rows().col(vertices[i]).data();
      }
      inverse_mass_ = 1.0 / (vertex_count_ * soft_->material.vertex_mass);
      break;
    }
    case SideKind::rigid: {
      box_ = &world.rigid[at(side.body)];
      const BoxMass& mass = masses[at(side.body)];
      inverse_mass_ = mass.inverse_mass;
      const Vec3 r = point - box_->position;
      leverage_ = {{Vec4d{0.0, -r.z(), r.y(), 0.0}, Vec4d{r.z(), 0.0, -r.x(), 0.0},
                    Vec4d{-r.y(), r.x(), 0.0, 0.0}}};
      for (std::size_t i = 0; i < 3; ++i) {
        turning_.columns[i] = mass.inverse_inertia * -leverage_.columns[i];
      }
      break;
    }
    case SideKind::ground:
      break;
  }
}

Mat3x4 SolverSide::mobility() const {
  Mat3x4 result{{Vec4d{inverse_mass_, 0.0, 0.0, 0.0}, Vec4d{0.0, inverse_mass_, 0.0, 0.0},
                 Vec4d{0.0, 0.0, inverse_mass_, 0.0}}};
  if (!box_) return result;
  for (std::size_t i = 0; i < 3; ++i) result.columns[i] += leverage_ * turning_.columns[i];
  return result;
}

Vec4d SolverSide::position() const {
  if (box_) return to_vec4d(box_->position);
  if (!soft_) return Vec4d{};
  const VertexReader positions(soft_->positions);
  Vec4d sum{};
  for (int i = 0; i < vertex_count_; ++i) sum += positions[vertices_[at(i)]];
  return sum / static_cast<double>(vertex_count_);
}

void SolverSide::displace(Vec4d displacement) const {
  if (box_) box_->position += to_vec3(displacement);
  for (int i = 0; i < vertex_count_; ++i) {
    soft_->positions[vertices_[at(i)]] += to_vec3(displacement);
  }
}

const ContactMaterial& surface(const World& world, const ContactSide& side) {
  switch (side.kind) {
    case SideKind::soft:
      return world.soft[at(side.body)].material.surface;
    case SideKind::rigid:
      return world.rigid[at(side.body)].surface;
    case SideKind::ground:
      break;
  }
  return *world.settings.ground;
}

}  // namespace pneuma::sim
