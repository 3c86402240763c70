#include "sim/collision/overlapping_pair.h"

#include <algorithm>

#include "sim/collision/point_in_body.h"
#include "sim/mesh/measure.h"

namespace pneuma::sim {
namespace {

/// Fraction of the smaller body's piece of the line.
constexpr double min_overlap_fraction = 0.25;

/// Along the line, m. `smaller`: the shorter of the two pieces.
double deep_overlap(double smaller, double skin_thickness) {
  return std::clamp(2.0 * skin_thickness, min_overlap_fraction * smaller, smaller);
}

/// How far the line from the centre in the given direction (unit) lies inside the body, m. None if
/// the centre does not.
std::optional<double> extent(const SoftBody& body, const Vec3& centre, const Vec3& direction,
                             OverlappingPairScratch& scratch) {
  const Vec3 across = direction.unitOrthogonal();
  Mat3 view;
  view << across.transpose(), direction.cross(across).transpose(), direction.transpose();
  if (scratch.seen.size() < body.positions.size()) {
    scratch.seen = VertexArray(body.positions.size());
  }
  for (int v = 0; v < body.positions.size(); ++v) {
    scratch.seen[v] = view * (body.positions[v] - centre);
  }
  return height_of_exit({body.mesh->topology, scratch.seen}, Vec3::Zero());
}

}  // namespace

bool has_filled_centre(const SoftMesh& mesh) {
  return is_inside({mesh.topology, mesh.rest_positions}, mean(mesh.rest_positions));
}

double overlap_reach(double first_radius, double second_radius, double skin_thickness,
                     bool is_depenetrating) {
  const double both = first_radius + second_radius;
  if (is_depenetrating) return both + skin_thickness;
  return both - std::min(2.0 * skin_thickness, std::min(first_radius, second_radius));
}

std::optional<OverlappingPair> find_overlapping_pair(const World& world, int first, int second,
                                                     bool is_depenetrating,
                                                     OverlappingPairScratch& scratch) {
  const SoftBody& a = world.soft[at(first)];
  const SoftBody& b = world.soft[at(second)];
  const Vec3 centre_a = mean(a.positions), centre_b = mean(b.positions);
  const Vec3 between = centre_b - centre_a;
  const double distance = between.norm();
  const Vec3 line = distance > 0.0 ? Vec3(between / distance) : Vec3::UnitX();
  const auto of_a = extent(a, centre_a, line, scratch);
  if (!of_a) return {};
  const auto of_b = extent(b, centre_b, -line, scratch);
  if (!of_b) return {};
  const double skin = world.settings.skin_thickness;
  const double min_overlap = is_depenetrating ? -skin : deep_overlap(std::min(*of_a, *of_b), skin);
  if (!(*of_a + *of_b - distance > min_overlap)) return {};
  return OverlappingPair{first, second, between, *of_a + *of_b + skin};
}

}  // namespace pneuma::sim
