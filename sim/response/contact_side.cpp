#include "sim/response/contact_side.h"

#include <algorithm>
#include <cmath>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {

BoxMass box_mass(const RigidBox& box) {
  return {1.0 / box.mass, row_matrix(world_inverse_inertia(box))};
}

SideInContact::SideInContact(World& world, std::span<const BoxMass> masses, const ContactSide& side,
                             const Vec3& point) {
  switch (side.kind) {
    case BodyKind::soft: {
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
    case BodyKind::rigid: {
      box_ = &world.rigid[at(side.body)];
      const BoxMass& mass = masses[at(side.body)];
      inverse_mass_ = mass.inverse_mass;
      const Vec3 r = point - box_->position;
      leverage_ = {{Row{0.0, -r.z(), r.y(), 0.0}, Row{r.z(), 0.0, -r.x(), 0.0},
                    Row{-r.y(), r.x(), 0.0, 0.0}}};
      for (std::size_t i = 0; i < 3; ++i) {
        turning_.columns[i] = mass.inverse_inertia * -leverage_.columns[i];
      }
      break;
    }
    case BodyKind::ground:
      break;
  }
}

RowMatrix SideInContact::mobility() const {
  RowMatrix result{{Row{inverse_mass_, 0.0, 0.0, 0.0}, Row{0.0, inverse_mass_, 0.0, 0.0},
                    Row{0.0, 0.0, inverse_mass_, 0.0}}};
  if (!box_) return result;
  for (std::size_t i = 0; i < 3; ++i) result.columns[i] += leverage_ * turning_.columns[i];
  return result;
}

Row SideInContact::place() const {
  if (box_) return to_row(box_->position);
  if (!soft_) return Row{};
  const RowReader positions(soft_->positions);
  Row sum{};
  for (int i = 0; i < vertex_count_; ++i) sum += positions[vertices_[at(i)]];
  return sum / static_cast<double>(vertex_count_);
}

void SideInContact::displace(Row displacement) const {
  if (box_) box_->position += to_vec3(displacement);
  for (int i = 0; i < vertex_count_; ++i) {
    soft_->positions[vertices_[at(i)]] += to_vec3(displacement);
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

Surface combine(const Surface& a, const Surface& b) {
  return {std::max(a.restitution, b.restitution), std::sqrt(a.friction * b.friction)};
}

}  // namespace pneuma::sim
