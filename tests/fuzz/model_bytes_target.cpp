#include <array>
#include <stdexcept>

#include "assets/model_file.h"
#include "assets/serialise_model.h"
#include "tests/fuzz/targets.h"

namespace pneuma::fuzz {
namespace {

using assets::Format;

void try_headers(std::string_view bytes) {
  constexpr std::array<Format, 9> formats = {Format::obj,  Format::ply,  Format::stl,
                                             Format::off,  Format::gltf, Format::glb,
                                             Format::a3ds, Format::dae,  Format::fbx};
  constexpr std::size_t most = 1000;
  for (const Format format : formats) {
    try {
      assets::check_model_header(format, bytes, most, most);
    } catch (const assets::ModelError&) {
    }
  }
}

/// What is taken apart is put together as the same bytes; but for what follows the last name, which
/// is lost.
void try_answer(std::string_view bytes) {
  std::string again;
  try {
    again = assets::serialise(assets::deserialise(bytes));
  } catch (const assets::ModelError&) {
    return;
  }
  if (!bytes.starts_with(again)) throw std::logic_error("serialised otherwise than before");
}

}  // namespace

void try_model_bytes(std::string_view bytes) {
  try_headers(bytes);
  try_answer(bytes);
}

}  // namespace pneuma::fuzz
