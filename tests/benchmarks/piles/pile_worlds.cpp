#include "benchmarks/piles/pile_worlds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "app/files/find_scene.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::benchmarks {
namespace {

sim::RigidBox cube(const sim::Vec3& position) {
  sim::RigidBox box;
  box.name = "cube";
  box.size = {2.0, 2.0, 2.0};
  box.position = position;
  box.rho_g = 0.0;
  box.surface = {0.1, 0.5};
  return box;
}

sim::World empty_world() {
  sim::World world;
  world.settings.ground = sim::ContactMaterial{0.1, 0.5};
  return world;
}

sim::World poured(int across, int high) {
  const double first = -1.9 * (across - 1);
  const std::string text = fmt::format(
      "[ground]\nrestitution = 0.1\nfriction = 0.5\n[[body]]\nkind = \"rigid\"\nsize = [2, 2, 2]\n"
      "restitution = 0.1\nfriction = 0.5\ncopies = [{0}, {0}, {1}]\nspacing = [3.8, 3.8, 3.8]\n"
      "jitter = 0.15\ntumble = true\nposition = [{2}, {2}, 3]\n",
      across, high, first);
  return app::build_world(scenes::parse_scene(text, "poured.toml"));
}

sim::World tower(int high) {
  sim::World world = empty_world();
  for (int i = 0; i < high; ++i) world.rigid.push_back(cube({0.0, 0.0, 1.0 + 2.0 * i}));
  return world;
}

sim::World pyramid(int rows) {
  sim::World world = empty_world();
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      world.rigid.push_back(cube({2.1 * i + 1.05 * row, 0.0, 1.0 + 2.0 * row}));
    }
  }
  return world;
}

/// A house of cards: in each storey pairs that lean against each other, and cards across them.
sim::World cards(int storeys) {
  sim::World world = empty_world();
  const sim::Vec3 size(0.1, 1.5, 2.0);
  const double angle = 25.0 / 180.0 * std::numbers::pi;
  const double half_width = 0.5 * (size.z() * std::sin(angle) + size.x() * std::cos(angle));
  const double height = size.z() * std::cos(angle) + size.x() * std::sin(angle);
  const auto card = [&](const sim::Vec3& position, double turn) {
    sim::RigidBox box = cube(position);
    box.name = "card";
    box.size = size;
    box.orientation = Eigen::AngleAxisd(turn, sim::Vec3::UnitY());
    box.surface.friction = 0.7;
    world.rigid.push_back(box);
  };
  world.settings.ground->friction = 0.7;
  const double gap = 0.006;
  const double pitch = 4.0 * half_width + gap;
  for (int storey = 0; storey < storeys; ++storey) {
    const double low = storey * (height + size.x() + 2.0 * gap);
    for (int i = 0; i < storeys - storey; ++i) {
      const double middle = pitch * (i + 0.5 * storey);
      card({middle - half_width, 0.0, low + 0.5 * height}, angle);
      card({middle + half_width, 0.0, low + 0.5 * height}, -angle);
      if (i == 0) continue;
      card({middle - 0.5 * pitch, 0.0, low + height + gap + 0.5 * size.x()},
           0.5 * std::numbers::pi);
    }
  }
  return world;
}

sim::World heavy_on_light() {
  sim::World world = tower(10);
  world.rigid.back().mass = 1000.0;
  return world;
}

sim::World cubes_on_torus() {
  return app::build_world(scenes::load_scene(app::find_scene("cubes_on_torus")));
}

struct Recipe {
  const char* name;
  double seconds;
  bool measures_top;
  sim::World (*make)();
};

constexpr Recipe recipes[] = {
    {"96 cubes poured", 12.0, false, [] { return poured(4, 6); }},
    {"1,000 cubes poured", 12.0, false, [] { return poured(10, 10); }},
    {"tower of 20", 60.0, true, [] { return tower(20); }},
    {"tower of 40", 60.0, true, [] { return tower(40); }},
    {"pyramid of 20 rows", 60.0, true, [] { return pyramid(20); }},
    {"house of cards", 20.0, true, [] { return cards(3); }},
    {"1000 kg on nine cubes", 20.0, true, heavy_on_light},
    {"cubes_on_torus", 12.0, false, cubes_on_torus},
};

}  // namespace

std::vector<PileWorld> make_pile_worlds(const std::vector<std::string>& names, bool short_runs) {
  std::vector<PileWorld> worlds;
  for (const std::string& name : names) {
    if (std::ranges::none_of(recipes, [&](const Recipe& recipe) { return recipe.name == name; })) {
      std::string known;
      for (const Recipe& recipe : recipes) known += fmt::format(" \"{}\"", recipe.name);
      throw std::invalid_argument(fmt::format("no world \"{}\"; there are:{}", name, known));
    }
  }
  for (const Recipe& recipe : recipes) {
    if (!names.empty() && std::ranges::find(names, recipe.name) == names.end()) continue;
    worlds.push_back(
        {recipe.name, recipe.make(), short_runs ? 1.0 : recipe.seconds, recipe.measures_top});
  }
  return worlds;
}

}  // namespace pneuma::benchmarks
