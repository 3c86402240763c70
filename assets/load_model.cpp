#include "assets/load_model.h"

#include <fmt/format.h>

#include <algorithm>

namespace pneuma::assets {
namespace {

// A closed surface has two triangles per vertex, each with three corners of its own where a file
// shares none; and there may be components that are left out.
constexpr std::size_t raw_per_welded = 8;
/// Of what is simplified: two million vertices, whose triangles share none. What may be left of
/// them is CleanOptions::most_vertices.
constexpr std::size_t most_to_simplify = 12'000'000;

}  // namespace

CleanModel load_model(const std::filesystem::path& path, const CleanOptions& options,
                      std::size_t most_bytes) {
  ImportLimits limits;
  limits.bytes = most_bytes;
  std::size_t most = sim::at(options.most_vertices) * raw_per_welded;
  if (options.simplify_to) most = std::max(most, most_to_simplify);
  limits.vertices = std::max(limits.vertices, most);
  limits.triangles = std::max(limits.triangles, most);
  const Model model = import_model(path, limits);
  try {
    return clean_mesh(model, options);
  } catch (const SimplifyError& error) {
    throw SimplifyError(fmt::format("{}: {}", path.string(), error.what()));
  } catch (const ModelError& error) {
    throw ModelError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace pneuma::assets
