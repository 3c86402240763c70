#include "app/world/start_overlap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/files/refuse_body.h"
#include "app/world/touch.h"
#include "sim/base/text.h"
#include "sim/inspect/closed_surface.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/measure.h"
#include "sim/potential/start_distance.h"

namespace pneuma::app {
namespace {

/// Of a body's size: what rounding leaves of a touch, and between boxes, which swept contacts let
/// lie in each other for a while, what places written with four digits do.
constexpr double start_touch = 1e-6, start_touch_of_boxes = 1e-4;
/// So many of the overlaps are told of.
constexpr std::size_t most_shown = 10;
/// Of two bodies together: of finer ones no shorter way apart is looked for.
constexpr int most_vertices = 5'000;

struct StartOverlap {
  int body = 0;        // that is to be moved: soft bodies first, then boxes
  std::string reason;  // names the other, or the ground
  int other = sim::ground_body;
};

std::string name_of(const sim::World& world, int body) { return sim::body_name(world, body); }

/// m, beyond which two bodies, or one and the ground, are refused.
double allowed_depth(const sim::World& world, int first, int second) {
  double least = least_extent(world, first);
  if (second != sim::ground_body) least = std::min(least, least_extent(world, second));
  const auto is_box = [&](int body) { return sim::at(body) >= world.soft.size(); };
  const bool are_boxes = world.settings.contact == sim::ContactMethod::swept && is_box(first) &&
                         (second == sim::ground_body || is_box(second));
  return (are_boxes ? start_touch_of_boxes : start_touch) * least;
}

std::string moved(double distance, std::string_view direction) {
  return fmt::format("move it {} m along {}", base::text_above(distance), direction);
}

/// Two bodies of a world without others, of which the second may stand elsewhere.
class TwoBodies {
 public:
  TwoBodies(const sim::World& world, int first, int second)
      : moves_box_(sim::at(second) >= world.soft.size()) {
    pair_.settings = world.settings;
    pair_.settings.ground.reset();
    for (const int body : {first, second}) {
      const std::size_t i = sim::at(body);
      if (i < world.soft.size()) {
        pair_.soft.push_back(world.soft[i]);
      } else {
        pair_.rigid.push_back(world.rigid[i - world.soft.size()]);
      }
    }
  }

  bool are_fine() const {
    int vertices = 0;
    for (const sim::SoftBody& body : pair_.soft) vertices += body.positions.size();
    return vertices > most_vertices;
  }
  bool are_apart(const sim::Vec3& way) const {
    const sim::World moved = moved_by(way);
    // The search for points in both ends at the first, soon where there are many.
    return !sim::overlap_deeper_than(moved, 0, 1, 0.0) &&
           sim::crossings(sim::closed_surfaces(moved), 0).pairs.empty();
  }
  /// Whether they would not be refused.
  bool may_start(const sim::Vec3& way) const {
    const sim::World moved = moved_by(way);
    if (sim::overlap_deeper_than(moved, 0, 1, allowed_depth(moved, 0, 1))) return false;
    return moved.soft.empty() || sim::crossings(sim::closed_surfaces(moved), 0).pairs.empty();
  }

 private:
  sim::World moved_by(const sim::Vec3& way) const {
    sim::World moved = pair_;
    if (!moves_box_) {
      sim::VertexArray& positions = moved.soft.back().positions;
      for (int v = 0; v < positions.size(); ++v) positions[v] = positions[v] + way;
    } else {
      moved.rigid.back().position += way;
    }
    return moved;
  }

  sim::World pair_;
  bool moves_box_;
};

/// Of a way: how much longer than needed it may be.
constexpr double needed = 0.05;

/// Each way tried is so many times the one before, from a part of what surely suffices: what is
/// hollow may come apart soon, and not again until it has left the hollow.
constexpr double growth_of_way = 1.5, first_part_of_way = 1.0 / 64.0;

/// m along a unit `direction`, by which the second comes apart, of `all` that surely suffices; none
/// if it is no shorter than `shortest`. Of fine bodies all of it.
std::optional<double> way_along(const TwoBodies& both, const sim::Vec3& direction, double all,
                                double shortest) {
  if (!(all > 0.0)) return std::nullopt;
  if (both.are_fine()) return all < shortest ? std::optional(all) : std::nullopt;
  double too_short = 0.0, enough = first_part_of_way * all;
  while (enough < std::min(all, shortest) && !both.are_apart(enough * direction)) {
    too_short = enough;
    enough = std::min(all, growth_of_way * enough);
  }
  if (enough >= shortest) return std::nullopt;
  while (enough - too_short > needed * enough) {
    // Of what is not in another deeply, halves would come near it slowly.
    const double between = too_short > 0.0 ? 0.5 * (too_short + enough) : enough / 8.0;
    (both.are_apart(between * direction) ? enough : too_short) = between;
  }
  return enough < shortest ? std::optional(enough) : std::nullopt;
}

constexpr std::array<std::string_view, 6> directions = {"+x", "-x", "+y", "-y", "+z", "-z"};

/// The axis along which the second lies beside the first, if one does: not in a hollow of it.
std::string_view direction_between(const sim::World& world, int first, int second) {
  const sim::Bounds other = body_bounds(world, first), own = body_bounds(world, second);
  const sim::Vec3 above = own.low - other.high, below = other.low - own.high;
  int axis = 0, axis_below = 0;
  const double gap = above.maxCoeff(&axis), gap_below = below.maxCoeff(&axis_below);
  constexpr double beside = -1e-6;  // m: to rounding
  if (std::max(gap, gap_below) < beside) return "";
  return gap >= gap_below ? directions[2 * sim::at(axis)] : directions[2 * sim::at(axis_below) + 1];
}

/// Whether a body may start there as far as bodies but one, `beside`, are concerned.
bool has_room(const sim::World& world, int body, const sim::Vec3& way, int beside) {
  const sim::Bounds own = body_bounds(world, body);
  for (int other = 0; other < sim::body_count(world); ++other) {
    if (other == body || other == beside) continue;
    const sim::Bounds bounds = body_bounds(world, other);
    const bool is_apart = ((own.low + way).array() >= bounds.high.array()).any() ||
                          ((own.high + way).array() <= bounds.low.array()).any();
    if (is_apart) continue;
    const TwoBodies both(world, other, body);
    if (both.are_fine() || !both.may_start(way)) return false;
  }
  return true;
}

/// Of the shortest free way: one that others bar is worth to be told of if it is no longer.
constexpr double much_shorter = 0.1;

struct WayApart {
  double distance = std::numeric_limits<double>::infinity();  // m
  std::string_view direction = {};
};

/// The shortest way along an axis, and not into the ground, by which bodies come apart; one that
/// leads into a third body only if all do.
std::string way_apart(const sim::World& world, int first, int second) {
  const sim::Bounds other = body_bounds(world, first), own = body_bounds(world, second);
  const TwoBodies both(world, first, second);
  WayApart best, crowded;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool down : {false, true}) {
      const double all = down ? own.high[axis] - other.low[axis] : other.high[axis] - own.low[axis];
      const sim::Vec3 unit = (down ? -1.0 : 1.0) * sim::Vec3::Unit(axis);
      const auto way = way_along(both, unit, all, best.distance);
      if (!way) continue;
      const double told = base::rounded_up(*way);  // what moved() says
      if (down && axis == 2 && world.settings.ground && own.low.z() - told < 0.0) continue;
      const WayApart found{*way, directions[2 * sim::at(axis) + (down ? 1 : 0)]};
      if (has_room(world, second, told * unit, first)) {
        best = found;
      } else if (*way < crowded.distance) {
        crowded = found;
      }
    }
  }
  if (best.direction.empty()) best = crowded;
  const std::string free = moved(best.distance, best.direction);
  if (crowded.distance >= much_shorter * best.distance) return free;
  return fmt::format("make room for it to move {:.3g} m along {}, or {}",
                     base::rounded_up(crowded.distance), crowded.direction, free);
}

/// Bodies that stand still or are moved want swept contacts.
std::string remedy(const sim::World& world) {
  for (int body = 0; body < static_cast<int>(world.soft.size() + world.rigid.size()); ++body) {
    if (sim::is_kinematic(world, body)) return "";
  }
  return ", or let simulation.contact = \"impulses\" part what starts in each other";
}

StartOverlap in_the_ground(const sim::World& world, const sim::Overlap& overlap) {
  return {overlap.first, fmt::format("starts {:.3g} m deep in the ground; {}{}", overlap.depth,
                                     moved(overlap.depth, "+z"), remedy(world))};
}

/// What is to be moved is not what the scene holds, if the other is free. `how` it starts.
StartOverlap in_another(const sim::World& world, int first, int second, std::string_view how) {
  if (sim::is_kinematic(world, second) && !sim::is_kinematic(world, first)) {
    std::swap(first, second);
  }
  return {second,
          fmt::format("starts {} body '{}'; {}{}", how, name_of(world, first),
                      way_apart(world, first, second), remedy(world)),
          first};
}

/// Impulses do not part the two: they would throw the inner one out.
StartOverlap within_another(const sim::World& world, int outer, int inner) {
  return {inner,
          fmt::format("starts inside of body '{}', and a soft body is full of gas, in which there "
                      "is nothing else; {}",
                      name_of(world, outer), way_apart(world, outer, inner)),
          outer};
}

bool is_pair(const sim::CrossingPair& pair, const sim::Overlap& overlap) {
  return std::minmax(pair.first, pair.second) == std::minmax(overlap.first, overlap.second);
}

/// `crossings`: all of the world. The overlap's own depth is only known to be more than allowed.
StartOverlap in_another(const sim::World& world, const sim::Overlap& overlap,
                        std::span<const sim::CrossingPair> crossings) {
  const auto is_full_of_gas = [&](int body) {
    return sim::at(body) < world.soft.size() && !sim::is_kinematic(world, body);
  };
  const auto extent = [&](int body) { return body_bounds(world, body).size().norm(); };
  const int outer = extent(overlap.first) < extent(overlap.second) ? overlap.second : overlap.first;
  const auto crosses = [&](const sim::CrossingPair& pair) { return is_pair(pair, overlap); };
  if (is_full_of_gas(outer) && std::ranges::none_of(crossings, crosses)) {
    return within_another(world, outer, outer == overlap.first ? overlap.second : overlap.first);
  }
  const double depth = sim::overlap_depth(world, overlap.first, overlap.second);
  return in_another(world, overlap.first, overlap.second, fmt::format("{:.3g} m deep in", depth));
}

StartOverlap through_another(const sim::World& world, const sim::CrossingPair& pair) {
  return in_another(world, pair.first, pair.second, "through the surface of");
}

std::vector<StartOverlap> find_start_overlaps(const sim::World& world) {
  std::vector<StartOverlap> found;
  std::vector<std::pair<int, int>> pairs;
  const std::vector<sim::CrossingPair> crossings = sim::crossings(world).pairs;
  const auto allowed = [&](int first, int second) { return allowed_depth(world, first, second); };
  for (const sim::Overlap& overlap : sim::overlaps(world, allowed)) {
    if (overlap.depth <= allowed(overlap.first, overlap.second)) continue;
    if (found.size() >= most_shown) {
      found.push_back({.body = overlap.first, .reason = ""});
    } else {
      const bool on_ground = overlap.second == sim::ground_body;
      found.push_back(on_ground ? in_the_ground(world, overlap)
                                : in_another(world, overlap, crossings));
    }
    pairs.emplace_back(overlap.first, overlap.second);
  }
  for (const sim::CrossingPair& pair : crossings) {
    // Boxes that only touch may cross by a rounding; how deep they lie in each other is exact.
    if (pair.first == pair.second || sim::at(pair.first) >= world.soft.size()) continue;
    if (std::ranges::find(pairs, std::pair(pair.first, pair.second)) != pairs.end()) continue;
    found.push_back(found.size() < most_shown ? through_another(world, pair)
                                              : StartOverlap{.body = pair.first, .reason = ""});
  }
  return found;
}

std::string too_near(const std::string& other, const sim::NearStart& touching,
                     std::string_view direction) {
  const double missing = touching.reach - touching.distance;
  return fmt::format(
      "starts {:.3g} m from {}; simulation.contact = \"potential\" pushes apart what is nearer "
      "than {:.3g} m; {}",
      touching.distance, other, touching.reach,
      direction.empty() ? fmt::format("move it {} m away", base::text_above(missing))
                        : moved(missing, direction));
}

/// What the contact potential cannot start from, beside that.
std::optional<StartOverlap> find_potential_start(const sim::World& world) {
  for (const sim::CrossingPair& pair : sim::crossings(world).pairs) {
    if (pair.first != pair.second) continue;
    return StartOverlap{pair.first,
                        "starts through its own surface, where simulation.contact = \"potential\" "
                        "would hold it; give it a shape that does not, or set "
                        "simulation.contact = \"swept\""};
  }
  const auto touching = sim::find_touching_start(world);
  if (!touching) return std::nullopt;
  if (touching->first == touching->second) {
    return StartOverlap{touching->first,
                        "starts touching itself, where simulation.contact = \"potential\" needs a "
                        "distance; set simulation.contact = \"swept\""};
  }
  if (touching->second < 0) {
    return StartOverlap{touching->first, too_near("the ground", *touching, "+z")};
  }
  int held = touching->first, moved = touching->second;
  std::string_view direction = direction_between(world, held, moved);
  const bool is_free = !sim::is_kinematic(world, held);
  // What is on something is moved, and not what it is on into the ground.
  if (is_free && (sim::is_kinematic(world, moved) || direction == "-z")) {
    std::swap(held, moved);
    direction = direction_between(world, held, moved);
  }
  return StartOverlap{
      moved, too_near(fmt::format("body '{}'", name_of(world, held)), *touching, direction)};
}

std::string what_parts_copies(const scenes::BodyScene& body) {
  std::string text = "more spacing";
  if (body.jitter > 0.0) text += " or less jitter";
  if (body.tumble) text += ", enough for their diagonals as they tumble,";
  return text + " parts them all";
}

}  // namespace

void refuse_start_overlap(const scenes::Scene& scene, const sim::World& start) {
  if (start.settings.contact == sim::ContactMethod::impulses) return;
  std::vector<StartOverlap> found = find_start_overlaps(start);
  if (found.empty() && start.settings.contact == sim::ContactMethod::potential) {
    if (auto overlap = find_potential_start(start)) found.push_back(*overlap);
  }
  if (found.empty()) return;
  const std::size_t shown = std::min(found.size(), most_shown);
  if (shown < found.size()) {
    found[shown - 1].reason += fmt::format(" (and {} more such pairs)", found.size() - shown);
  }
  std::vector<scenes::Diagnostic> diagnostics;
  for (const StartOverlap& overlap : std::span(found).first(shown)) {
    const scenes::BodyScene& body = scenes::body_of(scene, overlap.body);
    const bool are_copies =
        overlap.other != sim::ground_body && &scenes::body_of(scene, overlap.other) == &body;
    const std::string reason =
        overlap.reason + (are_copies ? "; they are copies: " + what_parts_copies(body) : "");
    diagnostics.push_back(
        body_diagnostic(scene, body.position_place, name_of(start, overlap.body), reason));
  }
  throw scenes::SceneError(diagnostics);
}

}  // namespace pneuma::app
