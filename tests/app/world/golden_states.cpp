#include "tests/app/world/golden_states.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <algorithm>
#include <fstream>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "app/files/find_scene.h"
#include "app/record/world_json.h"
#include "app/world/build_world.h"
#include "scenes/loader/integrator_names.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view system_word = "system ";

/// By then bodies have met in nearly all scenes. Those of many small steps run for less, so that
/// all integrators together take seconds.
double seconds_of(const scenes::Scene& scene) {
  if (scene.settings.steps_per_second < 240) return 3.0;
  return scene.settings.steps_per_second == 240 ? 1.5 : 1.0;
}

double total_volume(const sim::World& world) {
  double sum = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    sum += sim::volume(body.mesh->topology, body.positions);
  }
  return sum;
}

/// `label`: what stands for the integrator.
GoldenState measure_state(const std::string& name, std::string_view label,
                          const std::string& override_text) {
  const std::vector<std::string> overrides = {override_text};
  const scenes::Scene scene = scenes::load_scene(find_scene(name), overrides);
  const auto steps = static_cast<std::int64_t>(seconds_of(scene) * scene.settings.steps_per_second);
  sim::World world = build_world(scene);
  sim::Stepper stepper(world);
  // A step that diverges leaves the world as it was before.
  while (world.steps < steps && !stepper.step(world)) {
  }
  return {.scene = name,
          .integrator = std::string(label),
          .steps = world.steps,
          .hash = sim::state_hash(world),
          .energy = sim::energy(world).total(),
          .volume = total_volume(world),
          .penetration = sim::max_penetration(world)};
}

GoldenState parse_state(const std::string& line) {
  std::istringstream words(line);
  GoldenState state;
  std::string hash, rest;
  words >> state.scene >> state.integrator >> state.steps >> hash >> state.energy >> state.volume >>
      state.penetration;
  std::size_t end = 0;
  if (words && hash.starts_with("0x")) state.hash = std::stoull(hash, &end, 16);
  if (!words || end != hash.size() || words >> rest) {
    throw std::runtime_error("expected: scene integrator steps 0xHASH energy volume penetration");
  }
  return state;
}

bool same_hashes(const std::vector<GoldenState>& a, const std::vector<GoldenState>& b) {
  return std::ranges::equal(a, b, [](const GoldenState& x, const GoldenState& y) {
    return x.scene == y.scene && x.integrator == y.integrator && x.steps == y.steps &&
           x.hash == y.hash;
  });
}

}  // namespace

std::string this_system() {
#ifdef __clang__
  const std::string compiler = fmt::format("clang++ {}", __clang_major__);
#else
  const std::string compiler = fmt::format("g++ {}", __GNUC__);
#endif
  return fmt::format("{}, glibc {}", compiler, gnu_get_libc_version());
}

std::vector<std::string> all_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(find_scene("one_sphere").parent_path())) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

std::vector<GoldenState> measure_states(const std::string& scene) {
  std::vector<GoldenState> states;
  for (const auto& [integrator, name] : scenes::integrator_names()) {
    states.push_back(measure_state(scene, name, fmt::format("simulation.integrator={}", name)));
  }
  return states;
}

std::vector<std::string> paper_method_scenes() {
  std::vector<std::string> names = all_scenes();
  std::erase_if(names, [](const std::string& name) {
    const scenes::Scene scene = scenes::load_scene(find_scene(name));
    const bool in_equilibrium = std::ranges::any_of(
        scene.bodies, [](const auto& body) { return body.rest == scenes::Rest::equilibrium; });
    return !scene.paper_fps || in_equilibrium;
  });
  return names;
}

std::vector<GoldenState> measure_paper_state(const std::string& scene) {
  return {measure_state(scene, "paper", "simulation.method=paper")};
}

std::vector<GoldenSection> read_golden_states(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(fmt::format("cannot read {}", path.string()));
  std::vector<GoldenSection> sections;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line.starts_with('#')) continue;
    try {
      if (line.starts_with(system_word)) {
        if (sections.empty() || !sections.back().states.empty()) sections.emplace_back();
        sections.back().systems.push_back(line.substr(system_word.size()));
      } else if (sections.empty()) {
        throw std::runtime_error("expected: system COMPILER, C LIBRARY");
      } else {
        sections.back().states.push_back(parse_state(line));
      }
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", path.string(), number, error.what()));
    }
  }
  return sections;
}

void write_golden_states(const std::vector<GoldenSection>& sections, std::ostream& out) {
  out << "# States of scenes under their integrators, written by scripts/golden-hashes.\n"
         "# Below a system, or several that come to the same:\n"
         "# scene  integrator  steps  state hash  energy, J  volume, m^3  penetration, m\n";
  for (const GoldenSection& section : sections) {
    out << '\n';
    for (const std::string& system : section.systems) out << system_word << system << '\n';
    for (const GoldenState& s : section.states) {
      out << fmt::format("{:30} {:16} {:4} {} {:13.8g} {:11.7g} {:.3g}\n", s.scene, s.integrator,
                         s.steps, hex(s.hash), s.energy, s.volume, s.penetration);
    }
  }
}

const GoldenSection* section_of(const std::vector<GoldenSection>& sections,
                                const std::string& system) {
  for (const GoldenSection& section : sections) {
    if (std::ranges::find(section.systems, system) != section.systems.end()) return &section;
  }
  return nullptr;
}

void record_states(const std::string& system, const std::vector<GoldenState>& states,
                   std::vector<GoldenSection>& sections) {
  for (GoldenSection& section : sections) std::erase(section.systems, system);
  std::erase_if(sections, [](const GoldenSection& section) { return section.systems.empty(); });
  for (GoldenSection& section : sections) {
    if (!same_hashes(section.states, states)) continue;
    section.systems.push_back(system);
    return;
  }
  sections.push_back({{system}, states});
}

}  // namespace pneuma::app
