// Writes the cat's meshes:  make_cat FOLDER
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "assets/cat/cat_mesh.h"

namespace {

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_cat FOLDER\n");
    return 2;
  }
  try {
    for (const pneuma::assets::CatSize& size : pneuma::assets::cat_sizes) {
      const auto mesh = pneuma::assets::make_cat(size.edge_length);
      write(std::string(argv[1]) + '/' + size.file, pneuma::assets::write_ply(mesh));
      std::fprintf(stderr, "%s: %zu vertices\n", size.file, mesh.vertices.size());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_cat: %s\n", error.what());
    return 6;
  }
  return 0;
}
