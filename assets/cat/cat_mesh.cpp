#include "assets/cat/cat_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "assets/cat/cat_shape.h"
#include "assets/cat/isosurface.h"
#include "assets/cat/remesh.h"

namespace pneuma::assets {
namespace {

/// Of the first mesh, m: the thinnest parts are three cells thick.
constexpr double coarsest_cell = 0.03;

std::string metres(double value) {
  const long long micrometres = std::llround(value * 1e6);
  const long long size = std::llabs(micrometres);
  char text[32];
  std::snprintf(text, sizeof text, "%s%lld.%06lld", micrometres < 0 ? "-" : "", size / 1000000,
                size % 1000000);
  return text;
}

/// Where the vertices of a sole come to lie is up to the mesh.
void put_onto_ground(sim::TriangleMesh& mesh) {
  double lowest = mesh.vertices.front().z();
  for (const Vec3& v : mesh.vertices) lowest = std::min(lowest, v.z());
  for (Vec3& v : mesh.vertices) v.z() -= lowest;
}

}  // namespace

sim::TriangleMesh make_cat(double edge_length) {
  const auto distance = [](const Vec3& point) { return cat_distance(point).value; };
  const auto wanted_length = [edge_length](const Vec3& point) {
    return edge_length * cat_spacing(point);
  };
  const sim::TriangleMesh rough =
      isosurface(distance, CatBox{}, std::min(coarsest_cell, edge_length));
  sim::TriangleMesh mesh = remesh(rough, {project_to_cat, wanted_length});
  put_onto_ground(mesh);
  return mesh;
}

std::string write_ply(const sim::TriangleMesh& mesh) {
  std::string text =
      "ply\nformat ascii 1.0\n"
      "comment A cat, standing on z = 0, nose towards +x. Metres. Made by make_cat of pneuma\n"
      "element vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const sim::Vec3& v : mesh.vertices) {
    text += metres(v.x()) + ' ' + metres(v.y()) + ' ' + metres(v.z()) + '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  return text;
}

}  // namespace pneuma::assets
