#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "sim/mesh/soft_mesh.h"
#include "tests/fuzz/surface_promises.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/triangle_soup.h"

namespace pneuma::fuzz {
namespace {

using assets::CleanModel;
using assets::CleanOptions;

[[noreturn]] void fail(const std::string& what) { throw std::logic_error(what); }

void check_place(const CleanModel& model, const CleanOptions& options) {
  sim::Bounds box;
  for (const sim::Vec3& vertex : model.mesh.vertices) box.include(vertex);
  const double extent = box.size().norm();
  constexpr double turned = 2.0;  // the box of a turned mesh may be larger, or smaller, than before
  if (!(extent >= assets::smallest_model / turned && extent <= assets::largest_model * turned)) {
    fail(fmt::format("{} m across", extent));
  }
  // Half a unit in the last place of what is subtracted, which is not larger than the largest model
  // of 1e30 units of the file: the middle is as exact as the file's numbers are.
  const double from_origin = box.centre().cwiseAbs().maxCoeff();
  if (options.centre && !(from_origin <= 1e-6 * extent)) {
    fail(fmt::format("{} m from its origin, {} m across", from_origin, extent));
  }
}

void check_numbers(const CleanModel& model, const CleanOptions& options) {
  const assets::Component& kept = model.components.at(sim::at(model.kept));
  if (sim::at(kept.vertices) != model.mesh.vertices.size() ||
      sim::at(kept.triangles) != model.mesh.triangles.size() || !kept.closed()) {
    fail("the kept component is not the one described");
  }
  if (kept.vertices > options.most_vertices) fail("more vertices than the limit");
  if (model.vertices_welded > model.vertices_before) fail("more vertices after welding");
}

std::optional<CleanModel> try_clean(const assets::Model& model, const CleanOptions& options) {
  CleanModel cleaned;
  try {
    cleaned = assets::clean_mesh(model, options);
  } catch (const assets::ModelError&) {
    return {};
  }
  const std::string broken = broken_promise(cleaned.mesh);
  if (!broken.empty()) fail(broken);
  check_place(cleaned, options);
  check_numbers(cleaned, options);
  sim::make_soft_mesh(cleaned.mesh);  // throws when the mesh is not fit for it
  return cleaned;
}

}  // namespace

void try_mesh(std::string_view bytes) {
  const TriangleSoup soup = decode(bytes);
  const assets::Model model = model_of(soup);
  CleanOptions options = clean_options_of(soup);
  const auto as_it_is = try_clean(model, options);
  options.repair = true;
  const auto repaired = try_clean(model, options);
  // Of several components others may become fit, and then one must be named.
  if (!as_it_is || as_it_is->components.size() > 1) return;
  if (!repaired || repaired->mesh.vertices != as_it_is->mesh.vertices ||
      repaired->mesh.triangles != as_it_is->mesh.triangles) {
    fail("a repair of what needs none");
  }
}

}  // namespace pneuma::fuzz
