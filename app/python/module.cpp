// The Python module: names, overrides, arrays and exceptions; what they do is in scripted_world.h.
//
// Arrays of the state (positions, velocities) are copies, because the stepper exchanges the memory
// of a body with its own from step to step: a view would show another step than the one it was
// taken in. Arrays of what never changes (triangles) are read-only views that keep their mesh
// alive.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/scene_catalogue.h"
#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/host/version.h"
#include "app/python/scripted_world.h"
#include "app/record/contact_tally.h"
#include "app/record/world_json.h"
#include "assets/model.h"
#include "render/context/context.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "sim/base/file.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/crossings.h"
#include "sim/mesh/measure.h"

namespace py = pybind11;
using namespace pneuma;

namespace {

/// A world that one thread at a time may use.
struct PyWorld {
  PyWorld(const std::string& scene, const std::vector<std::string>& overrides, int threads)
      : scripted(scene, overrides, threads) {}

  app::ScriptedWorld scripted;
  std::mutex in_use;
};
using WorldPointer = std::shared_ptr<PyWorld>;

/// Of a state that another thread is about to change nothing can be read.
std::unique_lock<std::mutex> use(PyWorld& world) {
  std::unique_lock lock(world.in_use, std::try_to_lock);
  if (!lock) throw std::runtime_error("another thread steps or draws this world");
  return lock;
}

/// A body stays reachable as long as somebody holds it: it holds its world.
struct PySoftBody {
  WorldPointer world;
  std::size_t index;

  const sim::SoftBody& body() const { return world->scripted.world().soft[index]; }
};
struct PyRigidBox {
  WorldPointer world;
  std::size_t index;

  const sim::RigidBox& box() const { return world->scripted.world().rigid[index]; }
};

std::string type_name(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

bool is_text(const py::handle& value) { return py::isinstance<py::str>(value); }

bool is_mapping(const py::handle& value) { return py::hasattr(value, "items"); }

/// Of what has an order.
bool is_sequence(const py::handle& value) {
  return !is_text(value) && !is_mapping(value) && !py::isinstance<py::bytes>(value) &&
         py::hasattr(value, "__getitem__");
}

[[noreturn]] void refuse_set(const std::string& what) {
  throw py::type_error(fmt::format(
      "set: expected a dict, such as {{\"body.k\": 200}}, or a list of \"PATH=VALUE\", such as "
      "[\"body.k=200\"], got {}",
      what));
}

[[noreturn]] void refuse_value(const std::string& path, const py::handle& value) {
  throw py::type_error(
      fmt::format("set: {}: expected a number, a bool, a str, a path, or a list, tuple or array of "
                  "these, got {}",
                  path, type_name(value)));
}

/// As TOML.
std::string toml_text(const std::string& path, const py::handle& value) {
  if (is_text(value)) return nlohmann::json(value.cast<std::string>()).dump();
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  // Of numpy's arrays and scalars: the same as Python's own.
  if (py::hasattr(value, "tolist")) return toml_text(path, value.attr("tolist")());
  if (py::hasattr(value, "__fspath__")) return toml_text(path, value.attr("__fspath__")());
  if (is_sequence(value)) {
    std::vector<std::string> items;
    for (const py::handle& item : value) items.push_back(toml_text(path, item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  if (py::hasattr(value, "__index__")) return py::str(value.attr("__index__")());
  if (py::hasattr(value, "__float__")) return py::repr(value.attr("__float__")());
  refuse_value(path, value);
}

std::string key_text(const py::handle& key) {
  if (!is_text(key) && !py::hasattr(key, "__index__")) {
    refuse_set(fmt::format("a dict with a key of type {}", type_name(key)));
  }
  return py::str(key);
}

void add_overrides(const std::string& table, const py::handle& values,
                   std::vector<std::string>& overrides) {
  for (const py::handle& item : values.attr("items")()) {
    const auto [key, value] = item.cast<std::pair<py::object, py::object>>();
    const std::string path = table + key_text(key);
    if (is_mapping(value)) {
      add_overrides(path + '.', value, overrides);
    } else {
      overrides.push_back(fmt::format(
          "{}={}", path, is_text(value) ? value.cast<std::string>() : toml_text(path, value)));
    }
  }
}

/// The texts "PATH=VALUE" of a dict of values, also with dicts in it for tables, or of a list of
/// such texts; none of None. Values are numbers, bools, texts, paths, and sequences of these; with
/// numpy's arrays and scalars. A text is what may stand behind the = of --set. Throws
/// py::type_error.
std::vector<std::string> set_argument(const py::object& given) {
  std::vector<std::string> overrides;
  if (given.is_none()) return overrides;
  if (is_mapping(given)) {
    add_overrides("", given, overrides);
    return overrides;
  }
  if (!is_sequence(given)) {
    refuse_set(is_text(given) ? std::string(py::repr(given)) : type_name(given));
  }
  for (const py::handle& item : given) {
    if (!is_text(item))
      refuse_set(fmt::format("a {} with an item of type {}", type_name(given), type_name(item)));
    overrides.push_back(item.cast<std::string>());
  }
  return overrides;
}

/// As rows x y z.
py::array_t<double> copied(const sim::VertexArray& values) {
  py::array_t<double> rows({py::ssize_t{values.size()}, py::ssize_t{3}});
  auto to = rows.mutable_unchecked<2>();
  for (int v = 0; v < values.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) to(v, axis) = values[v][axis];
  }
  return rows;
}

py::array_t<double> copied(const sim::Vec3& vector) {
  return py::array_t<double>(3, vector.data());
}

py::array_t<int> triangles_of(const PySoftBody& soft) {
  using Mesh = std::shared_ptr<const sim::SoftMesh>;
  const auto* mesh = new Mesh(soft.body().mesh);
  const py::capsule owner(mesh, [](void* held) { delete static_cast<Mesh*>(held); });
  const std::vector<sim::Triangle>& triangles = (*mesh)->topology.triangles();
  static_assert(sizeof(sim::Triangle) == 3 * sizeof(int));
  py::array_t<int> view({static_cast<py::ssize_t>(triangles.size()), py::ssize_t{3}},
                        triangles.empty() ? nullptr : triangles[0].data(), owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// Steps without Python's lock, and looks about ten times a second whether Ctrl-C was pressed.
void step(PyWorld& world, std::int64_t count) {
  constexpr double seconds_between_looks = 0.1;
  if (count < 0) throw py::value_error(fmt::format("{} steps: steps go forward only", count));
  const auto lock = use(world);
  while (count > 0) {
    {
      const py::gil_scoped_release released;
      const auto start = app::Clock::now();
      for (; count > 0 && app::seconds_since(start) < seconds_between_looks; --count) {
        world.scripted.step();
      }
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

py::array_t<std::uint8_t> draw(PyWorld& world, std::optional<int> width, std::optional<int> height,
                               bool wireframe, bool contacts) {
  const auto lock = use(world);
  auto image = std::make_unique<render::Image>();
  {
    const py::gil_scoped_release released;
    *image = world.scripted.draw({width, height}, {.wireframe = wireframe, .contacts = contacts});
  }
  const std::array<py::ssize_t, 3> shape = {image->height, image->width, 3};
  auto* pixels = image.get();
  const py::capsule owner(image.release(),
                          [](void* held) { delete static_cast<render::Image*>(held); });
  return py::array_t<std::uint8_t>(shape, pixels->pixels.data(), owner);
}

py::dict energies(PyWorld& world) {
  const auto lock = use(world);
  const sim::Energy energy = sim::energy(world.scripted.world());
  py::dict result;
  result["kinetic"] = energy.kinetic;
  result["spring"] = energy.spring;
  result["gas"] = energy.gas;
  result["gravity"] = energy.gravity;
  result["total"] = energy.total();
  return result;
}

std::string side_name(const sim::World& world, const sim::ContactSide& side) {
  const auto body = static_cast<std::size_t>(side.body);
  if (side.kind == sim::SideKind::soft) return world.soft[body].name;
  return side.kind == sim::SideKind::rigid ? world.rigid[body].name : "the ground";
}

/// A dict of arrays, one row for each contact of the last step.
py::dict contacts(PyWorld& held) {
  const auto lock = use(held);
  const auto found = held.scripted.contacts();
  const auto count = static_cast<py::ssize_t>(found.size());
  py::array_t<double> points({count, py::ssize_t{3}}), normals({count, py::ssize_t{3}}),
      depths(count);
  py::list kinds, bodies;
  for (py::ssize_t c = 0; c < count; ++c) {
    const sim::Contact& contact = found[static_cast<std::size_t>(c)];
    for (int axis = 0; axis < 3; ++axis) {
      points.mutable_at(c, axis) = contact.point[axis];
      normals.mutable_at(c, axis) = contact.normal[axis];
    }
    depths.mutable_at(c) = contact.depth;
    const sim::World& world = held.scripted.world();
    kinds.append(py::str(std::string(sim::to_string(app::kind_of(contact)))));
    bodies.append(
        py::make_tuple(side_name(world, contact.first), side_name(world, contact.second)));
  }
  py::dict result;
  result["kind"] = kinds;
  result["bodies"] = bodies;
  result["point"] = points;
  result["normal"] = normals;
  result["depth"] = depths;
  return result;
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// What no step changes, so that it can be printed at any time.
std::string described(const PyWorld& held) {
  const sim::World& world = held.scripted.world();
  return fmt::format("<pneuma.World '{}': {}, {}, {} steps per second>", held.scripted.scene().name,
                     counted(world.soft.size(), "soft body", "soft bodies"),
                     counted(world.rigid.size(), "rigid box", "rigid boxes"),
                     world.settings.steps_per_second);
}

std::string described(const PySoftBody& soft) {
  const sim::MeshTopology& topology = soft.body().mesh->topology;
  return fmt::format("<pneuma.SoftBody '{}': {} vertices, {} triangles>", soft.body().name,
                     topology.vertex_count(), topology.triangle_count());
}

std::string described(const PyRigidBox& rigid) {
  const sim::RigidBox& box = rigid.box();
  return fmt::format("<pneuma.RigidBox '{}': {:g} x {:g} x {:g} m>", box.name, box.size.x(),
                     box.size.y(), box.size.z());
}

/// What a member of the module reads of a world, under its lock.
template <class Read>
auto reads(const Read& read) {
  return [read](PyWorld& world) {
    const auto lock = use(world);
    return read(world.scripted);
  };
}

std::string kind_of(const PyWorld& world, std::size_t body) {
  return scenes::kind_name(scenes::body_of(world.scripted.scene(), static_cast<int>(body)).kind);
}

constexpr const char* kind_help =
    "As the scene's key: \"soft\", \"rigid\", \"static\" or \"moved\"";

template <class Held, class Read>
auto reads_of(const Read& read) {
  return [read](const Held& held) {
    const auto lock = use(*held.world);
    return read(held);
  };
}

/// What all exceptions of the module derive from; never thrown itself.
struct AnyError : std::exception {};

void define_errors(py::module_& module) {
  const py::exception<AnyError> error(module, "Error", PyExc_RuntimeError);
  py::register_exception<scenes::SceneError>(module, "SceneError", error);
  py::register_exception<assets::ModelError>(module, "ModelError", error);
  py::register_exception<app::UsageError>(module, "UsageError", error);
  py::register_exception<app::DivergenceError>(module, "DivergenceError", error);
  py::register_exception<render::GlError>(module, "GlError", error);
  py::register_exception<base::IoError>(module, "IoError", error);
}

void define_bodies(py::module_& module) {
  using app::ScriptedWorld;
  py::class_<PySoftBody>(module, "SoftBody",
                         "A body with a mesh of its own, in its present state: a soft one, or one "
                         "that is static or moved.")
      .def("__repr__", [](const PySoftBody& soft) { return described(soft); })
      .def_property_readonly("name", [](const PySoftBody& soft) { return soft.body().name; })
      .def_property_readonly(
          "kind", [](const PySoftBody& soft) { return kind_of(*soft.world, soft.index); },
          kind_help)
      .def_property_readonly("positions", reads_of<PySoftBody>([](const PySoftBody& soft) {
                               return copied(soft.body().positions);
                             }),
                             "Vertices x 3, m: a copy of the present state")
      .def_property_readonly("velocities", reads_of<PySoftBody>([](const PySoftBody& soft) {
                               return copied(soft.body().velocities);
                             }),
                             "Vertices x 3, m/s: a copy of the present state")
      .def_property_readonly("triangles", triangles_of,
                             "Triangles x 3 indices of vertices, outward: a view, read-only")
      .def_property_readonly("volume", reads_of<PySoftBody>([](const PySoftBody& soft) {
                               return sim::volume(soft.body().mesh->topology,
                                                  soft.body().positions);
                             }),
                             "m^3");
  py::class_<PyRigidBox>(module, "RigidBox",
                         "A box of a world, in its present state: a rigid one, or one that is "
                         "static or moved.")
      .def("__repr__", [](const PyRigidBox& rigid) { return described(rigid); })
      .def_property_readonly("name", [](const PyRigidBox& rigid) { return rigid.box().name; })
      .def_property_readonly(
          "kind",
          [](const PyRigidBox& rigid) {
            const std::size_t soft = rigid.world->scripted.world().soft.size();
            return kind_of(*rigid.world, soft + rigid.index);
          },
          kind_help)
      .def_property_readonly(
          "size", [](const PyRigidBox& rigid) { return copied(rigid.box().size); },
          "Full lengths along its own axes, m")
      .def_property_readonly("position", reads_of<PyRigidBox>([](const PyRigidBox& rigid) {
                               return copied(rigid.box().position);
                             }),
                             "Of its centre, m: a copy")
      .def_property_readonly("velocity", reads_of<PyRigidBox>([](const PyRigidBox& rigid) {
                               return copied(rigid.box().velocity);
                             }),
                             "m/s: a copy")
      .def_property_readonly("angular_velocity", reads_of<PyRigidBox>([](const PyRigidBox& rigid) {
                               return copied(rigid.box().angular_velocity);
                             }),
                             "rad/s: a copy")
      .def_property_readonly("orientation", reads_of<PyRigidBox>([](const PyRigidBox& rigid) {
                               const Eigen::Quaterniond& q = rigid.box().orientation;
                               const std::array<double, 4> wxyz = {q.w(), q.x(), q.y(), q.z()};
                               return py::array_t<double>(4, wxyz.data());
                             }),
                             "Unit quaternion w x y z, body to world: a copy");
}

template <class Held, class Bodies>
std::vector<Held> held(const WorldPointer& world, const Bodies& bodies) {
  std::vector<Held> all;
  for (std::size_t i = 0; i < bodies.size(); ++i) all.push_back({world, i});
  return all;
}

py::bytes save(PyWorld& world) {
  const auto lock = use(world);
  const auto state = sim::save_state(world.scripted.world());
  return {reinterpret_cast<const char*>(state.data()), state.size()};
}

void define_world(py::module_& module) {
  using app::ScriptedWorld;
  py::class_<PyWorld, WorldPointer>(module, "World", "The world of a scene; pneuma.load makes it.")
      .def("__repr__", [](const PyWorld& world) { return described(world); })
      .def("step", step, py::arg("count") = 1, "Advance by so many steps.")
      .def(
          "draw", draw, py::arg("width") = py::none(), py::arg("height") = py::none(),
          py::arg("wireframe") = false, py::arg("contacts") = false,
          "A picture of the present state: height x width x 3, uint8, as `pneuma render` makes it.")
      .def("state", save, "The state as bytes: equal states, equal bytes.")
      .def_property_readonly(
          "time", reads([](const ScriptedWorld& world) { return sim::time(world.world()); }), "s")
      .def_property_readonly("steps",
                             reads([](const ScriptedWorld& world) { return world.world().steps; }),
                             "Done so far")
      .def_property_readonly(
          "steps_per_second",
          [](const PyWorld& world) { return world.scripted.world().settings.steps_per_second; })
      .def_property_readonly(
          "scene_toml",
          [](const PyWorld& world) { return scenes::print_scene(world.scripted.scene()); },
          "The effective scene")
      .def_property_readonly("warnings",
                             reads([](ScriptedWorld& world) { return world.warnings(); }))
      .def_property_readonly(
          "soft",
          [](const WorldPointer& world) {
            return held<PySoftBody>(world, world->scripted.world().soft);
          },
          "The bodies with a mesh of their own, in the order of the scene: soft ones, and those of "
          "kind \"static\" or \"moved\" but boxes")
      .def_property_readonly(
          "rigid",
          [](const WorldPointer& world) {
            return held<PyRigidBox>(world, world->scripted.world().rigid);
          },
          "The boxes, in the order of the scene: rigid ones, and those of kind \"static\" or "
          "\"moved\"")
      .def_property_readonly("energies", energies, "J: kinetic, spring, gas, gravity, total")
      .def_property_readonly("contacts", contacts,
                             "Of the last step: lists kind and bodies, arrays point, normal, depth")
      .def_property_readonly("penetration", reads([](const ScriptedWorld& world) {
                               return sim::max_penetration(world.world());
                             }),
                             "The deepest of any body in another or in the ground, m")
      .def_property_readonly("crossings", reads([](const ScriptedWorld& world) {
                               return sim::crossings(world.world()).between_bodies;
                             }),
                             "Edges that pass through another body's surface")
      .def_property_readonly("state_hash", reads([](const ScriptedWorld& world) {
                               return app::hex(sim::state_hash(world.world()));
                             }),
                             "As in run.json and `pneuma check --run --json`");
}

}  // namespace

PYBIND11_MODULE(pneuma, module) {
  module.doc() = "Soft bodies held up by gas pressure: load a scene, step it, read it, draw it.";
  module.attr("__version__") = app::version().program;
  define_errors(module);
  define_bodies(module);
  define_world(module);
  module.def(
      "load",
      [](const std::filesystem::path& scene, const py::object& overrides, int threads) {
        return std::make_shared<PyWorld>(scene.string(), set_argument(overrides), threads);
      },
      py::arg("scene"), py::arg("set") = py::none(), py::arg("threads") = 1,
      "The world of a scene: a file, the name of one, or a model. `set`: a dict, such as "
      "{\"body.k\": 200, \"simulation\": {\"gravity\": (0, 0, -1.62)}}, or a list of "
      "\"PATH=VALUE\" "
      "as for `pneuma --set`. Results do not depend on `threads`.");
  module.def(
      "scenes",
      [] {
        std::vector<std::string> names;
        for (const auto& info : app::scene_catalogue()) names.push_back(info.name);
        return names;
      },
      "The names of the scenes that `pneuma list` shows.");
}
