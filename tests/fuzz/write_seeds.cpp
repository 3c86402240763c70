// Writes what the fuzzers start from:  write_seeds FOLDER
// into FOLDER/scene, FOLDER/mesh, FOLDER/model_bytes (a file per seed) and FOLDER/scene.dict.
#include <fmt/format.h>

#include <filesystem>

#include "tests/fuzz/seeds.h"
#include "tests/support/temporary_folder.h"

namespace {

void write_seeds(const std::filesystem::path& folder, const std::vector<std::string>& seeds) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    pneuma::write_text(folder / fmt::format("seed_{:02}", i), seeds[i]);
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    fmt::print(stderr, "write_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  write_seeds(folder / "scene", pneuma::fuzz::scene_seeds());
  write_seeds(folder / "mesh", pneuma::fuzz::mesh_seeds());
  write_seeds(folder / "model_bytes", pneuma::fuzz::model_byte_seeds());
  pneuma::write_text(folder / "scene.dict", pneuma::fuzz::scene_dictionary());
  return 0;
}
