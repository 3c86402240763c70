#include "app/export/glb_writer.h"

#include <algorithm>

#include "app/picture/srgb.h"

namespace pneuma::app {
namespace {

using Eigen::Vector3f;

constexpr std::uint32_t header_chunk_end = 12;  // bytes of the header before the first chunk
constexpr int float_type = 5126, unsigned_int_type = 5125, unsigned_byte_type = 5121;
constexpr int vertex_target = 34962, index_target = 34963, no_target = 0;

std::uint32_t size_32(std::size_t size) { return static_cast<std::uint32_t>(size); }

}  // namespace

GlbWriter::GlbWriter(const std::string& comment) {
  json_["asset"] = {{"version", "2.0"}, {"generator", comment}};
  json_["scene"] = 0;
  json_["scenes"] = {{{"nodes", {0}}}};
  const double half = std::sqrt(0.5);  // a quarter turn about x: +z to +y
  json_["nodes"] = {{{"name", "z_up"}, {"rotation", {-half, 0.0, 0.0, half}}}};
  // A material of white, which the vertices' colours are multiplied by.
  json_["materials"] = {
      {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}}}};
}

std::size_t GlbWriter::add_mesh(const ExportedMesh& mesh, std::span<const Vector3f> normals) {
  const std::size_t positions = add_vectors(single_precision(mesh.vertices), true);
  Json attributes = {{"POSITION", positions}};
  if (!normals.empty()) attributes["NORMAL"] = add_vectors(normals, false);
  attributes["COLOR_0"] = add_colours(*mesh.colours);
  const std::size_t indices = add_indices(*mesh.triangles);
  json_["meshes"].push_back(
      {{"name", mesh.name},
       {"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}});
  return json_["meshes"].size() - 1;
}

void GlbWriter::add_morph_target(std::size_t mesh, std::span<const Vector3f> displacements,
                                 std::span<const Vector3f> normal_differences) {
  const std::size_t positions = add_vectors(displacements, true);
  const std::size_t normals = add_vectors(normal_differences, false);
  Json& found = json_["meshes"][mesh];
  found["primitives"][0]["targets"].push_back({{"POSITION", positions}, {"NORMAL", normals}});
  found["weights"].push_back(0.0);
}

std::size_t GlbWriter::add_node(const std::string& name, std::size_t mesh) {
  const std::size_t node = json_["nodes"].size();
  json_["nodes"][0]["children"].push_back(node);
  json_["nodes"].push_back({{"name", name}, {"mesh", mesh}});
  return node;
}

void GlbWriter::place(std::size_t node, std::span<const float, 3> position,
                      std::span<const float, 4> orientation) {
  json_["nodes"][node]["translation"] = Json(position);
  json_["nodes"][node]["rotation"] = Json(orientation);
}

std::size_t GlbWriter::add_series(std::span<const float> values, const char* shape) {
  const std::size_t start = binary_.size();
  for (const float value : values) put(binary_, value);
  const std::size_t width = std::string_view(shape) == "VEC4"   ? 4
                            : std::string_view(shape) == "VEC3" ? 3
                                                                : 1;
  const std::size_t accessor =
      add_accessor(add_view(start, no_target), values.size() / width, float_type, shape);
  if (width == 1) {  // what times must have
    json_["accessors"].back()["min"] = {std::ranges::min(values)};
    json_["accessors"].back()["max"] = {std::ranges::max(values)};
  }
  return accessor;
}

std::size_t GlbWriter::add_fractions(std::span<const std::uint8_t> values) {
  const std::size_t start = binary_.size();
  binary_.insert(binary_.end(), values.begin(), values.end());
  const std::size_t accessor =
      add_accessor(add_view(start, no_target), values.size(), unsigned_byte_type, "SCALAR");
  json_["accessors"].back()["normalized"] = true;
  return accessor;
}

void GlbWriter::animate(std::size_t node, const char* path, std::size_t times, std::size_t values) {
  Json& animations = json_["animations"];
  if (animations.is_null()) animations.push_back({{"name", "run"}});
  Json& animation = animations[0];
  const std::size_t sampler = animation["samplers"].size();
  animation["samplers"].push_back(
      {{"input", times}, {"output", values}, {"interpolation", "LINEAR"}});
  animation["channels"].push_back(
      {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
}

Bytes GlbWriter::bytes() {
  json_["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  Bytes file;
  put(file, std::string("glTF"));
  put(file, std::uint32_t{2});
  put(file, size_32(header_chunk_end + 8 + text.size() + 8 + binary_.size()));
  put(file, size_32(text.size()));
  put(file, std::string("JSON"));
  put(file, text);
  put(file, size_32(binary_.size()));
  put(file, std::string("BIN\0", 4));
  file.insert(file.end(), binary_.begin(), binary_.end());
  return file;
}

/// Everything from `start` to the end of the binary part, which is then filled up to a multiple of
/// four bytes.
std::size_t GlbWriter::add_view(std::size_t start, int target) {
  Json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", binary_.size() - start}};
  if (target != no_target) view["target"] = target;
  json_["bufferViews"].push_back(std::move(view));
  binary_.resize((binary_.size() + 3) / 4 * 4);
  return json_["bufferViews"].size() - 1;
}

std::size_t GlbWriter::add_accessor(std::size_t view, std::size_t count, int type,
                                    const char* shape) {
  json_["accessors"].push_back(
      {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
  return json_["accessors"].size() - 1;
}

std::size_t GlbWriter::add_vectors(std::span<const Vector3f> vectors, bool with_bounds) {
  const std::size_t start = binary_.size();
  Vector3f low = vectors.front(), high = low;
  for (const Vector3f& v : vectors) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
    for (int axis = 0; axis < 3; ++axis) put(binary_, v[axis]);
  }
  const std::size_t accessor =
      add_accessor(add_view(start, vertex_target), vectors.size(), float_type, "VEC3");
  if (with_bounds) {
    json_["accessors"].back()["min"] = {low.x(), low.y(), low.z()};
    json_["accessors"].back()["max"] = {high.x(), high.y(), high.z()};
  }
  return accessor;
}

std::size_t GlbWriter::add_colours(const std::vector<render::Colour>& colours) {
  const std::size_t start = binary_.size();
  for (const render::Colour& colour : colours) {
    // Light, not sRGB.
    for (int channel = 0; channel < 3; ++channel) put(binary_, to_byte(to_light(colour[channel])));
    put(binary_, std::uint8_t{255});
  }
  const std::size_t accessor =
      add_accessor(add_view(start, vertex_target), colours.size(), unsigned_byte_type, "VEC4");
  json_["accessors"].back()["normalized"] = true;
  return accessor;
}

std::size_t GlbWriter::add_indices(const std::vector<sim::Triangle>& triangles) {
  const std::size_t start = binary_.size();
  for (const sim::Triangle& triangle : triangles) {
    for (const int v : triangle) put(binary_, static_cast<std::uint32_t>(v));
  }
  return add_accessor(add_view(start, index_target), 3 * triangles.size(), unsigned_int_type,
                      "SCALAR");
}

std::vector<Vector3f> single_precision(std::span<const sim::Vec3> vectors) {
  std::vector<Vector3f> result;
  for (const sim::Vec3& vector : vectors) result.emplace_back(vector.cast<float>());
  return result;
}

}  // namespace pneuma::app
