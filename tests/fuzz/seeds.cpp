#include "tests/fuzz/seeds.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "assets/serialise_model.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "scenes/loader/sections.h"
#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/fuzz/triangle_soup.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::fuzz {
namespace {

std::string with_overrides(std::string text, const std::vector<std::string>& overrides) {
  for (const std::string& override : overrides) text.append(1, '\0').append(override);
  return text;
}

/// A tetrahedron: the least closed surface.
sim::TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

sim::TriangleMesh half_turned(sim::TriangleMesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  return mesh;
}

}  // namespace

std::vector<std::string> scene_seeds() {
  std::vector<std::string> seeds = {
      "[[body]]\n", with_overrides("[[body]]\nname = \"ball\"\n[[body]]\nkind = \"rigid\"\n",
                                   {"body.k=200", "ball.k=3.5", "body.2.mass=1e-3",
                                    "simulation.particles.max_sweeps=5", "camera.eye=[1, 2, 3]",
                                    "camera.target=[0, 0, 0]", "title=words"})};
  for (const scenes::SceneInfo& info : scenes::list_scenes(project_folder() / "scenes")) {
    seeds.push_back(read_text(info.path));
    seeds.push_back(scenes::print_scene(scenes::load_scene(info.path)));
  }
  return seeds;
}

std::vector<std::string> mesh_seeds() {
  using namespace assets;
  const std::vector<sim::TriangleMesh> meshes = {
      tetrahedron(),
      cube(),
      cube_of_24(),
      crooked_box(),
      half_turned(cube()),
      sim::make_sphere(6.0, 4, 5),
      sim::make_torus(8.0, 3.0, 4, 4),
      sim::make_icosphere(9.0, 1),
      sim::make_box({6.0, 4.0, 2.0}, 2),
      both(cube(), moved(cube(), {5.0, 0.0, 0.0})),
      both(cube(), moved(cube(), {2.0, 2.0, 0.0})),         // share an edge
      both(cube(), moved(cube(), {2.0, 2.0, 2.0})),         // share a vertex
      both(cube(), moved(scaled(cube(), 2.0), {1, 1, 1})),  // run through each other
      both(scaled(cube(), 4.0), cube()),                    // one within the other
      scaled(cube(), 0.125)};
  std::vector<std::string> seeds;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    TriangleSoup soup = soup_of(meshes[i]);
    seeds.push_back(encode(soup));
    soup.options = static_cast<Byte>(37 * (i + 1));
    seeds.push_back(encode(soup));
  }
  return seeds;
}

std::vector<std::string> model_byte_seeds() {
  using namespace assets;
  const sim::TriangleMesh mesh = cube();
  return {obj_text(mesh),
          ply_text(mesh),
          ply_bytes(mesh),
          stl_text(mesh),
          stl_bytes(mesh),
          off_text(mesh),
          a3ds_bytes(mesh),
          dae_text(mesh),
          fbx_text(mesh),
          glb_bytes(mesh),
          gltf_text(mesh, "it.bin"),
          serialise({mesh, std::vector<int>(mesh.triangles.size(), 1), {"left", "right"}})};
}

std::string scene_dictionary() {
  scenes::Scene scene;
  scenes::BodyScene body;
  std::vector<scenes::Section> sections = scenes::fixed_sections(scene);
  sections.push_back(scenes::body_section(body));
  std::set<std::string> words = {"[[body]]", "[",    "]",     "{",     "}", " = ", "true",
                                 "false",    "#",    "\\\\u", "\\\"",  "'", "1e",  "nan",
                                 "inf",      "0x7f", "_",     "\\x00", ".", ",",   "\\x0a"};
  for (const scenes::Section& section : sections) {
    words.insert(fmt::format("[{}]", section.table));
    for (const scenes::Key& key : section.keys) {
      words.insert(std::string(key.name));
      const auto* word = std::get_if<scenes::Word>(&key.slot);
      if (word == nullptr) continue;
      for (const std::string_view value : word->words)
        words.insert(fmt::format("\\\"{}\\\"", value));
    }
  }
  std::string text;
  for (const std::string& word : words) text += fmt::format("\"{}\"\n", word);
  return text;
}

}  // namespace pneuma::fuzz
