#include "app/picture/overlay.h"

#include <algorithm>
#include <array>

#include "app/world/touch.h"
#include "sim/collision/surface_view.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::app {
namespace {

using render::Colour;

// Hues far apart from each other and from the scenes' reds and greens.
const std::array<Colour, 6> body_hues = {Colour(0.10f, 0.85f, 0.95f), Colour(1.00f, 0.85f, 0.10f),
                                         Colour(0.95f, 0.35f, 0.90f), Colour(0.35f, 0.45f, 1.00f),
                                         Colour(1.00f, 0.60f, 0.20f), Colour(0.65f, 1.00f, 0.55f)};
const Colour white(1.0f, 1.0f, 1.0f);
constexpr float free_diameter = 7.0f;  // pixels at 480 lines
constexpr float touching_diameter = 9.0f;
constexpr float ring_diameter = 17.0f;
constexpr float normal_length = 1.0f;  // m

bool is_part_of(const sim::MeshTopology& mesh, sim::Feature part, sim::Feature whole) {
  const auto vertices = mesh.feature_vertices(whole);
  return std::ranges::all_of(mesh.feature_vertices(part), [&](int v) {
    return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
  });
}

/// Whether a contact of the two bodies is on the feature, or on an edge or vertex of it.
bool touches(const sim::World& world, std::span<const sim::Contact> contacts, int body, int other,
             sim::Feature feature) {
  const sim::MeshTopology& mesh = world.soft[sim::at(body)].mesh->topology;
  const auto is_side = [&](const sim::ContactSide& side, const sim::ContactSide& opposite) {
    return side.kind == sim::SideKind::soft && opposite.kind == sim::SideKind::soft &&
           side.body == body && opposite.body == other && is_part_of(mesh, side.feature, feature);
  };
  return std::ranges::any_of(contacts, [&](const sim::Contact& contact) {
    return is_side(contact.first, contact.second) || is_side(contact.second, contact.first);
  });
}

void add_body_particles(const sim::World& world, std::span<const sim::Contact> contacts, int body,
                        int other, const std::vector<int>& features, render::Frame& frame) {
  const sim::SoftBody& soft = world.soft[sim::at(body)];
  const sim::MeshTopology& mesh = soft.mesh->topology;
  const Colour& hue = body_hues[sim::at(body) % body_hues.size()];
  for (const int id : features) {
    const render::Vec3f place =
        sim::to_vec3(sim::feature_centre({mesh, soft.positions}, id)).cast<float>();
    const bool touching = touches(world, contacts, body, other, mesh.feature(id));
    if (touching) frame.points.push_back({place, white, ring_diameter});
    frame.points.push_back({place, hue, touching ? touching_diameter : free_diameter});
  }
}

}  // namespace

void add_particles(const sim::World& world, std::span<const sim::Contact> contacts,
                   render::Frame& frame) {
  for (const sim::ParticlePair& pair : world.particles) {
    if (!pair.near) continue;
    add_body_particles(world, contacts, pair.first, pair.second, pair.first_features, frame);
    add_body_particles(world, contacts, pair.second, pair.first, pair.second_features, frame);
  }
}

Colour contact_colour(const sim::Contact& contact) {
  if (contact.second.kind == sim::SideKind::ground) return {0.15f, 0.15f, 0.20f};
  if (contact.first.kind != contact.second.kind) return {1.0f, 0.55f, 0.0f};
  return contact.first.kind == sim::SideKind::soft ? Colour(0.9f, 0.1f, 0.8f)
                                                   : Colour(0.1f, 0.3f, 1.0f);
}

void add_contacts(std::span<const sim::Contact> contacts, render::Frame& frame) {
  for (const sim::Contact& contact : contacts) {
    const render::Vec3f point = contact.point.cast<float>();
    const render::Vec3f normal = contact.normal.cast<float>();
    const Colour colour = contact_colour(contact);
    frame.points.push_back({point, colour, free_diameter});
    frame.lines.push_back({point, point + normal_length * normal, colour});
  }
}

std::string_view particle_legend() {
  return "\nparticles: a colour for each body, on a white disc where in contact";
}

std::string_view contact_legend() {
  return "\ncontacts, 1 m of normal: ground black, soft bodies magenta, soft and rigid orange, "
         "boxes blue";
}

void add_labels(const sim::World& world, render::Frame& frame) {
  const int count = static_cast<int>(world.soft.size() + world.rigid.size());
  for (int body = 0; body < count; ++body) {
    const sim::Vec3 centre = body_bounds(world, body).centre();
    frame.labels.push_back({centre.cast<float>(), sim::body_name(world, body)});
  }
}

}  // namespace pneuma::app
