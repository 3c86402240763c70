#include "app/world/start_overlap.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "app/world/refuse_body.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

/// Of a body's size: what places written with a few digits, and rounding, leave of a touch.
constexpr double touch = 1e-6;

struct StartOverlap {
  int body = 0;        // that is to be moved: soft bodies first, then boxes
  std::string reason;  // names the other, or the ground
};

class StartBodies {
 public:
  explicit StartBodies(const sim::World& world) : world_(world) {}

  bool is_box(int body) const { return body >= static_cast<int>(world_.soft.size()); }

  std::string name(int body) const { return is_box(body) ? box(body).name : soft(body).name; }

  /// m.
  double size(int body) const {
    if (is_box(body)) return box(body).size.minCoeff();
    const sim::Bounds around = sim::bounds(soft(body).positions);
    return (around.high - around.low).minCoeff();
  }

  bool is_deep(const sim::Overlap& overlap) const {
    double least = size(overlap.first);
    if (overlap.second != sim::ground_body) least = std::min(least, size(overlap.second));
    return overlap.depth > touch * least;
  }

 private:
  const sim::SoftBody& soft(int body) const { return world_.soft[sim::at(body)]; }
  const sim::RigidBox& box(int body) const {
    return world_.rigid[sim::at(body) - world_.soft.size()];
  }

  const sim::World& world_;
};

constexpr const char* remedy =
    "move it, or let simulation.contact = \"impulses\" part what starts in each other";

/// The first.
std::optional<StartOverlap> find_start_overlap(const sim::World& world) {
  const StartBodies start(world);
  for (const sim::Overlap& overlap : sim::overlaps(world)) {
    if (!start.is_deep(overlap)) continue;
    if (overlap.second == sim::ground_body) {
      return StartOverlap{overlap.first, fmt::format("starts {:.3g} m deep in the ground; {}",
                                                     overlap.depth, remedy)};
    }
    return StartOverlap{overlap.second,
                        fmt::format("starts {:.3g} m deep in body '{}'; {}", overlap.depth,
                                    start.name(overlap.first), remedy)};
  }
  for (const sim::CrossingPair& pair : sim::crossings(world).pairs) {
    // Boxes that only touch may cross by a rounding; how deep they lie in each other is exact.
    if (pair.first == pair.second || start.is_box(pair.first)) continue;
    return StartOverlap{pair.second, fmt::format("starts through the surface of body '{}'; {}",
                                                 start.name(pair.first), remedy)};
  }
  return std::nullopt;
}

/// Soft bodies come first in a world, each kind in the order of the scene.
const scenes::BodyScene& in_scene(const scenes::Scene& scene, int body) {
  std::int64_t left = body;
  for (const scenes::BodyKind kind : {scenes::BodyKind::soft, scenes::BodyKind::rigid}) {
    for (const scenes::BodyScene& each : scene.bodies) {
      if (each.kind != kind) continue;
      left -= scenes::copy_count(each);
      if (left < 0) return each;
    }
  }
  return scene.bodies.back();
}

}  // namespace

void refuse_start_overlap(const scenes::Scene& scene, const sim::World& start) {
  if (start.settings.contact != sim::ContactMethod::swept) return;
  const auto overlap = find_start_overlap(start);
  if (!overlap) return;
  refuse_body(scene, in_scene(scene, overlap->body).place, StartBodies(start).name(overlap->body),
              overlap->reason);
}

}  // namespace pneuma::app
