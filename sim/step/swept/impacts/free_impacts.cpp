#include "sim/step/swept/impacts/free_impacts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "sim/collision/separating_axis.h"
#include "sim/rigid/rigid_motion.h"
#include "sim/step/swept/contact_places.h"
#include "sim/step/swept/impacts/hits_apart.h"
#include "sim/step/swept/impacts/lone_pairs.h"
#include "sim/swept/free_impact.h"

namespace pneuma::sim {
namespace {

/// rad, after an impact: a box that turns further could hit the ground and leave it again. Its
/// corners' arcs are off their chords by that squared over 8.
constexpr double allowed_turn = 0.5;
/// Of the skin: what an impact may turn a box into its floor.
constexpr double allowed_depth = 0.1;

class FreeImpacts {
 public:
  FreeImpacts(World& world, SweptMemory& memory, const MotionStart& start, double tolerance,
              bool is_last)
      : world_(world),
        m_(memory),
        motion_(world, start, memory.bodies),
        pairs_(world, memory, start, motion_),
        tolerance_(tolerance),
        is_last_(is_last) {}

  void meet() {
    pairs_.for_each([this](const SweptContact& contact) { meet(contact); });
  }

  /// Also by an impact that was met freely.
  void note_pushed_bodies() {
    m_.is_pushed.assign(at(m_.bodies.count()), 0);
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      const SweptContact& contact = m_.contacts[i];
      if (!contact.has_met && !m_.impulses[i].may_act()) continue;
      for (const int body : {contact.first.body, contact.second.body}) {
        if (body != swept_ground && !is_fixed(world_, body)) m_.is_pushed[at(body)] = 1;
      }
    }
  }

  /// An impact that bounces, of few boxes, was left as it is.
  bool would_gain_by_parts() const { return bounces_left_ && are_few(m_.partners); }

 private:
  void meet(const SweptContact& contact) {
    std::array bodies = {contact.first.body, contact.second.body};
    if (!pairs_.moves_freely(bodies[0])) std::swap(bodies[0], bodies[1]);
    const auto first = pairs_.side_on_floor(bodies[0]), second = pairs_.side_on_floor(bodies[1]);
    if (!first || !second) return leave(contact);
    const std::array sides = {*first, *second};
    if (LonePairs::are_level(sides, contact)) return;
    FreeImpact impact(sides, contact.wanted, hit_together * m_.bodies.skin(bodies[0]),
                      time_step(world_.settings));
    const auto result = impact.find_time();
    switch (result) {
      case FreeImpact::Result::none:
        return leave(contact);
      case FreeImpact::Result::hit:
        if (hit(impact, motion_.material(contact))) break;
        return leave(contact);  // corners that pass beside each other, or one that leaves before
      case FreeImpact::Result::pass:
        m_.impact_points.clear();
        break;
    }
    impact.finish(m_.impact_points);
    const bool is_among_others = meets_others(impact, bodies);
    // What parts of the step do not tell apart may come near, to be hit as the next step begins;
    // but not where it may come to rest.
    const bool is_pulled = pairs_.is_pulled(contact);
    const double near = is_last_ && !is_pulled
                            ? contact.wanted - hit_together * m_.bodies.skin(bodies[0])
                            : motion_.near_distance(bodies[0], bodies[1]);
    const bool may_be_again = result == FreeImpact::Result::hit || is_pulled;
    const bool meets_again = may_be_again && impact.meets_again(near);
    if (is_among_others || meets_again) {
      if (is_among_others || has_acted(bodies[0])) leave(contact);
      return;
    }
    book(impact, bodies);
    for (std::size_t i = 0; i < 2; ++i) {
      if (sides[i].moves()) move(impact, bodies, i);
    }
  }

  /// Solves for the impulses. False if the sides part in all points.
  bool hit(FreeImpact& impact, const ContactMaterial& material) {
    if (!impact.find_points(material.friction, m_.of_impact, m_.impact_points)) return false;
    const bool bounces = std::ranges::any_of(m_.impact_points, [&](const ImpactPoint& point) {
      return material.restitution * point.approach >= min_bounce_speed;
    });
    const double restitution = bounces ? material.restitution : 0.0;
    // An impulse where the sides part adds energy, which Newton's ratio of speeds does not know.
    const bool takes_a_path = std::ranges::any_of(m_.impact_points, [&](const ImpactPoint& point) {
      return point.impulse->has_friction() || point.speed > tolerance_;
    });
    if (takes_a_path) {
      m_.impact_path.follow(m_.impact_points, restitution, tolerance_);
    } else {
      m_.impact_path.part_at_once(m_.impact_points, restitution, tolerance_);
    }
    limit_work();
    return true;
  }

  /// To none: what a solution leaves may add some.
  void limit_work() {
    double work = 0.0, linear = 0.0;
    for (const ImpactPoint& point : m_.impact_points) {
      work += point.impulse->work(point.velocity);
      linear += point.impulse->given().dot(point.velocity);
    }
    if (!(work > 0.0) || linear >= 0.0) return;
    const double share = -linear / (work - linear);
    for (const ImpactPoint& point : m_.impact_points) {
      point.impulse->replace_given(to_vec4d(share * point.impulse->given()));
    }
  }

  void book(const FreeImpact& impact, const std::array<int, 2>& bodies) {
    m_.work += impact.work();
    m_.driven_work += impact.driven_work();
    for (const int body : bodies) {
      if (!pairs_.moves_freely(body)) continue;
      pairs_.for_each_contact(body, [&](std::size_t i, int other) {
        m_.work -= m_.work_of_start[i];
        m_.work_of_start[i] = 0.0;
        m_.driven_work -=
            m_.impulses[i].given().dot(motion_.driven_velocity(m_.contacts[i], Moment::start));
        if (pairs_.rests(m_.contacts[i], other)) {
          m_.impulses[i].replace_given(Vec4d{});
          m_.contacts[i].is_floor = true;
        } else {
          m_.contacts[i].has_met = true;
        }
      });
    }
    for (const ImpactPoint& point : m_.impact_points) {
      if (!(point.approach > 0.0)) continue;  // of a floor
      m_.met_freely.push_back(
          {bodies[0], bodies[1], point.at, point.impulse->normal(), point.impulse->given()});
    }
  }

  /// Whether impulses of the start have. Without them, what comes near by the end of the step is
  /// met there.
  bool has_acted(int body) const {
    bool has = false;
    pairs_.for_each_contact(body, [&](std::size_t i, int other) {
      has |= !pairs_.rests(m_.contacts[i], other) && m_.impulses[i].normal_impulse() > 0.0;
    });
    return has;
  }

  /// To the impulses at both ends of the step, or to its parts, which may meet freely. A crowd on
  /// a floor would halve each step.
  void leave(const SweptContact& contact) {
    if (!bounces_well(world_, motion_, contact)) return;
    bounces_left_ = bounces_left_ || !pairs_.is_on_floor(contact) || few_touch(m_.partners);
  }

  /// Whether the sides may meet others in the step, or turn far.
  bool meets_others(const FreeImpact& impact, const std::array<int, 2>& bodies) const {
    const bool reaches_ground = world_.settings.ground && bodies[1] != swept_ground;
    for (std::size_t i = 0; i < 2; ++i) {
      const ImpactSide& side = impact.sides()[i];
      if (!side.moves()) continue;
      const double turn = impact.time_left() * impact.at_end(i).angular_velocity.norm();
      if (turn > allowed_turn) return true;
      const double deepest = side.is_on_floor() ? allowed_depth * m_.bodies.skin(bodies[i]) : 0.0;
      if (side.is_on_floor() &&
          side.depth_in_floor(impact.at_end(i), time_step(world_.settings)) > deepest)
        return true;
      if (reaches_ground && side.bounds(impact.at_end(i)).low.z() < -deepest) return true;
      const auto may_meet = [&](int other) {
        return !pairs_.rests_on(bodies[i], other) && !is_beside(impact, i, bodies[i], other);
      };
      if (m_.bodies.any_near_way(way(bodies, impact, i), {bodies[0], bodies[1]}, may_meet)) {
        return true;
      }
    }
    return false;
  }

  /// Bounds say little of boxes that are not upright.
  bool is_beside(const FreeImpact& impact, std::size_t i, int body, int other) const {
    if (!m_.bodies.is_box(other)) return false;
    const ImpactSide &of = impact.sides()[i], beside = pairs_.side(other);
    const RigidState &start = of.start(), &hit = impact.at_impact(i), &end = impact.at_end(i);
    const double left = impact.time_left();
    const double turned = std::max((time_step(world_.settings) - left) * of.fastest_turn(),
                                   left * end.angular_velocity.norm());
    const double moved =
        std::max((start.position - hit.position).norm(), (end.position - hit.position).norm());
    const double reach = moved + of.half_diagonal() * turned + margin(of, body) +
                         reach_of_other(beside, other) + motion_.near_distance(body, other);
    return !find_min_overlap(of.placed(hit), beside.placed(beside.start()), reach);
  }

  /// m, from where it starts. Unknown of what has been hit on its way.
  double reach_of_other(const ImpactSide& beside, int other) const {
    if (pairs_.stands(other)) return 0.0;
    const auto is_of_other = [&](const MetFreely& met) {
      return met.first == other || met.second == other;
    };
    const double turned = time_step(world_.settings) * beside.fastest_turn();
    if (turned > allowed_turn || std::ranges::any_of(m_.met_freely, is_of_other)) {
      return std::numeric_limits<double>::infinity();
    }
    const Vec3 way = beside.box().position - beside.start().position;
    return way.norm() + beside.half_diagonal() * turned + margin(beside, other);
  }

  /// In the whole step, with the skin, what corners on arcs leave and how far a parabola bulges.
  Bounds way(const std::array<int, 2>& bodies, const FreeImpact& impact, std::size_t side) const {
    const ImpactSide& of = impact.sides()[side];
    Bounds result = of.bounds(of.after(0.0));
    result.include(of.bounds(impact.at_impact(side)));
    result.include(of.bounds(impact.at_end(side)));
    const Vec3 more = Vec3::Constant(margin(of, bodies[side]));
    return {result.low - more, result.high + more};
  }

  /// m.
  double margin(const ImpactSide& of, int body) const {
    const double arc = of.half_diagonal() * allowed_turn * allowed_turn / 8.0;
    const double step = time_step(world_.settings);
    const double bulge = 0.125 * world_.settings.gravity.norm() * step * step;
    return m_.bodies.skin(body) + arc + bulge;
  }

  void move(const FreeImpact& impact, const std::array<int, 2>& bodies, std::size_t side) {
    const int body = bodies[side];
    RigidBox& box = world_.rigid[at(m_.bodies.box(body))];
    m_.bodies.add_to_way(body, way(bodies, impact, side));
    set_state(box, impact.at_end(side));
    const double step = time_step(world_.settings);
    add_gravity_and_drag(box, world_.settings.gravity, step);
    const ImpactSide& of = impact.sides()[side];
    if (of.leaves_floor(impact.at_end(side))) {
      box.velocity -=
          (step - impact.time_left()) * of.borne_gravity();  // the floor bore it so long
    } else {
      // A floor takes at the end of the step what gravity gave a box that it let fall nowhere.
      m_.work += 0.5 * box.mass * (step * of.borne_gravity()).squaredNorm();
    }
    m_.bodies.set_end(world_, body);
  }

  World& world_;
  SweptMemory& m_;
  ContactMotion motion_;
  LonePairs pairs_;
  double tolerance_;  // m/s
  bool is_last_;      // of the parts of a step
  bool bounces_left_ = false;
};

}  // namespace

bool meet_freely(World& world, SweptMemory& memory, const MotionStart& start, double tolerance,
                 double fraction) {
  memory.met_freely.clear();
  if (world.rigid.empty()) return true;
  const bool is_last = fraction <= least_part;
  FreeImpacts impacts(world, memory, start, tolerance, is_last);
  impacts.meet();
  impacts.note_pushed_bodies();
  return is_last || !impacts.would_gain_by_parts();
}

}  // namespace pneuma::sim
