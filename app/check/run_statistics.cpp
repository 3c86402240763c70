#include "app/check/run_statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "app/check/frame_motion.h"
#include "app/host/interrupt.h"
#include "app/record/pressed_volume.h"
#include "app/record/shape_deviation.h"
#include "app/record/two_bodies.h"
#include "app/world/build_world.h"
#include "app/world/may_start.h"
#include "app/world/touch.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/overlap.h"
#include "sim/joints/gas_flow.h"
#include "sim/mesh/measure.h"
#include "sim/response/fall_asleep.h"
#include "sim/soft/gas_law.h"
#include "sim/soft/pins.h"

namespace pneuma::app {
namespace {

double volume(const sim::SoftBody& body) {
  return sim::volume(body.mesh->topology, body.positions);
}

/// What moves as it is told to is not slowed down by it.
bool has_drag(const sim::World& world) {
  const bool of_soft = std::ranges::any_of(world.soft, [](const sim::SoftBody& body) {
    return body.material.rho_g > 0.0 && !sim::is_kinematic(body);
  });
  return of_soft || std::ranges::any_of(world.rigid, [](const sim::RigidBox& box) {
           return box.rho_g > 0.0 && !box.is_kinematic;
         });
}

std::vector<std::string> what_pushes(const sim::World& world) {
  std::vector<std::string> names;
  if (!world.settings.gravity.isZero()) names.emplace_back("gravity");
  if (world.settings.ground) names.emplace_back("the ground");
  if (std::ranges::any_of(world.rigid, &sim::RigidBox::is_kinematic)) {
    names.emplace_back("boxes that are static or moved");
  }
  const auto has_pins = [&](bool all) {
    return std::ranges::any_of(world.soft, [&](const sim::SoftBody& body) {
      return body.pins && body.pins->are_all == all;
    });
  };
  if (has_pins(true)) names.emplace_back("obstacles");
  if (has_pins(false)) names.emplace_back("pins");
  if (has_drag(world)) names.emplace_back("the air (rho_g)");
  return names;
}

bool is_moved_whole(const sim::SoftBody& body) {
  return sim::is_kinematic(body) && body.pins->are_moved;
}

bool has_moved_obstacles(const sim::World& world) {
  return std::ranges::any_of(world.soft, is_moved_whole) ||
         std::ranges::any_of(world.rigid, [](const sim::RigidBox& box) {
           return box.is_kinematic &&
                  (box.motion || !box.velocity.isZero() || !box.angular_velocity.isZero());
         });
}

bool has_moved_pins(const sim::World& world) {
  return std::ranges::any_of(world.soft, [](const sim::SoftBody& body) {
    return body.pins && body.pins->are_moved && !body.pins->are_all;
  });
}

bool has_moved_springs(const sim::World& world) {
  const auto is_moved = [&](const sim::SpringEnd& end) {
    return is_moved_whole(world.soft[sim::at(end.body)]);
  };
  return std::ranges::any_of(world.springs, [&](const sim::BodySpring& spring) {
    return is_moved(spring.first) || is_moved(spring.second);
  });
}

void add_value(double value, ValueRange& range) {
  if (std::isnan(range.start)) range.start = value;
  range.least = std::min(range.least, value);
  range.greatest = std::max(range.greatest, value);
  range.end = value;
}

/// Once it has had some, also when none is left: nothing outside presses on it either then.
void add_gas(const sim::SoftBody& body, GasRange& range) {
  const sim::GasLaw law = sim::gas_law(body.material);
  const bool is_empty = law.strength == 0.0;
  const double now = volume(body);
  if (is_empty ? std::isnan(range.n.start) : !(now > 0.0)) return;
  add_value(is_empty ? 0.0 : sim::gauge_pressure(law, now), range.pressure);
  add_value(body.material.n, range.n);
}

/// Gathers the statistics while a run goes on.
class Observer {
 public:
  Observer(const sim::World& start, std::int64_t all_steps)
      : all_steps_(all_steps),
        rest_limits_(rest_limits(start)),
        frame_time_(sim::time(start)),
        last_energy_(sim::energy(start).total()),
        least_energy_(last_energy_),
        greatest_energy_(last_energy_) {
    keep_places(start, before_);
    result_.energy_start = sim::energy(start);
    result_.momentum_start = sim::momentum(start);
    result_.start_penetration = look_at_penetration(start);
    result_.pushed_by = what_pushes(start);
    if (has_moved_obstacles(start)) result_.driven_work = 0.0;
    result_.pins_move = has_moved_pins(start);
    result_.springs_are_moved = has_moved_springs(start);
    if (sim::has_gas_flow(start)) result_.gas_work = 0.0;
    find_start_overlaps(start);
    look_for_crossings(start);
    has_been_out_.resize(sim::at(sim::body_count(start)));
    for (const sim::SoftBody& body : start.soft) {
      const std::size_t index = result_.volumes.size();
      const Volume now = volume_now(start, index);
      result_.volumes.push_back({.body = body.name,
                                 .start = now,
                                 .least = now,
                                 .greatest = now,
                                 .end = now,
                                 .is_obstacle = sim::is_kinematic(body),
                                 .keeps_gas = keeps_gas(start, static_cast<int>(index))});
      result_.gas.push_back({.body = body.name, .pressure = {}, .n = {}});
      look_at_gas(body, result_.gas.back());
    }
  }

  void after_step(const Simulation& simulation) {
    const sim::World& world = simulation.world();
    const auto contacts = simulation.contacts();
    const std::int64_t with_obstacles = count_with_obstacles(contacts, world);
    result_.contacts.add(contacts, with_obstacles);
    if (result_.driven_work) *result_.driven_work += simulation.driven_work();
    if (result_.gas_work) *result_.gas_work += simulation.gas_work();
    if (2 * world.steps > all_steps_) {
      result_.settled_contacts.add(contacts, with_obstacles);
    }
    for (const int parts : simulation.step_parts()) {
      ++result_.divided_steps;
      result_.most_parts = std::max(result_.most_parts, parts);
    }
  }

  void after_frame(const sim::World& world) {
    const double now = sim::energy(world).total();
    const double work = result_.driven_work.value_or(0.0) + result_.gas_work.value_or(0.0);
    const double rise = (now - last_energy_) - (work - last_work_);
    result_.energy_rises += std::max(0.0, rise);
    if (rise > result_.energy_rise.value) result_.energy_rise = {rise, sim::time(world)};
    last_energy_ = now;
    last_work_ = work;
    least_energy_ = std::min(least_energy_, now);
    greatest_energy_ = std::max(greatest_energy_, now);
    const double depth = look_at_penetration(world);
    if (2 * world.steps > all_steps_) {
      result_.settled_penetration = std::max(result_.settled_penetration, depth);
    }
    part_start_overlaps(world);
    look_for_crossings(world);
    look_for_sunk_bodies(world);
    for (std::size_t b = 0; b < world.soft.size(); ++b) {
      add_volume(volume_now(world, b), result_.volumes[b]);
      look_at_gas(world.soft[b], result_.gas[b]);
    }
    motion_ = motion(world, before_, sim::time(world) - frame_time_, rest_limits_);
    keep_places(world, before_);
    frame_time_ = sim::time(world);
    if (motion_.liveliest.over_limit() >= 1.0) {
      quiet_from_.reset();
    } else if (!quiet_from_) {
      quiet_from_ = frame_time_;
    }
  }

  RunStatistics finish(const sim::World& world) {
    result_.steps = world.steps;
    result_.seconds = sim::time(world);
    result_.energy_end = sim::energy(world);
    result_.energy_span = greatest_energy_ - least_energy_;
    result_.momentum_end = sim::momentum(world);
    result_.at_end = motion_.fastest;
    result_.liveliest_at_end = motion_.liveliest;
    if (!result_.divergence && has_been_quiet()) result_.rests_from = quiet_from_;
    result_.state_hash = sim::state_hash(world);
    if (!has_touched_ground()) std::erase(result_.pushed_by, "the ground");
    if (result_.divergence) mark_self_crossings(world, sim::crossings(world));
    for (std::size_t b = 0; b < world.soft.size(); ++b) {
      result_.volumes[b].end = volume_now(world, b);
      result_.volumes[b].shape_deviation = shape_deviation(world.soft[b]);
      look_at_gas(world.soft[b], result_.gas[b]);
    }
    std::erase_if(result_.gas, [](const GasRange& range) { return std::isnan(range.n.start); });
    for (const sim::Overlap& overlap : sim::overlaps(world)) {
      if (overlap.depth <= result_.end_overlap) continue;
      result_.end_overlap = overlap.depth;
      result_.end_overlap_bodies = two_bodies(world, overlap.first, overlap.second);
    }
    return std::move(result_);
  }

  void diverged(std::string how) { result_.divergence = std::move(how); }

 private:
  using Pair = std::pair<int, int>;

  void look_at_gas(const sim::SoftBody& body, GasRange& range) {
    add_gas(body, range);
    if (body.material.n > 0.0 && body.material.ambient_pressure == 0.0) {
      result_.has_gas_in_vacuum = true;
    }
  }

  Volume volume_now(const sim::World& world, std::size_t soft) const {
    return {volume(world.soft[soft]), crosses_itself_[soft] != 0};
  }

  bool has_been_quiet() const {
    constexpr double rounding = 1e-9;  // s
    return quiet_from_ && frame_time_ - *quiet_from_ >= rest_time - rounding;
  }

  bool has_touched_ground() const {
    return result_.contacts.of(sim::ContactKind::soft_ground).most > 0 ||
           result_.contacts.of(sim::ContactKind::rigid_ground).most > 0;
  }

  /// m, now.
  double look_at_penetration(const sim::World& world) {
    const sim::Overlap deepest = sim::deepest_penetration(world);
    if (deepest.depth > result_.penetration.value) {
      result_.penetration = {deepest.depth, sim::time(world)};
      result_.penetration_bodies = two_bodies(world, deepest.first, deepest.second);
    }
    return deepest.depth;
  }

  void find_start_overlaps(const sim::World& start) {
    for (const sim::Overlap& overlap : sim::overlaps(start)) {
      if (overlap.second == sim::ground_body) continue;
      if (is_beyond_touch(start, overlap.first, overlap.second)) {
        start_overlaps_.emplace(overlap.first, overlap.second);
      }
    }
    if (start_overlaps_.empty()) return;
    const auto& [first, second] = *start_overlaps_.begin();
    result_.start_overlap.bodies = two_bodies(start, first, second);
    result_.start_overlap.pairs = static_cast<int>(start_overlaps_.size());
    result_.start_overlap.left = result_.start_overlap.pairs;
  }

  /// What came apart once counts as any other pair from then on.
  void part_start_overlaps(const sim::World& world) {
    const auto parted = std::erase_if(start_overlaps_, [&](const Pair& pair) {
      return !is_beyond_touch(world, pair.first, pair.second);
    });
    if (parted > 0) result_.start_overlap.parted = sim::time(world);
    result_.start_overlap.left = static_cast<int>(start_overlaps_.size());
  }

  void look_for_crossings(const sim::World& world) {
    const sim::Crossings found = sim::crossings(world);
    ++result_.frames;
    std::vector<sim::CrossingPair> between = crossings_beyond_touch(world, found), within;
    if (between.empty() && found.between_bodies > 0) ++result_.touching_frames;
    std::erase_if(between, [&](const sim::CrossingPair& pair) {
      return start_overlaps_.contains(Pair(pair.first, pair.second));
    });
    std::ranges::copy_if(found.pairs, std::back_inserter(within),
                         [](const sim::CrossingPair& pair) { return pair.first == pair.second; });
    add(world, between, result_.crossings);
    add(world, within, result_.self_crossings);
    mark_self_crossings(world, found);
  }

  void mark_self_crossings(const sim::World& world, const sim::Crossings& found) {
    crosses_itself_.assign(world.soft.size(), 0);
    for (const sim::CrossingPair& pair : found.pairs) {
      if (pair.first == pair.second) crosses_itself_[sim::at(pair.first)] = 1;
    }
  }

  /// Those that start in the ground count once they have come out of it.
  void look_for_sunk_bodies(const sim::World& world) {
    if (!world.settings.ground || world.settings.contact == sim::ContactMethod::potential) return;
    const int before = result_.sunk.frames;
    for (int body = 0; body < sim::body_count(world); ++body) {
      if (sim::is_kinematic(world, body)) continue;
      const double depth = -body_bounds(world, body).low.z();
      const bool is_sunk = depth > 0.0 && depth > sunk_depth(world, body);
      if (!is_sunk) has_been_out_[sim::at(body)] = 1;
      if (!is_sunk || has_been_out_[sim::at(body)] == 0) continue;
      result_.sunk.frames = before + 1;
      if (depth <= result_.sunk.depth.value) continue;
      result_.sunk.depth = {depth, sim::time(world)};
      result_.sunk.body = sim::body_name(world, body);
    }
  }

  /// m: no touch. Vertices that other bodies hold give way to them, within a step; contacts by
  /// impulses let all that is pressed sink in.
  static double sunk_depth(const sim::World& world, int body) {
    constexpr double of_boxes = 0.01, of_soft = 0.02, by_impulses = 0.25;
    const bool is_soft = sim::at(body) < world.soft.size();
    const bool is_swept = world.settings.contact == sim::ContactMethod::swept;
    const double share = !is_swept ? by_impulses : is_soft ? of_soft : of_boxes;
    return std::max(touch_depth(world, body, body), share * least_extent(world, body));
  }

  static void add(const sim::World& world, const std::vector<sim::CrossingPair>& pairs,
                  CrossingStatistics& statistics) {
    if (pairs.empty()) return;
    int edges = 0;
    for (const sim::CrossingPair& pair : pairs) edges += pair.edges;
    ++statistics.frames;
    if (edges <= statistics.edges.value) return;
    statistics.edges = {static_cast<double>(edges), sim::time(world)};
    statistics.first_bodies = two_bodies(world, pairs[0].first, pairs[0].second);
    statistics.more = static_cast<int>(pairs.size()) - 1;
  }

  std::set<Pair> start_overlaps_;             // that did not come apart yet
  std::vector<std::uint8_t> has_been_out_;    // per body: of the ground
  std::vector<std::uint8_t> crosses_itself_;  // per soft body, in the last frame
  RunStatistics result_;
  std::int64_t all_steps_;
  Places before_;  // in the last frame
  std::vector<double> rest_limits_;
  double frame_time_;                 // s, its
  Motion motion_;                     // up to it
  std::optional<double> quiet_from_;  // s, of the frame from which on nothing was faster
  double last_energy_;
  double last_work_ = 0.0;
  double least_energy_;
  double greatest_energy_;
};

}  // namespace

RunStatistics run_statistics(const scenes::Scene& scene, int threads, OnDivergence on_divergence) {
  Simulation simulation(scene, build_world(scene), threads, on_divergence);
  const sim::World& world = simulation.world();
  const int steps_per_frame = scenes::steps_per_frame(scene);
  const std::int64_t all_steps = scenes::frame_count(scene) * steps_per_frame;
  Observer observer(world, all_steps);

  while (world.steps < all_steps) {
    throw_if_interrupted();
    try {
      simulation.advance_step();
    } catch (const DivergenceError& error) {
      observer.diverged(error.what());
      break;
    }
    observer.after_step(simulation);
    if (world.steps % steps_per_frame == 0) observer.after_frame(world);
  }
  RunStatistics result = observer.finish(world);
  result.may_use_potential =
      result.self_crossings.frames > 0 && may_use_potential(scene, "implicit_euler");
  return result;
}

}  // namespace pneuma::app
