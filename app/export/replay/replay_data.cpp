#include "app/export/replay/replay_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <utility>

#include "app/export/replay/quantise.h"
#include "app/host/errors.h"
#include "app/host/version.h"
#include "app/record/vector_json.h"
#include "render/frame/camera.h"
#include "render/passes/look.h"
#include "render/passes/shader_sources.h"

namespace pneuma::app {
namespace {

using render::Vec3f;

static_assert(std::endian::native == std::endian::little, "the page's numbers are little-endian");

/// Series of numbers, one after the other, and where each of them is.
class Streams {
 public:
  template <class Value>
  void add(const std::string& name, const char* kind, std::span<const Value> values,
           std::size_t count) {
    directory_[name] = {{"kind", kind}, {"offset", bytes_.size()}, {"count", count}};
    const std::size_t begin = bytes_.size();
    // Every series begins where any kind of number may.
    bytes_.resize((begin + values.size_bytes() + 3) / 4 * 4);
    if (!values.empty()) std::memcpy(bytes_.data() + begin, values.data(), values.size_bytes());
  }
  void add(const std::string& name, const std::vector<std::uint8_t>& values) {
    add<std::uint8_t>(name, "u8", values, values.size());
  }
  void add(const std::string& name, const std::vector<std::uint16_t>& values) {
    add<std::uint16_t>(name, "u16", values, values.size());
  }
  void add(const std::string& name, const std::vector<std::uint32_t>& values) {
    add<std::uint32_t>(name, "u32", values, values.size());
  }
  void add(const std::string& name, const std::vector<float>& values) {
    add<float>(name, "f32", values, values.size());
  }
  void add_differences(const std::string& name, const std::vector<std::uint16_t>& values,
                       std::size_t columns, Foretold foretold) {
    const char* kind = foretold == Foretold::by_line ? "differences_by_line" : "differences_by_row";
    add<std::uint8_t>(name, kind, differences(values, columns, foretold), values.size());
    directory_[name]["columns"] = columns;
  }

  Json& directory() { return directory_; }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  Json directory_ = Json::object();
  std::vector<std::uint8_t> bytes_;
};

/// Contacts may lie a little outside of the bodies.
Lattice lattice_of(const Recording& recording) {
  render::Box box;
  for (const RecordedFrame& frame : recording.frames) {
    for (const Vec3f& position : frame.positions) box.grow(position);
    for (const render::Point& point : frame.particles) box.grow(point.position);
    for (const render::Point& point : frame.contacts) box.grow(point.position);
  }
  return lattice_over(box.min, box.max);
}

void add_quantised(const Lattice& lattice, const Vec3f& point, std::vector<std::uint16_t>& values) {
  for (int axis = 0; axis < 3; ++axis) values.push_back(lattice.nearest(point[axis], axis));
}

void add_positions(const Recording& recording, const Lattice& lattice, Streams& streams) {
  std::vector<std::uint16_t> values;
  for (const RecordedFrame& frame : recording.frames) {
    for (const Vec3f& position : frame.positions) add_quantised(lattice, position, values);
  }
  streams.add_differences("positions", values, 3 * recording.frames.front().positions.size(),
                          Foretold::by_line);
}

/// Finer steps would not be seen, and make the page of many bodies that touch larger.
constexpr float share_steps = 31.0f;

/// One vertex after the other, as most of them keep theirs; rounded down, so that what does not
/// cross is not drawn crossing.
void add_shares(const Recording& recording, Streams& streams) {
  std::vector<std::uint8_t> values;
  for (std::size_t v = 0; v < recording.frames.front().shares.size(); ++v) {
    for (const RecordedFrame& frame : recording.frames) {
      values.push_back(static_cast<std::uint8_t>(share_steps * frame.shares[v]));
    }
  }
  streams.add("shares", values);
}

/// Colours and sizes of discs, of which there are few.
class Looks {
 public:
  std::uint8_t of(const render::Point& point) {
    const Json look = {{"colour", vector_json<Json>(point.colour)}, {"diameter", point.diameter}};
    const auto known = std::ranges::find(looks_, look);
    const auto number = known - looks_.begin();
    if (known == looks_.end()) looks_.push_back(look);
    return static_cast<std::uint8_t>(number);
  }
  const std::vector<Json>& all() const { return looks_; }

 private:
  std::vector<Json> looks_;
};

void add_points(const std::string& name, const Recording& recording,
                const std::vector<render::Point> RecordedFrame::*points, const Lattice& lattice,
                Looks& looks, Streams& streams) {
  std::vector<std::uint32_t> counts;
  std::vector<std::uint16_t> places;
  std::vector<std::uint8_t> point_looks;
  for (const RecordedFrame& frame : recording.frames) {
    counts.push_back(static_cast<std::uint32_t>((frame.*points).size()));
    for (const render::Point& point : frame.*points) {
      add_quantised(lattice, point.position, places);
      point_looks.push_back(looks.of(point));
    }
  }
  streams.add(name + "_counts", counts);
  streams.add_differences(name + "_places", places, 3, Foretold::by_row);
  streams.add(name + "_looks", point_looks);
}

/// From a contact's point, in 127ths of a metre: lines of 1 m, which need no more.
void add_normals(const Recording& recording, Streams& streams) {
  std::vector<std::uint8_t> values;
  for (const RecordedFrame& frame : recording.frames) {
    for (const render::Line& line : frame.normals) {
      const Vec3f along = line.to - line.from;
      for (int axis = 0; axis < 3; ++axis) {
        const float rounded = std::round(std::clamp(along[axis], -1.0f, 1.0f) * 127.0f);
        values.push_back(static_cast<std::uint8_t>(static_cast<std::int8_t>(rounded)));
      }
    }
  }
  streams.add("contacts_normals", values);
}

void add_shape(const std::string& name, const render::MeshShape& shape, Streams& streams) {
  std::vector<std::uint32_t> triangles, edges;
  std::vector<std::uint8_t> colours;
  for (const auto& triangle : shape.triangles) {
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  }
  for (const auto& edge : shape.edges) edges.insert(edges.end(), edge.begin(), edge.end());
  for (const render::Colour& colour : shape.colours) {
    for (int channel = 0; channel < 3; ++channel) {
      colours.push_back(static_cast<std::uint8_t>(std::lround(colour[channel] * 255.0f)));
    }
  }
  std::vector<std::uint32_t> corner_normals;
  for (const auto& t : shape.corner_normals) {
    corner_normals.insert(corner_normals.end(), t.begin(), t.end());
  }
  streams.add(name + "_triangles", triangles);
  if (!corner_normals.empty()) streams.add(name + "_corner_normals", corner_normals);
  streams.add(name + "_edges", edges);
  streams.add(name + "_colours", colours);
}

/// Copies of one body have one shape.
Json meshes_json(const Recording& recording, Streams& streams) {
  std::map<const render::MeshShape*, std::string> names;
  Json meshes = Json::array();
  for (const render::Mesh& mesh : recording.first.meshes) {
    const auto [known, is_new] =
        names.emplace(mesh.shape.get(), fmt::format("shape{}", names.size()));
    if (is_new) add_shape(known->second, *mesh.shape, streams);
    meshes.push_back({{"shape", known->second},
                      {"vertices", mesh.positions.size()},
                      {"roughness", mesh.roughness},
                      {"smooth", !mesh.normals.empty()},
                      {"has_corner_normals", !mesh.shape->corner_normals.empty()},
                      {"rounded", !mesh.room.empty()}});
  }
  return meshes;
}

/// Eye and target of each frame, unless the camera stays where it is.
void add_cameras(const Recording& recording, Streams& streams) {
  const auto place = [](const RecordedFrame& frame) {
    return std::pair(frame.camera.eye, frame.camera.target);
  };
  std::vector<float> values;
  if (!std::ranges::all_of(recording.frames, [&](const RecordedFrame& frame) {
        return place(frame) == place(recording.frames.front());
      })) {
    for (const RecordedFrame& frame : recording.frames) {
      for (const Vec3f& point : {frame.camera.eye, frame.camera.target}) {
        values.insert(values.end(), point.begin(), point.end());
      }
    }
  }
  streams.add("cameras", values);
}

using Number = std::function<double(const RecordedFrame&)>;

/// What is plotted over time: a plot, and its lines.
Json plots_json(const Recording& recording, Streams& streams) {
  const sim::Energy start = recording.frames.front().energy;
  Json plots = Json::array();
  const auto line = [&](const std::string& name, const Number& number) {
    std::vector<float> values;
    for (const RecordedFrame& frame : recording.frames) {
      values.push_back(static_cast<float>(number(frame)));
    }
    const std::string stream = fmt::format("plot{}", streams.directory().size());
    streams.add(stream, values);
    plots.back()["lines"].push_back({{"name", name}, {"stream", stream}});
  };
  using Frame = RecordedFrame;
  plots.push_back({{"title", "energy since the first frame"}, {"unit", "J"}});
  line("total", [=](const Frame& f) { return f.energy.total() - start.total(); });
  line("kinetic", [=](const Frame& f) { return f.energy.kinetic - start.kinetic; });
  line("springs", [=](const Frame& f) { return f.energy.spring - start.spring; });
  line("gas", [=](const Frame& f) { return f.energy.gas - start.gas; });
  line("gravity", [=](const Frame& f) { return f.energy.gravity - start.gravity; });
  plots.push_back({{"title", "volume of the soft bodies"}, {"unit", "m\u00b3"}});
  line("volume", [](const Frame& f) { return f.volume; });
  plots.push_back({{"title", "max. penetration"}, {"unit", "m"}});
  line("penetration", [](const Frame& f) { return f.penetration; });
  plots.push_back({{"title", "contacts"}, {"unit", ""}});
  line("contacts", [](const Frame& f) { return static_cast<double>(f.contacts.size()); });
  return plots;
}

Json shaders_json() {
  const auto pair = [](const render::ShaderSources& sources) {
    return Json{{"vertex", sources.vertex}, {"fragment", sources.fragment}};
  };
  return {{"look", render::look_source()},
          {"nearness", render::nearness_source()},
          {"surface", pair(render::surface_shaders())},
          {"outline", render::outline_vertex_source()},
          {"ground", pair(render::ground_shaders())},
          {"ground_shadow", pair(render::ground_shadow_shaders())},
          {"disc", pair(render::disc_shaders())},
          {"line", pair(render::line_shaders())}};
}

Json scenery_json(const Recording& recording) {
  const render::Frame& first = recording.first;
  const auto& ground = first.ground;
  return {{"eye", vector_json<Json>(first.camera.eye)},
          {"target", vector_json<Json>(first.camera.target)},
          {"field_of_view", first.camera.field_of_view},
          {"aspect", recording.aspect},
          {"light", vector_json<Json>(first.light.direction)},
          {"softness", first.light.softness},
          {"shadows", first.light.shadows},
          {"between_bodies", first.light.between_bodies},
          {"grid_spacing", ground ? Json(ground->grid_spacing) : Json()}};
}

}  // namespace

void check_replay_size(std::int64_t vertices, std::int64_t frames) {
  const std::int64_t max_frames = static_cast<std::int64_t>(max_replay_bytes) / (6 * vertices);
  if (frames <= max_frames) return;
  throw UsageError(fmt::format(
      "--format html: {} frames of {} vertices are too much for one page; choose up to {} of them "
      "with --frames, or fewer a second with --set picture.frames_per_second=N",
      frames, vertices, max_frames));
}

ReplayData replay_data(const Recording& recording, std::size_t allowed_bytes) {
  const Lattice lattice = lattice_of(recording);
  Streams streams;
  Looks looks;
  ReplayData data;
  Json& header = data.header;
  header = {{"name", recording.name},
            {"title", recording.title},
            {"program", "pneuma " + version().program},
            {"frames", recording.frames.size()},
            {"first_frame", recording.first_frame},
            {"frames_per_second", recording.frames_per_second},
            {"steps_per_frame", recording.steps_per_frame},
            {"lattice",
             {{"origin", vector_json<Json>(lattice.origin)},
              {"step", lattice.step},
              {"extent", lattice.extent},
              {"max_error", 0.5 * lattice.step}}},
            {"share_steps", share_steps},
            {"scenery", scenery_json(recording)},
            {"shaders", shaders_json()},
            {"meshes", meshes_json(recording, streams)}};
  add_positions(recording, lattice, streams);
  add_shares(recording, streams);
  add_cameras(recording, streams);
  add_points("particles", recording, &RecordedFrame::particles, lattice, looks, streams);
  add_points("contacts", recording, &RecordedFrame::contacts, lattice, looks, streams);
  add_normals(recording, streams);
  header["plots"] = plots_json(recording, streams);
  header["looks"] = looks.all();
  header["streams"] = std::move(streams.directory());
  data.bytes = std::move(streams.bytes());
  if (data.bytes.size() > allowed_bytes) {
    throw UsageError(fmt::format(
        "--format html: {} frames with their contacts and particles have {} bytes; allowed on one "
        "page are {}; choose fewer frames with --frames, or fewer a second with --set "
        "picture.frames_per_second=N",
        recording.frames.size(), data.bytes.size(), allowed_bytes));
  }
  return data;
}

}  // namespace pneuma::app
