#include "app/world/model_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/host/interrupt.h"
#include "app/world/settled_volume.h"
#include "assets/load_model.h"
#include "scenes/loader/keys.h"
#include "sim/mesh/measure.h"
#include "sim/soft/equilibrium.h"
#include "sim/soft/gas_law.h"
#include "sim/soft/stability_limit.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

constexpr double extent = 6.0;               // m, of the longest side
constexpr double mass = 2.0;                 // kg
constexpr double stiffness = 4000.0;         // N/m
constexpr double ambient_pressure = 2000.0;  // Pa: the weight on a few m^2 changes V by a percent
/// Pa above it, of springs that hold it in shape. Springs at rest in the shape hold less: gas wants
/// thin walls to bend until the body is a ball.
constexpr double held_pressure = 100.0, free_pressure = 20.0;
constexpr double drop = 1.0;  // m

/// Meshes up to this are held in shape by tensions, which take the factors of a matrix to find,
/// and a few implicit steps to try.
constexpr int max_held_vertices = 20'000;
/// Volume at rest over that of the shape, within which tensions hold the shape in earnest.
constexpr double least_held = 0.95, most_held = 1.05;

/// Of the longest stable step: vertices that are pushed together are stiffer than small motions.
constexpr double safe_fraction = 0.7;
constexpr int frames_per_second = 30;
constexpr int least_steps_per_second = 240;
/// Beyond these, implicit steps are quicker.
constexpr int most_steps_per_second = 30'000, implicit_steps_per_second = 120;

struct Choice {
  sim::SoftBody body;
  bool held = false;  // rest = "equilibrium"
  double gauge_pressure = free_pressure;
  int steps_per_second = 0;
  bool implicit = false;
};

assets::CleanModel load(const fs::path& path, const assets::CleanOptions& options) {
  try {
    return assets::load_model(path, options);
  } catch (const assets::ModelError&) {
    throw_if_interrupted();  // Ctrl-C ends the importer first
    throw;
  }
}

/// Formats that say which way is up say y.
bool is_y_up(const fs::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".glb" || ending == ".gltf";
}

void fill(sim::SoftBody& body, double gauge) {
  sim::SoftMaterial& material = body.material;
  const double volume = sim::volume(body.mesh->topology, body.positions);
  material.ambient_pressure = ambient_pressure;
  material.n = (ambient_pressure + gauge) * volume / (sim::gas_constant * material.temperature);
}

/// Whether springs can hold the shape, with tensions that also keep it there.
bool hold(Choice& choice) {
  sim::SoftBody body = choice.body;
  const sim::MeshTopology& topology = body.mesh->topology;
  if (topology.vertex_count() > max_held_vertices) return false;
  fill(body, held_pressure);
  try {
    body.mesh = sim::make_soft_mesh(
        *body.mesh, sim::find_equilibrium(topology, body.positions, body.material).rest_lengths);
  } catch (const sim::EquilibriumError&) {
    return false;
  }
  const double start = sim::volume(body.mesh->topology, body.positions);
  const auto settled = settled_volume(body);
  if (!settled || *settled < least_held * start || *settled > most_held * start) return false;
  choice.body = body;
  choice.gauge_pressure = held_pressure;
  return true;
}

void choose_step(Choice& choice) {
  const double limit =
      safe_fraction * sim::settled_stability_limit(sim::Integrator::rk4, choice.body).step;
  const double frames = std::ceil(1.0 / (limit * frames_per_second));
  choice.implicit = !(frames * frames_per_second <= most_steps_per_second);
  choice.steps_per_second =
      choice.implicit
          ? implicit_steps_per_second
          : std::max(least_steps_per_second, frames_per_second * static_cast<int>(frames));
}

Choice choose(const sim::TriangleMesh& mesh) {
  Choice choice;
  sim::SoftBody& body = choice.body;
  body.mesh = sim::make_soft_mesh(mesh);
  body.positions = body.mesh->rest_positions;
  body.velocities = sim::VertexArray(body.positions.size());
  body.material.k = stiffness;
  body.material.k_max = 3.0 * stiffness;
  body.material.vertex_mass = mass / body.positions.size();
  fill(body, choice.gauge_pressure);
  choice.held = hold(choice);
  choose_step(choice);
  return choice;
}

/// As comments.
std::string repairs_text(const std::vector<std::string>& repaired) {
  std::string text;
  for (const std::string& done : repaired) text += fmt::format("# Repaired: {}\n", done);
  return text;
}

/// The keys that say how the file is read.
std::string choice_text(ModelChoice given) {
  std::string text;
  if (!given.component.empty()) {
    text += fmt::format("model.component = {}\n", scenes::value_text(&given.component));
  }
  if (given.repair) text += "model.repair = true\n";
  return text;
}

}  // namespace

std::string model_scene_text(const fs::path& path, const ModelChoice& given) {
  assets::CleanOptions options;
  options.component = given.component;
  options.repair = given.repair;
  if (is_y_up(path)) options.rotation = {90.0, 0.0, 0.0};
  const auto size_of = [](const assets::CleanModel& model) {
    return sim::bounds(sim::to_vertex_array(model.mesh.vertices)).size();
  };
  options.scale = extent / size_of(load(path, options)).maxCoeff();
  const assets::CleanModel model = load(path, options);
  const double height = size_of(model).z();
  const Choice choice = choose(model.mesh);
  const sim::SoftMaterial& material = choice.body.material;
  std::string file = fs::absolute(path).string();
  return fmt::format(
      R"(# Made from the model's mesh, to be kept and edited.
{}title = "A model falls"
duration = 6.0

[simulation]
integrator = "{}"
steps_per_second = {}    # for the masses and springs below
ambient_pressure = {}  # Pa: with it the gas resists a change of its volume

[camera]
eye = [{}, {}, {}]
target = [0.0, 0.0, {}]

[picture]
frames_per_second = {}

[[body]]
shape = "model"
model.file = {}
{}model.scale = {}  # the longest side is {} m
model.rotation = [{}, 0.0, 0.0]
position = [0.0, 0.0, {}]
k = {}
k_max = {}
vertex_mass = {}  # {} kg in all
gauge_pressure = {}
rest = "{}"
)",
      repairs_text(model.repaired), choice.implicit ? "implicit_euler" : "rk4",
      choice.steps_per_second, ambient_pressure, 1.5 * extent, -2.8 * extent, 1.2 * extent,
      0.5 * extent, frames_per_second, scenes::value_text(&file), choice_text(given), options.scale,
      extent, options.rotation.x(), 0.5 * height + drop, material.k, material.k_max,
      material.vertex_mass, mass, choice.gauge_pressure, choice.held ? "equilibrium" : "shape");
}

fs::path model_scene_file(const fs::path& model) {
  return fs::path(model.filename()).replace_extension(".toml");
}

}  // namespace pneuma::app
