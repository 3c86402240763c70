#include "sim/step/potential_step.h"

#include <algorithm>
#include <cmath>

#include "sim/base/text.h"
#include "sim/inspect/closed_surface.h"
#include "sim/step/potential_excess.h"
#include "sim/step/potential_failure.h"
#include "sim/step/stage_runner.h"
#include "sim/step/stages/find_divergence.h"
#include "sim/step/stages/stages.h"

namespace pneuma::sim {
namespace {

class PotentialStep {
 public:
  PotentialStep(World& world, StepWorkspace& workspace)
      : world_(world), w_(workspace), m_(*workspace.potential), run_(workspace) {}

  /// Half steps, if the whole one fails.
  std::optional<Divergence> advance(int halvings) {
    keep(m_.starts[at(halvings)]);
    std::optional<Divergence> failure;
    bool may_be_halved = false;
    run_(Stage::integrate_soft, [&] { failure = try_step(halvings, may_be_halved); });
    if (!failure) {
      if (w_.options.after_part) w_.options.after_part(world_);
      return std::nullopt;
    }
    take_back(m_.starts[at(halvings)]);
    if (!may_be_halved || !can_be_halved(halvings)) return failure;
    world_.settings.steps_per_second *= 2;
    auto half = advance(halvings + 1);
    if (!half) half = advance(halvings + 1);
    world_.settings.steps_per_second /= 2;
    if (half) take_back(m_.starts[at(halvings)]);
    return half;
  }

  /// For whoever looks at them.
  void report_contacts() {
    w_.contacts.clear();
    m_.find_contacts_at(m_.end);
    for (const ActiveContact& contact : m_.active) w_.contacts.push_back(seen(contact));
  }

 private:
  bool can_be_halved(int halvings) const { return halvings < m_.max_halvings(); }

  void keep(PotentialMemory::Start& start) {
    if (start.state.positions.size() == 0) start.state = m_.start;
    m_.surfaces.gather(world_, start.state.positions, start.state.velocities);
    start.boxes.clear();
    for (const RigidBox& box : world_.rigid) start.boxes.push_back(state_of(box));
  }

  void take_back(const PotentialMemory::Start& start) {
    scatter(start.state);
    restore_rigid(world_, start.boxes);
  }

  void scatter(const WorldState& state) {
    for (std::size_t b = 0; b < world_.soft.size(); ++b) {
      const ContactSurface& surface = m_.surfaces[static_cast<int>(b)];
      SoftBody& body = world_.soft[b];
      body.positions.rows() =
          state.positions.rows().middleCols(surface.first_vertex, surface.vertex_count);
      body.velocities.rows() =
          state.velocities.rows().middleCols(surface.first_vertex, surface.vertex_count);
    }
  }

  /// What keys move goes where it is to go, and its corners straight; free boxes do not move yet.
  std::optional<Divergence> gather_start() {
    m_.surfaces.gather(world_, m_.start.positions, m_.start.velocities);
    m_.surfaces.place_boxes(world_, m_.start.positions);
    if (auto failure = integrate_rigid(world_, w_.motion_start.rigid)) return failure;
    for (std::size_t i = 0; i < m_.free_boxes.size(); ++i) {
      const int box = m_.free_boxes[i];
      m_.start.boxes[i] = w_.motion_start.rigid[at(box)];
      set_state(world_.rigid[at(box)], m_.start.boxes[i]);
    }
    m_.end.positions.rows() = m_.start.positions.rows();
    m_.surfaces.place_boxes(world_, m_.end.positions);
    if (world_.rigid.empty()) return std::nullopt;
    const int first = m_.surfaces[static_cast<int>(world_.soft.size())].first_vertex;
    const int count = m_.surfaces.vertex_count() - first;
    m_.start.velocities.rows().rightCols(count) =
        (m_.end.positions.rows().rightCols(count) - m_.start.positions.rows().rightCols(count)) /
        time_step(world_.settings);
    for (std::size_t i = 0; i < m_.free_boxes.size(); ++i) {
      move_corners(m_.start.boxes[i], m_.surfaces.of_box(m_.free_boxes[i]).first_vertex,
                   m_.start.positions, m_.start.velocities);
    }
    return std::nullopt;
  }

  std::optional<Divergence> try_step(int halvings, bool& may_be_halved) {
    excess_ = 0.0;
    if (auto failure = gather_start()) return failure;
    auto failure = m_.implicit_step ? step_implicitly(halvings, may_be_halved)
                                    : step_explicitly(halvings, may_be_halved);
    if (failure) return failure;
    m_.driven_work += driven_work();
    scatter(m_.end);
    for (std::size_t i = 0; i < m_.free_boxes.size(); ++i) {
      RigidBox& box = world_.rigid[at(m_.free_boxes[i])];
      set_state(box, m_.end.boxes[i]);
      if (auto divergence = find_divergence(world_, box)) {
        divergence->stage = Stage::integrate_soft;
        return divergence;
      }
    }
    if (excess_ > 0.0) take_excess(world_, m_, excess_);
    for (const SoftBody& body : world_.soft) {
      if (auto divergence = find_divergence(world_, body)) {
        divergence->stage = Stage::integrate_soft;
        return divergence;
      }
    }
    return std::nullopt;
  }

  /// J, of the vertices that no force moves, in a part of the step: the mean of what they push with
  /// at its ends, along their way.
  double driven_work() {
    double work = 0.0;
    if (!moves_something()) return work;
    for (const WorldState* state : {&m_.start, &m_.end}) {
      m_.find_contacts_at(*state);
      m_.forces.rows().setZero();
      add_forces(m_.active, state->positions, state->velocities, m_.surfaces.regularisation_speed(),
                 m_.forces);
      for (int v = 0; v < m_.forces.size(); ++v) {
        if (m_.surfaces.is_mobile(v)) continue;
        work -= 0.5 * m_.forces[v].dot(m_.end.positions[v] - m_.start.positions[v]);
      }
    }
    return work;
  }

  bool moves_something() const {
    for (int v = 0; v < m_.start.velocities.size(); ++v) {
      if (!m_.surfaces.is_mobile(v) && !Vec3(m_.start.velocities[v]).isZero(0.0)) return true;
    }
    return false;
  }

  std::optional<Divergence> step_implicitly(int halvings, bool& may_be_halved) {
    const ImplicitWorldReport report = m_.implicit_step->step(world_, m_.start, m_.end);
    excess_ = report.excess;
    if (!report.is_valid) {
      return of_potential_step(world_, body_name(world_, 0),
                               "its energy has no value: it has lost its volume, or touches");
    }
    if (report.arrived) return std::nullopt;
    may_be_halved = true;
    if (can_be_halved(halvings)) return unsaid();
    return of_blocked_way(world_, m_, report.blocked, report.blocked_pair, "");
  }

  std::optional<Divergence> step_explicitly(int halvings, bool& may_be_halved) {
    const ExplicitWorldReport report = m_.explicit_step->step(world_, m_.start, m_.end);
    const bool is_blocked = report.is_too_stiff || report.limit.is_limited;
    if (report.fast_box >= 0 || is_blocked) {
      may_be_halved = true;
      if (can_be_halved(halvings)) return unsaid();
      if (report.fast_box >= 0)
        return of_spinning_box(world_, m_, m_.free_boxes[at(report.fast_box)]);
      return of_blocked_way(world_, m_, report.limit, report.limiting_pair,
                            report.is_too_stiff ? "a contact of it is too stiff for the step" : "");
    }
    if (report.min_volume > 0.0) return std::nullopt;
    Divergence lost = of_potential_step(world_, body_name(world_, 0),
                                        "a volume is " + base::text(report.min_volume) +
                                            " m^3 within the step, so that a body is flat or "
                                            "inside out");
    lost.inverted = true;
    return lost;
  }

  /// Words need memory, and the step is halved.
  Divergence unsaid() const { return of_potential_step(world_, {}, {}); }

  Contact seen(const ActiveContact& contact) const {
    Contact result;
    const int first_side = side_vertex(contact, true);
    result.first = side(m_.surfaces.surface_of(first_side), first_side);
    result.normal = contact.point.normal();
    result.point = Vec3::Zero();
    for (int i = 0; i < contact.count; ++i) {
      const double weight = contact.point.weights[at(i)];
      if (weight > 0.0) result.point += weight * m_.end.positions[contact.vertices[at(i)]];
    }
    if (contact.second >= 0) {
      const int second_side = side_vertex(contact, false);
      result.second = side(m_.surfaces.surface_of(second_side), second_side);
    }
    result.impulse = time_step(world_.settings) *
                     contact_force(contact, relative_velocity(contact, m_.end.velocities),
                                   m_.surfaces.regularisation_speed());
    return result;
  }

  /// The nearest of the first or the second side.
  static int side_vertex(const ActiveContact& contact, bool is_first) {
    int found = 0;
    double most = -1.0;
    for (int i = 0; i < contact.count; ++i) {
      const double weight = contact.point.weights[at(i)] * (is_first ? 1.0 : -1.0);
      if (weight > most) {
        most = weight;
        found = contact.vertices[at(i)];
      }
    }
    return found;
  }

  ContactSide side(int surface, int vertex) const {
    const int soft = static_cast<int>(world_.soft.size());
    if (surface >= soft) return {SideKind::rigid, surface - soft, {}};
    return {
        SideKind::soft, surface, {FeatureKind::vertex, vertex - m_.surfaces[surface].first_vertex}};
  }

  World& world_;
  StepWorkspace& w_;
  PotentialMemory& m_;
  StageRunner run_;
  double excess_ = 0.0;  // J, by which the last part of the step has added to the energy
};

std::vector<int> find_free_boxes(const World& world) {
  std::vector<int> found;
  for (int i = 0; i < static_cast<int>(world.rigid.size()); ++i) {
    if (!world.rigid[at(i)].is_kinematic) found.push_back(i);
  }
  return found;
}

std::vector<int> find_movable(const World& world) {
  std::vector<int> found;
  for (int i = 0; i < body_count(world); ++i) {
    if (!is_kinematic(world, i)) found.push_back(i);
  }
  return found;
}

}  // namespace

PotentialMemory::PotentialMemory(const World& world)
    : surfaces(world),
      free_boxes(find_free_boxes(world)),
      movable(find_movable(world)),
      joined(at(body_count(world))),
      touches(joined.size()),
      is_held(joined.size()),
      start{VertexArray(surfaces.vertex_count()), VertexArray(surfaces.vertex_count()),
            std::vector<RigidState>(free_boxes.size())},
      end(start),
      finder(surfaces),
      forces(surfaces.vertex_count()) {
  group.reserve(movable.size());
  if (is_implicit(world.settings.integrator)) {
    implicit_step.emplace(world, surfaces);
  } else {
    explicit_step.emplace(world, surfaces);
  }
}

int PotentialMemory::max_halvings() const {
  return implicit_step ? max_implicit_halvings : max_potential_halvings;
}

void PotentialMemory::find_contacts_at(const WorldState& state) {
  finder.find(state.positions, state.positions, 0.0, pairs);
  find_active(surfaces, state.positions, pairs, active);
}

std::optional<Divergence> potential_step(World& world, StepWorkspace& workspace) {
  workspace.potential->driven_work = 0.0;
  PotentialStep step(world, workspace);
  if (auto divergence = step.advance(0)) return divergence;
  step.report_contacts();
  return std::nullopt;
}

}  // namespace pneuma::sim
