#include "app/export/vtk_series.h"

#include <fmt/format.h>

#include "app/export/sink/bytes.h"
#include "sim/base/file.h"
#include "sim/mesh/primitives.h"

namespace pneuma::app {
namespace {

constexpr const char* file_begin =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";

std::string xml_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

/// `attributes`: its type, name and so on. The bytes follow their number.
std::string data_array(const std::string& attributes, const Bytes& values) {
  Bytes counted;
  put(counted, static_cast<std::uint64_t>(values.size()));
  counted.insert(counted.end(), values.begin(), values.end());
  return fmt::format("<DataArray {} format=\"binary\">{}</DataArray>\n", attributes,
                     base64(counted));
}

/// Of every vertex, in the order of MeshExporter::meshes.
std::vector<sim::Vec3> velocities(const sim::World& world) {
  std::vector<sim::Vec3> result;
  for (const sim::SoftBody& body : world.soft) {
    for (int v = 0; v < body.velocities.size(); ++v) result.emplace_back(body.velocities[v]);
  }
  for (const sim::RigidBox& box : world.rigid) {
    for (const sim::Vec3& corner : sim::make_box(box.size, 1).vertices) {
      result.push_back(box.velocity + box.angular_velocity.cross(box.orientation * corner));
    }
  }
  return result;
}

void put_vector(Bytes& bytes, const sim::Vec3& vector) {
  for (int axis = 0; axis < 3; ++axis) put(bytes, vector[axis]);
}

/// The bodies of one frame as arrays, all of them as one mesh.
struct Arrays {
  explicit Arrays(const std::vector<ExportedMesh>& meshes) {
    for (const ExportedMesh& mesh : meshes) add(mesh);
  }

  void add(const ExportedMesh& mesh) {
    for (const auto& triangle : *mesh.triangles) {
      for (const int v : triangle) put(connectivity, vertices + v);
      put(offsets, 3 * ++triangles);
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      put_vector(points, mesh.vertices[v]);
      put(body, bodies);
      for (int channel = 0; channel < 3; ++channel) {
        put(colour, to_byte((*mesh.colours)[v][channel]));
      }
    }
    vertices += static_cast<std::int64_t>(mesh.vertices.size());
    ++bodies;
  }

  Bytes points, body, colour, connectivity, offsets;
  std::int64_t vertices = 0, triangles = 0;
  std::int32_t bodies = 0;
};

std::string poly_data(const sim::World& world, const std::vector<ExportedMesh>& meshes) {
  const Arrays arrays(meshes);
  Bytes velocity, time;
  for (const sim::Vec3& v : velocities(world)) put_vector(velocity, v);
  put(time, sim::time(world));
  std::string text = fmt::format(fmt::runtime(file_begin), "PolyData");
  text += "<PolyData>\n<FieldData>\n";
  text += data_array("type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\"", time);
  text += "</FieldData>\n";
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n", arrays.vertices,
                      arrays.triangles);
  text += "<PointData Vectors=\"velocity\" Scalars=\"colour\">\n";
  text += data_array("type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\"", velocity);
  text += data_array("type=\"Int32\" Name=\"body\"", arrays.body);
  text += data_array("type=\"UInt8\" Name=\"colour\" NumberOfComponents=\"3\"", arrays.colour);
  text += "</PointData>\n<Points>\n";
  text += data_array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", arrays.points);
  text += "</Points>\n<Polys>\n";
  text += data_array("type=\"Int64\" Name=\"connectivity\"", arrays.connectivity);
  text += data_array("type=\"Int64\" Name=\"offsets\"", arrays.offsets);
  text += "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return text;
}

void write_text_file(const std::filesystem::path& file, const std::string& text) {
  base::write_file_atomically(file.string(),
                              {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

VtkSeries::VtkSeries(const ExportJob& job)
    : exporter_(job.scene, job.start), folder_(job.folder), name_(job.scene.name) {}

void VtkSeries::add(const Simulation& simulation) {
  const sim::World& world = simulation.world();
  const std::string file = fmt::format("{}_{:05}.vtp", name_, simulation.frame());
  write_text_file(folder_ / file, poly_data(world, exporter_.meshes(world)));
  entries_ += fmt::format("<DataSet timestep=\"{:.17g}\" file=\"{}\"/>\n", sim::time(world),
                          xml_text(file));
}

std::filesystem::path VtkSeries::finish() {
  const std::filesystem::path file = folder_ / (name_ + ".pvd");
  write_text_file(file, fmt::format(fmt::runtime(file_begin), "Collection") + "<Collection>\n" +
                            entries_ + "</Collection>\n</VTKFile>\n");
  return file;
}

}  // namespace pneuma::app
