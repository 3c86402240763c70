#include "sim/step/potential_step.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "sim/base/text.h"
#include "sim/inspect/closed_surface.h"
#include "sim/response/group_motion.h"
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
    if (!may_be_halved || halvings == max_halvings()) return failure;
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
    find_contacts_at(m_.end);
    for (const ActiveContact& contact : m_.active) w_.contacts.push_back(seen(contact));
  }

 private:
  int max_halvings() const {
    return m_.implicit_step ? max_implicit_halvings : max_potential_halvings;
  }

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
    if (excess_ > 0.0) take_excess();
    for (const SoftBody& body : world_.soft) {
      if (auto divergence = find_divergence(world_, body)) {
        divergence->stage = Stage::integrate_soft;
        return divergence;
      }
    }
    return std::nullopt;
  }

  /// From what soft bodies do besides moving as rigid ones, and only if that is not enough, from
  /// all motion: of bodies that touch only each other, from what they do besides moving as one.
  /// Bodies that touch nothing give theirs only if that does not do.
  void take_excess() {
    join_bodies_in_contact();
    double of_vibrations = 0.0, of_groups = 0.0;
    for_each_vibration([&](const GroupMotion& motion) { of_vibrations += motion.energy(); });
    if (excess_ <= of_vibrations) {
      const double share = excess_ / of_vibrations;
      for_each_vibration([&](GroupMotion& motion) { motion.take(share * motion.energy()); });
      return;
    }
    for_each_group([&](const GroupMotion& motion) { of_groups += motion.energy(); });
    const double share = of_groups > excess_ ? excess_ / of_groups : 1.0;
    for_each_group([&](GroupMotion& motion) { excess_ -= motion.take(share * motion.energy()); });
    if (share == 1.0) GroupMotion(world_, m_.movable).take(excess_);
  }

  /// Not through what is moved or stands still, which holds them as the ground does, and pins.
  void join_bodies_in_contact() {
    find_contacts_at(m_.end);
    m_.joined.reset();
    std::ranges::fill(m_.touches, std::uint8_t{0});
    std::ranges::fill(m_.is_held, std::uint8_t{0});
    for (const ActiveContact& contact : m_.active) {
      const bool on_ground = contact.second < 0;
      const bool first_moves = !is_kinematic(world_, contact.first);
      const bool second_moves = !on_ground && !is_kinematic(world_, contact.second);
      if (first_moves) m_.touches[at(contact.first)] = 1;
      if (second_moves) m_.touches[at(contact.second)] = 1;
      if (first_moves && second_moves) m_.joined.unite(contact.first, contact.second);
      if (first_moves && !second_moves) m_.is_held[at(contact.first)] = 1;
      if (second_moves && !first_moves) m_.is_held[at(contact.second)] = 1;
    }
    for (const int body : m_.movable) {
      const bool has_pins = body < soft_count(world_) && world_.soft[at(body)].pins;
      if (has_pins || m_.is_held[at(body)] != 0) m_.is_held[at(m_.joined.find(body))] = 1;
    }
  }

  /// `visit(motion)` of each group in contact: what is held has no common motion.
  template <class Visit>
  void for_each_group(const Visit& visit) {
    for (const int& first : m_.movable) {
      if (m_.touches[at(first)] == 0 || m_.joined.find(first) != first) continue;
      m_.group.clear();
      for (const int body : m_.movable) {
        if (m_.joined.find(body) == first) m_.group.push_back(body);
      }
      GroupMotion motion(world_, m_.group);
      if (m_.is_held[at(first)] == 0) motion.leave_out_common();
      visit(motion);
    }
  }

  /// Of what is pinned, all motion is.
  template <class Visit>
  void for_each_vibration(const Visit& visit) {
    for (const int& body : m_.movable) {
      if (body >= soft_count(world_)) return;
      GroupMotion motion(world_, {&body, 1});
      if (!world_.soft[at(body)].pins) motion.leave_out_common();
      visit(motion);
    }
  }

  /// J, of the vertices that no force moves, in a part of the step: the mean of what they push with
  /// at its ends, along their way.
  double driven_work() {
    double work = 0.0;
    if (!moves_something()) return work;
    for (const WorldState* state : {&m_.start, &m_.end}) {
      find_contacts_at(*state);
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

  void find_contacts_at(const WorldState& state) {
    m_.finder.find(state.positions, state.positions, 0.0, m_.pairs);
    find_active(m_.surfaces, state.positions, m_.pairs, m_.active);
  }

  std::optional<Divergence> step_implicitly(int halvings, bool& may_be_halved) {
    const ImplicitWorldReport report = m_.implicit_step->step(world_, m_.start, m_.end);
    excess_ = report.excess;
    if (!report.is_valid) {
      return failure(first_body(), "its energy has no value: it has lost its volume, or touches");
    }
    if (report.arrived) return std::nullopt;
    may_be_halved = true;
    return blocked(report.blocked, report.blocked_pair, "", halvings);
  }

  std::optional<Divergence> step_explicitly(int halvings, bool& may_be_halved) {
    const ExplicitWorldReport report = m_.explicit_step->step(world_, m_.start, m_.end);
    if (report.fast_box >= 0) {
      may_be_halved = true;
      return spinning(m_.free_boxes[at(report.fast_box)], halvings);
    }
    if (report.is_too_stiff || report.limit.is_limited) {
      may_be_halved = true;
      return blocked(report.limit, report.limiting_pair,
                     report.is_too_stiff ? "a contact of it is too stiff for the step" : "",
                     halvings);
    }
    if (report.min_volume > 0.0) return std::nullopt;
    Divergence lost = failure(first_body(), "a volume is " + base::text(report.min_volume) +
                                                " m^3 within the step, so that a body is flat or "
                                                "inside out");
    lost.inverted = true;
    return lost;
  }

  std::string first_body() const { return body_name(world_, 0); }

  Divergence failure(std::string body, std::string what) const {
    return {Stage::integrate_soft, world_.steps + 1, std::move(body), std::move(what)};
  }

  /// Without words, which need memory, where the step can still be halved.
  Divergence blocked(const WayLimit& limit, const ContactPair& pair, std::string_view why,
                     int halvings) const {
    if (halvings < max_halvings()) return failure("", "");
    const std::string parts = std::to_string(1 << max_halvings());
    if (!limit.is_limited) {
      Divergence stiff = failure(first_body(), std::string(why) + ", even in " + parts + " parts");
      stiff.remedy = "a smaller simulation.potential.stiffness or an implicit integrator does";
      return stiff;
    }
    const bool on_ground = limit.pair < 0;
    const int surface = on_ground ? surface_of(limit.vertex) : pair.first;
    const std::string other = on_ground ? "the ground" : body_name(world_, pair.second);
    Divergence near =
        failure(body_name(world_, surface),
                "it comes so near to " + other + ", at " + features(limit, pair) +
                    ", that it would pass through it, even in a " + parts + "th of the step");
    near.other = other;
    near.remedy = "a step of 1/" + std::to_string(2 * world_.settings.steps_per_second) + " s" +
                  (m_.implicit_step ? "" : " or an implicit integrator") + " may do";
    return near;
  }

  Divergence spinning(int box, int halvings) const {
    if (halvings < max_halvings()) return failure("", "");
    return failure(world_.rigid[at(box)].name, "it turns by more than a radian even in a " +
                                                   std::to_string(1 << max_halvings()) +
                                                   "th of the step");
  }

  static std::string features(const WayLimit& limit, const ContactPair& pair) {
    std::string text = "vertex ";
    if (limit.pair < 0) return text += std::to_string(limit.vertex);
    text = pair.is_edges ? "edges" : "a vertex and a triangle, of vertices";
    for (const int v : pair.vertices) (text += ' ') += std::to_string(v);
    return text;
  }

  int surface_of(int vertex) const {
    int s = 0;
    while (s + 1 < m_.surfaces.count() && m_.surfaces[s + 1].first_vertex <= vertex) ++s;
    return s;
  }

  Contact seen(const ActiveContact& contact) const {
    Contact result;
    const int first_side = side_vertex(contact, true);
    result.first = side(surface_of(first_side), first_side);
    result.normal = contact.point.normal();
    result.point = Vec3::Zero();
    for (int i = 0; i < contact.count; ++i) {
      const double weight = contact.point.weights[at(i)];
      if (weight > 0.0) result.point += weight * m_.end.positions[contact.vertices[at(i)]];
    }
    if (contact.second >= 0) {
      const int second_side = side_vertex(contact, false);
      result.second = side(surface_of(second_side), second_side);
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

std::optional<Divergence> potential_step(World& world, StepWorkspace& workspace) {
  workspace.potential->driven_work = 0.0;
  PotentialStep step(world, workspace);
  if (auto divergence = step.advance(0)) return divergence;
  step.report_contacts();
  return std::nullopt;
}

}  // namespace pneuma::sim
