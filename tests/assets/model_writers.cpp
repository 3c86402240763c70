#include "tests/assets/model_writers.h"

#include <fmt/format.h>

#include <cstdint>

#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"

namespace pneuma::assets {
namespace {

using sim::at;
using sim::TriangleMesh;
using sim::Vec3;

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);  // little endian, as x86 is
}

void put_position(std::string& bytes, const Vec3& v) {
  for (const double x : v) put(bytes, static_cast<float>(x));
}

std::string position_text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string ply_header(const TriangleMesh& mesh, const char* format) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.vertices.size(), mesh.triangles.size());
}

/// A chunk of a 3DS file: a number, its length with this head, what it holds.
std::string chunk(std::uint16_t number, const std::string& content) {
  std::string bytes;
  put(bytes, number);
  put(bytes, static_cast<std::uint32_t>(content.size() + 6));
  return bytes + content;
}

std::string gltf_json(const TriangleMesh& mesh, const std::string& uri) {
  Vec3 low = mesh.vertices[0], high = mesh.vertices[0];
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const std::size_t positions = mesh.vertices.size() * 12, indices = mesh.triangles.size() * 12;
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"name":"thing"}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3",)"
      R"("min":[{},{},{}],"max":[{},{},{}]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{{}"byteLength":{}}}]}})",
      mesh.vertices.size(), low.x(), low.y(), low.z(), high.x(), high.y(), high.z(),
      3 * mesh.triangles.size(), positions, positions, indices, uri, positions + indices);
}

}  // namespace

std::string obj_text(const TriangleMesh& mesh) {
  std::string text = "o thing\n";
  for (const Vec3& v : mesh.vertices) text += "v " + position_text(v) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

std::string ply_text(const TriangleMesh& mesh) {
  std::string text = ply_header(mesh, "ascii");
  for (const Vec3& v : mesh.vertices) text += position_text(v) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::string ply_bytes(const TriangleMesh& mesh) {
  std::string bytes = ply_header(mesh, "binary_little_endian");
  for (const Vec3& v : mesh.vertices) put_position(bytes, v);
  for (const auto& triangle : mesh.triangles) {
    put(bytes, std::uint8_t{3});
    for (const int v : triangle) put(bytes, v);
  }
  return bytes;
}

std::string stl_text(const TriangleMesh& mesh) {
  std::string text = "solid thing\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int v : triangle) text += "vertex " + position_text(mesh.vertices[at(v)]) + '\n';
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid thing\n";
}

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    put_position(bytes, Vec3::Zero());
    for (const int v : triangle) put_position(bytes, mesh.vertices[at(v)]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string off_text(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) text += position_text(v) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::string a3ds_bytes(const TriangleMesh& mesh) {
  std::string vertices, faces;
  put(vertices, static_cast<std::uint16_t>(mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) put_position(vertices, v);
  put(faces, static_cast<std::uint16_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) put(faces, static_cast<std::uint16_t>(v));
    put(faces, std::uint16_t{7});  // all three sides are seen
  }
  const std::string name("thing\0", 6);
  const std::string object =
      chunk(0x4000, name + chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces)));
  return chunk(0x4d4d, chunk(0x3d3d, object));
}

std::string dae_text(const TriangleMesh& mesh) {
  std::string positions, indices;
  for (const Vec3& v : mesh.vertices) positions += position_text(v) + ' ';
  for (const auto& [a, b, c] : mesh.triangles) indices += fmt::format("{} {} {} ", a, b, c);
  return fmt::format(
      R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g" name="thing"><mesh>
<source id="p"><float_array id="pa" count="{0}">{1}</float_array>
<technique_common><accessor source="#pa" count="{2}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{3}"><input semantic="VERTEX" source="#v" offset="0"/><p>{4}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="thing">
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)",
      3 * mesh.vertices.size(), positions, mesh.vertices.size(), mesh.triangles.size(), indices);
}

std::string fbx_text(const TriangleMesh& mesh) {
  std::string positions, indices;
  for (const Vec3& v : mesh.vertices) {
    positions += fmt::format("{}{},{},{}", positions.empty() ? "" : ",", v.x(), v.y(), v.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) {  // the last of a polygon is stored as its negative
    indices += fmt::format("{}{},{},{}", indices.empty() ? "" : ",", a, b, -c - 1);
  }
  return fmt::format(
      R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {{
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}}
GlobalSettings:  {{
	Version: 1000
}}
Definitions:  {{
	Version: 100
	Count: 0
}}
Objects:  {{
	Geometry: 1000, "Geometry::thing", "Mesh" {{
		Vertices: *{} {{
			a: {}
		}}
		PolygonVertexIndex: *{} {{
			a: {}
		}}
		GeometryVersion: 124
	}}
	Model: 2000, "Model::thing", "Mesh" {{
		Version: 232
	}}
}}
Connections:  {{
	C: "OO",2000,0
	C: "OO",1000,2000
}}
)",
      3 * mesh.vertices.size(), positions, 3 * mesh.triangles.size(), indices);
}

std::string gltf_buffer(const TriangleMesh& mesh) {
  std::string bytes;
  for (const Vec3& v : mesh.vertices) put_position(bytes, v);
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) put(bytes, v);
  }
  return bytes;
}

std::string gltf_text(const TriangleMesh& mesh, const std::string& buffer) {
  return gltf_json(mesh, fmt::format(R"("uri":"{}",)", buffer));
}

std::string glb_bytes(const TriangleMesh& mesh) {
  std::string json = gltf_json(mesh, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltf_buffer(mesh);
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

TriangleMesh cube() { return sim::make_box({2.0, 2.0, 2.0}, 1); }

TriangleMesh cube_of_24() {
  const TriangleMesh shared = cube();
  TriangleMesh mesh;
  // Each vertex has a copy per axis, for the faces that look along that axis.
  for (int axis = 0; axis < 3; ++axis) {
    mesh.vertices.insert(mesh.vertices.end(), shared.vertices.begin(), shared.vertices.end());
  }
  for (sim::Triangle triangle : shared.triangles) {
    const auto& [a, b, c] = triangle;
    const auto& v = shared.vertices;
    int axis = 0;
    (v[at(b)] - v[at(a)]).cross(v[at(c)] - v[at(a)]).cwiseAbs().maxCoeff(&axis);
    for (int& corner : triangle) corner += 8 * axis;
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

TriangleMesh crooked_box() {
  TriangleMesh mesh = sim::make_box({1.0, 2.0, 3.0}, 2);
  for (Vec3& v : mesh.vertices) {
    if (v.x() > 0.0 && v.y() > 0.0 && v.z() > 0.0) v += Vec3(0.75, 0.5, 0.125);
    if (v.x() > 0.0 && v.y() < 0.0) v += Vec3(0.25, 0.0, 0.0);
  }
  return mesh;
}

TriangleMesh both(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (sim::Triangle triangle : b.triangles) {
    for (int& v : triangle) v += static_cast<int>(a.vertices.size());
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double by) {
  for (Vec3& v : mesh.vertices) v *= by;
  return mesh;
}

double enclosed_volume(const sim::TriangleMesh& mesh) {
  const auto soft = sim::make_soft_mesh(mesh);
  return sim::volume(soft->topology, soft->rest_positions);
}

}  // namespace pneuma::assets
