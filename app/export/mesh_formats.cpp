#include "app/export/mesh_formats.h"

#include <fmt/format.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "app/picture/srgb.h"

namespace pneuma::app {
namespace {

using Json = nlohmann::ordered_json;
using sim::Vec3;

static_assert(std::endian::native == std::endian::little, "the binary formats are little-endian");

template <typename Value>
void put(Bytes& bytes, const Value& value) {
  const auto start = bytes.size();
  bytes.resize(start + sizeof value);
  std::memcpy(bytes.data() + start, &value, sizeof value);
}

void put(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

std::uint8_t to_byte(float share) { return static_cast<std::uint8_t>(std::lround(share * 255.0f)); }

/// Scenes are called after their files, which may be called anything.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  return text;
}

constexpr std::uint32_t header_chunk_end = 12;  // bytes of the header before the first chunk
constexpr int float_type = 5126, unsigned_int_type = 5125, unsigned_byte_type = 5121;
constexpr int vertex_target = 34962, index_target = 34963;

/// The parts of a GLB file while bodies are added.
class GlbWriter {
 public:
  explicit GlbWriter(const std::string& comment) {
    json_["asset"] = {{"version", "2.0"}, {"generator", comment}};
    json_["scene"] = 0;
    json_["scenes"] = {{{"nodes", {0}}}};
    const double half = std::sqrt(0.5);  // a quarter turn about x: +z to +y
    json_["nodes"] = {{{"name", "z_up"}, {"rotation", {-half, 0.0, 0.0, half}}}};
    // A material of white, which the vertices' colours are multiplied by.
    json_["materials"] = {
        {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}}}};
  }

  void add(const ExportedMesh& mesh) {
    const int positions = add_positions(mesh.vertices);
    const int colours = add_colours(*mesh.colours);
    const int indices = add_indices(*mesh.triangles);
    const auto number = json_["meshes"].size();
    json_["meshes"].push_back({{"name", mesh.name},
                               {"primitives",
                                {{{"attributes", {{"POSITION", positions}, {"COLOR_0", colours}}},
                                  {"indices", indices},
                                  {"material", 0}}}}});
    json_["nodes"][0]["children"].push_back(json_["nodes"].size());
    json_["nodes"].push_back({{"name", mesh.name}, {"mesh", number}});
  }

  Bytes bytes() {
    json_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto size = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
    Bytes file;
    put(file, std::string("glTF"));
    put(file, std::uint32_t{2});
    put(file, size(header_chunk_end + 8 + text.size() + 8 + binary_.size()));
    put(file, size(text.size()));
    put(file, std::string("JSON"));
    put(file, text);
    put(file, size(binary_.size()));
    put(file, std::string("BIN\0", 4));
    file.insert(file.end(), binary_.begin(), binary_.end());
    return file;
  }

 private:
  /// Everything from `start` to the end of the binary part, which stays a multiple of four long.
  int add_accessor(std::size_t start, std::size_t count, int type, const char* shape, int target) {
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", start},
                                    {"byteLength", binary_.size() - start},
                                    {"target", target}});
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", type},
                                  {"count", count},
                                  {"type", shape}});
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  int add_positions(const std::vector<Vec3>& vertices) {
    const std::size_t start = binary_.size();
    Eigen::Vector3f low = vertices.front().cast<float>(), high = low;
    for (const Vec3& vertex : vertices) {
      const Eigen::Vector3f v = vertex.cast<float>();
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
      for (int axis = 0; axis < 3; ++axis) put(binary_, v[axis]);
    }
    const int accessor = add_accessor(start, vertices.size(), float_type, "VEC3", vertex_target);
    json_["accessors"].back()["min"] = {low.x(), low.y(), low.z()};
    json_["accessors"].back()["max"] = {high.x(), high.y(), high.z()};
    return accessor;
  }

  int add_colours(const std::vector<render::Colour>& colours) {
    const std::size_t start = binary_.size();
    for (const render::Colour& colour : colours) {
      // Light, not sRGB.
      for (int channel = 0; channel < 3; ++channel) {
        put(binary_, to_byte(to_light(colour[channel])));
      }
      put(binary_, std::uint8_t{255});
    }
    const int accessor =
        add_accessor(start, colours.size(), unsigned_byte_type, "VEC4", vertex_target);
    json_["accessors"].back()["normalized"] = true;
    return accessor;
  }

  int add_indices(const std::vector<sim::Triangle>& triangles) {
    const std::size_t start = binary_.size();
    for (const sim::Triangle& triangle : triangles) {
      for (const int v : triangle) put(binary_, static_cast<std::uint32_t>(v));
    }
    return add_accessor(start, 3 * triangles.size(), unsigned_int_type, "SCALAR", index_target);
  }

  Json json_;
  Bytes binary_;
};

}  // namespace

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
  for (const ExportedMesh& mesh : meshes) writer.add(mesh);
  return writer.bytes();
}

}  // namespace pneuma::app
