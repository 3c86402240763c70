#include "app/picture/build_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/picture/body_colours.h"
#include "app/picture/colour_field.h"
#include "app/picture/faceted.h"
#include "app/picture/ghost.h"
#include "app/picture/impulse_arrows.h"
#include "app/picture/overlay.h"
#include "app/picture/rounding_room.h"
#include "app/world/touch.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/soft/gas_law.h"

namespace pneuma::app {
namespace {

using ShapePointer = std::shared_ptr<const render::MeshShape>;
using sim::Vec3;

std::vector<std::array<std::uint32_t, 3>> indices(const std::vector<sim::Triangle>& triangles) {
  std::vector<std::array<std::uint32_t, 3>> result;
  for (const auto& [a, b, c] : triangles) {
    result.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                      static_cast<std::uint32_t>(c)});
  }
  return result;
}

ShapePointer soft_shape(const sim::SoftMesh& mesh, const scenes::BodyScene& body, bool has_faces) {
  auto shape = std::make_shared<render::MeshShape>();
  shape->triangles = indices(mesh.topology.triangles());
  for (const auto& [a, b] : mesh.topology.edges()) {
    shape->edges.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
  }
  std::vector<Vec3> vertices;
  for (int v = 0; v < mesh.rest_positions.size(); ++v) {
    vertices.emplace_back(mesh.rest_positions[v]);
  }
  shape->colours = body_colours(vertices, body.colours, body.colour_axis);
  if (has_faces) shape->corner_normals = corner_normals(mesh);
  return shape;
}

/// Two corners of a box are the ends of an edge when they differ along one axis only: of the mesh's
/// 18 edges this leaves out the faces' diagonals.
bool is_box_edge(const Vec3& a, const Vec3& b) { return (a.array() != b.array()).count() == 1; }

ShapePointer rigid_shape(const sim::RigidBox& box, const scenes::BodyScene& body) {
  const sim::TriangleMesh mesh = sim::make_box(box.size, 1);
  auto shape = std::make_shared<render::MeshShape>();
  shape->triangles = indices(mesh.triangles);
  for (std::uint32_t a = 0; a < mesh.vertices.size(); ++a) {
    for (std::uint32_t b = a + 1; b < mesh.vertices.size(); ++b) {
      if (is_box_edge(mesh.vertices[a], mesh.vertices[b])) shape->edges.push_back({a, b});
    }
  }
  shape->colours = body_colours(mesh.vertices, body.colours, body.colour_axis);
  shape->corner_normals = corner_normals(*sim::make_soft_mesh(mesh));
  return shape;
}

render::Mesh soft_mesh(const sim::SoftBody& body, const ShapePointer& shape) {
  render::Mesh mesh;
  mesh.shape = shape;
  for (int v = 0; v < body.positions.size(); ++v) {
    mesh.positions.emplace_back(Vec3(body.positions[v]).cast<float>());
  }
  std::vector<Vec3> normals;
  sim::vertex_normals(body.mesh->topology, body.positions, normals);
  for (const Vec3& normal : normals) mesh.normals.emplace_back(normal.cast<float>());
  return mesh;
}

render::Mesh rigid_mesh(const sim::RigidBox& box, const ShapePointer& shape) {
  render::Mesh mesh;
  mesh.shape = shape;
  for (const Vec3& corner : sim::make_box(box.size, 1).vertices) {
    mesh.positions.emplace_back((box.position + box.orientation * corner).cast<float>());
  }
  return mesh;
}

/// m, along the diagonal of the largest body that is not given its motion; of any, if all are.
double largest_extent(const sim::World& start) {
  double free = 0.0, given = 0.0;
  for (int body = 0; body < static_cast<int>(start.soft.size() + start.rigid.size()); ++body) {
    double& largest = sim::is_kinematic(start, body) ? given : free;
    largest = std::max(largest, body_bounds(start, body).size().norm());
  }
  return free > 0.0 ? free : given;
}

/// m, between lines: 1, but for bodies that are beyond a hand's breadth and a house another power
/// of ten.
float grid_spacing(const sim::World& start) {
  constexpr double smallest_beside_metres = 0.3, largest_beside_metres = 50.0;
  const double extent = largest_extent(start);
  if (extent >= smallest_beside_metres && extent <= largest_beside_metres) return 1.0f;
  return extent > 0.0 ? static_cast<float>(std::pow(10.0, std::floor(std::log10(extent)))) : 1.0f;
}

/// The radius of bars that are drawn along the edges of a body, of its extent.
constexpr double bar_of_extent = 0.003;

/// On a caption; of more bodies the first ones.
constexpr int most_pressures = 8;

/// A line for each body with gas.
std::string pressure_lines(const sim::World& world) {
  std::string lines;
  int count = 0;
  for (const sim::SoftBody& body : world.soft) {
    const sim::GasLaw law = sim::gas_law(body.material);
    if (!(law.strength > 0.0) || ++count > most_pressures) continue;
    const double volume = sim::volume(body.mesh->topology, body.positions);
    lines += fmt::format("\n{}: {:.4g} Pa, {:.4g} mol", body.name, sim::gauge_pressure(law, volume),
                         body.material.n);
  }
  return lines;
}

/// Of the times on captions, in s: no two frames have the same.
int time_digits(int frames_per_second) {
  int digits = 2;
  for (int frames = 100; frames < frames_per_second; frames *= 10) ++digits;
  return digits;
}

render::Caption caption(const std::string& title, const sim::World& world, int digits,
                        bool pressures) {
  return {fmt::format("{}\nt = {:.{}f} s   step {}{}", title, sim::time(world), digits, world.steps,
                      pressures ? pressure_lines(world) : std::string())};
}

void add_overlays(const sim::World& world, std::span<const sim::Contact> contacts, const Show& show,
                  render::Frame& frame) {
  if (show.field != ColourField::none) add_field(world, show, frame);
  if (show.ghost) add_ghosts(world, frame);
  if (show.particles) {
    add_particles(world, contacts, frame);
    if (frame.caption) frame.caption->text += particle_legend();
  }
  if (show.contacts) {
    add_contacts(contacts, frame);
    if (frame.caption) frame.caption->text += contact_legend();
  }
  if (show.impulses) {
    const double scale = show.arrow_scale.value_or(arrow_scale(contacts, frame.camera));
    add_impulses(contacts, scale, frame);
    if (frame.caption) frame.caption->text += arrow_legend(scale, world.settings.steps_per_second);
  }
  if (show.labels) add_labels(world, frame);
  frame.scale_bar = show.scale;
}

}  // namespace

FrameBuilder::FrameBuilder(const scenes::Scene& scene, const sim::World& start)
    : title_(scene.title.empty() ? scene.name : scene.title),
      caption_(scene.picture.caption),
      time_digits_(time_digits(scene.picture.frames_per_second)),
      pressures_(scene.picture.pressures),
      rounded_(scene.picture.rounded),
      joints_(start) {
  scenery_.light.shadows = scene.picture.shadows;
  scenery_.ground->grid_spacing = grid_spacing(start);
  if (!scene.settings.ground || !scene.picture.grid) scenery_.ground.reset();

  // build_world puts a body's copies one after the other, in the order of the scene.
  for (const scenes::BodyScene& body : scene.bodies) {
    const auto copies = static_cast<std::size_t>(scenes::copy_count(body));
    if (scenes::is_box(body)) {
      const sim::RigidBox& box = start.rigid.at(rigid_looks_.size());
      rigid_looks_.insert(rigid_looks_.end(), copies,
                          look(body, rigid_shape(box, body), true, box.size.norm()));
    } else {
      const sim::SoftBody& soft = start.soft.at(soft_looks_.size());
      const sim::SoftMesh& mesh = *soft.mesh;
      const bool means_faces =
          body.shape == scenes::Shape::box || body.shape == scenes::Shape::model;
      const bool keeps_shape = body.kind != scenes::BodyKind::soft;
      const bool has_faces =
          rounded_ && means_faces && (is_faceted(mesh) || (keeps_shape && has_flat_faces(mesh)));
      soft_looks_.insert(soft_looks_.end(), copies,
                         look(body, soft_shape(mesh, body, has_faces), !rounded_ || has_faces,
                              sim::bounds(soft.positions).size().norm()));
    }
  }
}

/// `extent`: m, of the body.
FrameBuilder::Look FrameBuilder::look(const scenes::BodyScene& body, const ShapePointer& shape,
                                      bool has_edges, double extent) {
  Look look{shape, static_cast<float>(body.roughness), has_edges};
  if (body.drawn == scenes::Drawn::surface) return look;
  const bool draws_edges = body.drawn == scenes::Drawn::edges;
  look.bars =
      std::make_shared<EdgeBars>(draws_edges ? shape->edges : EdgeBars::Edges(), shape->colours,
                                 static_cast<float>(bar_of_extent * extent));
  return look;
}

/// `mesh`: the body's surface.
render::Mesh FrameBuilder::as_seen(render::Mesh mesh, const Look& look) {
  if (look.bars) mesh = look.bars->mesh(mesh.positions);
  if (look.has_edges) mesh.normals.clear();
  mesh.roughness = look.roughness;
  return mesh;
}

render::Frame FrameBuilder::build(const sim::World& world, const render::Camera& camera,
                                  std::span<const sim::Contact> contacts, const Show& show) const {
  render::Frame frame = scenery_;
  frame.camera = camera;
  frame.wireframe = show.wireframe;
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    frame.meshes.push_back(as_seen(soft_mesh(world.soft[i], soft_looks_[i].shape), soft_looks_[i]));
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    frame.meshes.push_back(
        as_seen(rigid_mesh(world.rigid[i], rigid_looks_[i].shape), rigid_looks_[i]));
  }
  // Edges and particles are shown where they are simulated, and lie on the surface only if it is.
  const bool only_surfaces = !show.wireframe && !show.particles && !show.contacts && !show.impulses;
  if (rounded_ && only_surfaces) set_rounding_room(frame.meshes);
  joints_.add(world, frame);
  if (caption_) frame.caption = caption(title_, world, time_digits_, pressures_);
  add_overlays(world, contacts, show, frame);
  return frame;
}

}  // namespace pneuma::app
