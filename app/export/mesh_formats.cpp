#include "app/export/mesh_formats.h"

#include <fmt/format.h>

#include <cctype>

#include "app/export/glb_writer.h"

namespace pneuma::app {

using sim::Vec3;

std::string one_line(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  return text;
}

Bytes encode_ply(std::span<const ExportedMesh> meshes, const std::string& comment) {
  std::size_t vertices = 0, triangles = 0;
  std::string bodies;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    vertices += meshes[i].vertices.size();
    triangles += meshes[i].triangles->size();
    bodies += fmt::format("comment body {} {}\n", i, meshes[i].name);
  }
  Bytes bytes;
  put(bytes, fmt::format("ply\nformat binary_little_endian 1.0\ncomment {}\n{}"
                         "element vertex {}\nproperty double x\nproperty double y\n"
                         "property double z\nproperty uchar red\nproperty uchar green\n"
                         "property uchar blue\nproperty int body\n"
                         "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                         one_line(comment), bodies, vertices, triangles));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    for (std::size_t v = 0; v < meshes[i].vertices.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) put(bytes, meshes[i].vertices[v][axis]);
      for (int channel = 0; channel < 3; ++channel) {
        put(bytes, to_byte((*meshes[i].colours)[v][channel]));
      }
      put(bytes, static_cast<std::int32_t>(i));
    }
  }
  std::int32_t first = 0;
  for (const ExportedMesh& mesh : meshes) {
    for (const sim::Triangle& triangle : *mesh.triangles) {
      put(bytes, std::uint8_t{3});
      for (const int v : triangle) put(bytes, static_cast<std::int32_t>(first + v));
    }
    first += static_cast<std::int32_t>(mesh.vertices.size());
  }
  return bytes;
}

Bytes encode_obj(std::span<const ExportedMesh> meshes, const std::string& comment) {
  Bytes bytes;
  put(bytes, fmt::format("# {}\n", one_line(comment)));
  int first = 1;
  for (const ExportedMesh& mesh : meshes) {
    put(bytes, fmt::format("o {}\n", mesh.name));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vec3& p = mesh.vertices[v];
      const render::Colour& c = (*mesh.colours)[v];
      put(bytes, fmt::format("v {:.17g} {:.17g} {:.17g} {:.4f} {:.4f} {:.4f}\n", p.x(), p.y(),
                             p.z(), c.x(), c.y(), c.z()));
    }
    for (const auto& [a, b, c] : *mesh.triangles) {
      put(bytes, fmt::format("f {} {} {}\n", first + a, first + b, first + c));
    }
    first += static_cast<int>(mesh.vertices.size());
  }
  return bytes;
}

Bytes encode_glb(std::span<const ExportedMesh> meshes, const std::string& comment) {
  GlbWriter writer(one_line(comment));
  for (const ExportedMesh& mesh : meshes) writer.add_node(mesh.name, writer.add_mesh(mesh));
  return writer.bytes();
}

}  // namespace pneuma::app
