#include "app/world/model_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/host/interrupt.h"
#include "app/record/shape_deviation.h"
#include "app/world/settled_volume.h"
#include "assets/load_model.h"
#include "assets/model_file.h"
#include "scenes/loader/keys.h"
#include "scenes/loader/text_checks.h"
#include "sim/equilibrium/held_shape.h"
#include "sim/mesh/measure.h"
#include "sim/soft/gas_law.h"
#include "sim/soft/stability_limit.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

constexpr double extent = 6.0;               // m, of the longest side
constexpr double mass = 5.0;                 // kg
constexpr double stiffness = 4000.0;         // N/m
constexpr double ambient_pressure = 2000.0;  // Pa: the weight on a few m^2 changes V by a percent
/// Pa above it, of springs that hold it in shape. Springs at rest in the shape hold less: gas wants
/// thin walls to bend until the body is a ball.
constexpr double held_pressure = 100.0, free_pressure = 20.0;
constexpr double drop = 1.0;  // m
/// Of the speed in 1/60 s: it falls nearly as in empty space, and what rocks comes to rest within
/// the run.
constexpr double drag = 0.02;
/// rad/s: what would stand on a point until rounding tips it, late in the run, falls over at once,
/// and all else lands as it was modelled.
constexpr const char* slow_turn = "[0.05, 0.03, 0.0]";

/// Meshes up to this are held in shape by tensions, if these keep it: they take the factors of a
/// matrix to find, and a few implicit steps to try.
constexpr int max_held_vertices = 5'000;
/// Of the diagonal, by which gas may bend a shape that tensions hold.
constexpr double max_deviation = 0.03;
/// Below, springs along the edges hold what there is of faces. Above, runs would be too long.
constexpr int min_bending_vertices = 50, max_bending_vertices = 100'000;

/// Finer meshes come to rest no later, but take longer: s.
constexpr int long_run_vertices = 3'000;
constexpr double duration = 20.0, short_duration = 10.0;

/// Of the longest stable step: vertices that are pushed together are stiffer than small motions.
constexpr double safe_fraction = 0.7;
/// Of coarse meshes, which have no hinges: they collapse further, and gas in less room is stiffer.
constexpr double safe_fraction_of_coarse = 0.4;
/// A step of it is as long as one of velocity_verlet, and takes half the time.
constexpr sim::Integrator integrator = sim::Integrator::symplectic_euler;
constexpr int frames_per_second = 30;
constexpr int least_steps_per_second = 240;
/// Beyond these, implicit steps are quicker.
constexpr int most_steps_per_second = 60'000, implicit_steps_per_second = 120;

struct Choice {
  sim::SoftBody body;
  bool held = false;  // rest = "equilibrium"
  double gauge_pressure = free_pressure;
  int steps_per_second = 0;
  bool implicit = false;
};

assets::CleanModel read_model(const fs::path& path, const assets::CleanOptions& options,
                              std::size_t most_bytes) {
  try {
    return assets::load_model(path, options, most_bytes);
  } catch (const assets::ModelError&) {
    throw_if_interrupted();  // Ctrl-C ends the importer first
    throw;
  }
}

/// The refusal to simplify is what matters where there are too many vertices without it.
assets::CleanModel unsimplified_model(const fs::path& path, assets::CleanOptions options,
                                      std::size_t most_bytes,
                                      const assets::SimplifyError& refusal) {
  options.simplify_to.reset();
  try {
    return read_model(path, options, most_bytes);
  } catch (const assets::ModelError&) {
    throw refusal;
  }
}

void fill(sim::SoftBody& body, double gauge) {
  sim::SoftMaterial& material = body.material;
  const double volume = sim::volume(body.mesh->topology, body.positions);
  material.ambient_pressure = ambient_pressure;
  material.n = (ambient_pressure + gauge) * volume / (sim::gas_constant * material.temperature);
}

/// Whether gas leaves the shape nearly as it is, the body being alone and without weight.
bool keeps_shape(const sim::SoftBody& body) {
  const auto settled = settled_body(body);
  return settled && shape_deviation(*settled) <= max_deviation;
}

/// Whether springs can hold the shape, with tensions that also keep it there.
bool hold(Choice& choice) {
  sim::SoftBody body = choice.body;
  fill(body, held_pressure);
  try {
    body.mesh = sim::held_mesh(*body.mesh, body.positions, body.material);
  } catch (const sim::EquilibriumError&) {
    return false;
  }
  if (!keeps_shape(body)) return false;
  choice.body = body;
  choice.gauge_pressure = held_pressure;
  return true;
}

/// The fastest motion of the hinges over that of the springs: so slow, they cost no step. Walls of
/// many triangles may fold until some lose their height, where hinges are stiffer than at rest.
double hinge_speed(int vertices) {
  constexpr double coarse = 0.5, fine = 0.4, coarse_vertices = 1'500.0;
  return std::clamp(coarse * coarse_vertices / vertices, fine, coarse);
}

void stiffen(sim::SoftBody& body) {
  body.mesh = sim::with_hinges(*body.mesh);
  sim::SoftMaterial hinges = body.material;
  hinges.k = hinges.n = hinges.rho_g = 0.0;
  hinges.bending = 1.0;
  const auto step = [&](const sim::SoftMaterial& material) {
    return sim::stability_limit(integrator, *body.mesh, material, body.positions).step;
  };
  const double ratio = step(hinges) / step(body.material);
  if (std::isfinite(ratio))
    body.material.bending = std::pow(hinge_speed(body.positions.size()) * ratio, 2);
}

/// What keeps the shape: tensions, or less pressure; and bending stiffness against its weight.
void choose_hold(Choice& choice) {
  const int count = choice.body.positions.size();
  if (count <= max_held_vertices) choice.held = hold(choice);
  if (count >= min_bending_vertices && count <= max_bending_vertices) stiffen(choice.body);
}

void choose_step(Choice& choice) {
  const bool is_coarse = choice.body.positions.size() < min_bending_vertices;
  const double fraction = is_coarse ? safe_fraction_of_coarse : safe_fraction;
  const double limit = fraction * sim::settled_stability_limit(integrator, choice.body).step;
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
  body.material.rho_g = drag;
  body.material.vertex_mass = mass / body.positions.size();
  fill(body, choice.gauge_pressure);
  choose_hold(choice);
  choose_step(choice);
  return choice;
}

/// As comments.
std::string repairs_text(const std::vector<std::string>& repaired) {
  std::string text;
  for (const std::string& done : repaired) text += fmt::format("# Repaired: {}\n", done);
  return text;
}

std::string bending_text(const sim::SoftMaterial& material) {
  if (material.bending == 0.0) return "";
  return fmt::format("bending = {:.4g}  # N m: springs alone hold neither flat nor concave faces\n",
                     material.bending);
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

/// The key, where it changes the mesh or was asked for.
std::string vertices_text(const assets::CleanModel& model, const ModelChoice& given) {
  if (given.vertices) return fmt::format("model.vertices = {}\n", *given.vertices);
  if (model.simplified.empty()) return "";
  return fmt::format("model.vertices = {}  # {}; --vertices N takes others\n", most_chosen_vertices,
                     model.simplified);
}

/// What the file is called, as far as a body may be called so.
std::string body_name(const fs::path& model) {
  constexpr std::size_t longest = 40;
  const auto is_refused = [](char c) {
    return !scenes::check_body_name(std::string("a") + c).empty();
  };
  std::string name = model.stem().string().substr(0, longest);
  std::ranges::replace_if(name, is_refused, '_');
  return scenes::check_body_name(name).empty() ? name : "model_" + name;
}

}  // namespace

sim::Vec3 rotation_of_up(std::string_view axis) {
  if (axis == "x") return {0.0, -90.0, 0.0};
  if (axis == "y") return {90.0, 0.0, 0.0};
  return sim::Vec3::Zero();
}

sim::Vec3 model_rotation(const fs::path& model, const ModelChoice& choice) {
  return choice.rotation ? *choice.rotation : rotation_of_up(assets::up_axis(model));
}

assets::CleanModel chosen_model(const fs::path& path, const ModelChoice& choice,
                                assets::CleanOptions placing) {
  placing.component = choice.component;
  placing.repair = choice.repair;
  placing.simplify_to = choice.vertices.value_or(most_chosen_vertices);
  placing.most_vertices = choice.most_vertices;
  try {
    return read_model(path, placing, choice.most_bytes);
  } catch (const assets::SimplifyError& error) {
    if (choice.vertices) throw;
    return unsimplified_model(path, placing, choice.most_bytes, error);
  }
}

std::string model_scene_text(const fs::path& path, const ModelChoice& given) {
  assets::CleanOptions options;
  options.rotation = model_rotation(path, given);
  assets::CleanModel model = chosen_model(path, given, options);
  const sim::Vec3 size = sim::bounds(sim::to_vertex_array(model.mesh.vertices)).size();
  const double scale = extent / size.maxCoeff(), height = scale * size.z();
  for (sim::Vec3& vertex : model.mesh.vertices) vertex *= scale;
  const Choice choice = choose(model.mesh);
  const sim::SoftMaterial& material = choice.body.material;
  std::string file = fs::absolute(path).string();
  const std::string name = body_name(path);
  return fmt::format(
      R"(# Made from the model's mesh, to be kept and edited.
{}title = "{} falls"
duration = {}

[simulation]
integrator = "{}"
steps_per_second = {}    # for the masses and springs below
ambient_pressure = {}  # Pa: with it the gas resists a change of its volume

[picture]
frames_per_second = {}

[[body]]
name = "{}"
shape = "model"
model.file = {}
{}{}model.scale = {}  # the longest side is {} m
model.rotation = {}
position = [0.0, 0.0, {}]
angular_velocity = {}  # rad/s: so that it does not stand on a point
k = {}
k_max = {}
vertex_mass = {}  # {} kg in all, whatever the mesh
rho_g = {}  # so that what rocks comes to rest
{}gauge_pressure = {}
rest = "{}"
)",
      repairs_text(model.repaired), name,
      choice.body.positions.size() > long_run_vertices ? short_duration : duration,
      choice.implicit ? "implicit_euler" : "symplectic_euler", choice.steps_per_second,
      ambient_pressure, frames_per_second, name, scenes::value_text(&file), choice_text(given),
      vertices_text(model, given), scale, extent, scenes::value_text(&options.rotation),
      0.5 * height + drop, slow_turn, material.k, material.k_max, material.vertex_mass, mass,
      material.rho_g, bending_text(material), choice.gauge_pressure,
      choice.held ? "equilibrium" : "shape");
}

fs::path model_scene_file(const fs::path& model) {
  return fs::path(model.filename()).replace_extension(".toml");
}

}  // namespace pneuma::app
