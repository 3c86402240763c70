#include "sim/step/swept/free_impacts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "sim/collision/separating_axis.h"
#include "sim/rigid/rigid_motion.h"
#include "sim/step/swept/contact_places.h"
#include "sim/swept/free_impact.h"

namespace pneuma::sim {
namespace {

/// rad, after an impact: a box that turns further could hit the ground and leave it again. Its
/// corners' arcs are off their chords by that squared over 8.
constexpr double allowed_turn = 0.5;
/// What bounces by less loses most of its motion anyway.
constexpr double least_restitution = 0.5;
/// m/s, and of what a step of free fall gains: slower impacts, in a heap that comes to rest, are
/// not worth parts of a step.
constexpr double min_approach = 0.1, least_of_fall = 2.0;
/// Of a heap of more boxes that bounce at once each step would be halved, for little. A box that
/// loses less than this part of its speed counts for less, and one that keeps all for nothing.
constexpr double most_boxes = 12.0, loss_of_one = 0.1;
/// Of a step: impacts are told apart down to such parts.
constexpr double least_part = 1.0 / 32.0;

/// m/s.
double least_approach(const Settings& settings) {
  return std::max(min_approach, least_of_fall * time_step(settings) * settings.gravity.norm());
}

/// How much the boxes count that are hit.
double weight_of_hit(std::span<const Partner> boxes) {
  double sum = 0.0;
  for (const Partner& box : boxes) {
    if (box.is_hit) sum += std::min(1.0, (1.0 - box.restitution) / loss_of_one);
  }
  return sum;
}

class FreeImpacts {
 public:
  FreeImpacts(World& world, SweptMemory& memory, const MotionStart& start, double tolerance)
      : world_(world),
        m_(memory),
        motion_(world, start, memory.bodies),
        start_(start),
        tolerance_(tolerance) {}

  void meet() {
    if (std::ranges::none_of(m_.contacts, [&](const auto& c) { return may_hit(c); })) return;
    find_partners();
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      if (may_hit(m_.contacts[i]) && is_first_of_lone_pair(i)) meet(m_.contacts[i]);
    }
  }

  /// Also by an impact that was met freely.
  void note_pushed_bodies() {
    m_.is_pushed.assign(at(m_.bodies.count()), 0);
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      const SweptContact& contact = m_.contacts[i];
      if (!contact.has_met && !(m_.impulses[i].pressing() > 0.0)) continue;
      for (const int body : {contact.first.body, contact.second.body}) {
        if (body != swept_ground && !is_fixed(world_, body)) m_.is_pushed[at(body)] = 1;
      }
    }
  }

  /// An impact that bounces, of few boxes, was left as it is.
  bool would_gain_by_parts() const {
    return bounces_left_ && weight_of_hit(m_.partners) <= most_boxes;
  }

 private:
  bool moves_freely(int body) const { return m_.bodies.is_box(body) && !is_fixed(world_, body); }
  bool stands(int body) const {
    if (body == swept_ground) return true;
    return m_.bodies.is_box(body) && is_fixed(world_, body) && !moves(world_, body);
  }

  /// A box that something stops on its way.
  bool may_hit(const SweptContact& contact) const {
    const int first = contact.first.body, second = contact.second.body;
    return !contact.is_near && contact.approach > 0.0 &&
           (moves_freely(first) ? moves_freely(second) || stands(second)
                                : stands(first) && moves_freely(second));
  }

  /// The bodies that each box which moves freely has contacts with, if it is one and all may hit.
  void find_partners() {
    m_.partners.assign(at(m_.bodies.count()), {});
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      const int first = m_.contacts[i].first.body, second = m_.contacts[i].second.body;
      if (moves_freely(first)) add_contact(i, second, m_.partners[at(first)]);
      if (moves_freely(second)) add_contact(i, first, m_.partners[at(second)]);
    }
  }
  void add_contact(std::size_t number, int body, Partner& partner) const {
    const bool hits = may_hit(m_.contacts[number]);
    const double restitution = motion_.material(m_.contacts[number]).restitution;
    if (hits) partner.restitution = std::min(partner.restitution, restitution);
    if (partner.contacts == 0) partner.first_contact = number;
    partner.is_hit = partner.is_hit || (hits && bounces(m_.contacts[number]));
    partner.is_only_one =
        hits && (partner.contacts == 0 || (partner.is_only_one && partner.body == body));
    partner.body = body;
    ++partner.contacts;
  }
  bool meets_only(int body, int other) const {
    if (!moves_freely(body)) return true;
    const Partner& partner = m_.partners[at(body)];
    return partner.is_only_one && partner.body == other &&
           !m_.carried_boxes.is_carried(m_.bodies.box(body));
  }
  bool is_first_of_lone_pair(std::size_t number) const {
    const SweptContact& contact = m_.contacts[number];
    const int first = contact.first.body, second = contact.second.body;
    if (!meets_only(first, second) || !meets_only(second, first)) return false;
    if (!m_.bodies.shift(contact.first).isZero(0.0) || !m_.bodies.shift(contact.second).isZero(0.0))
      return false;
    return m_.partners[at(moves_freely(first) ? first : second)].first_contact == number;
  }

  void meet(const SweptContact& contact) {
    std::array bodies = {contact.first.body, contact.second.body};
    if (!moves_freely(bodies[0])) std::swap(bodies[0], bodies[1]);
    const std::array sides = {side(bodies[0]), side(bodies[1])};
    FreeImpact impact(sides, contact.wanted, hit_together * m_.bodies.skin(bodies[0]),
                      time_step(world_.settings), world_.settings.gravity);
    switch (impact.find_time()) {
      case FreeImpact::Result::none:
        return leave(contact);
      case FreeImpact::Result::hit:
        if (bounce(impact, motion_.material(contact))) break;
        if (m_.impact_points.empty()) leave(contact);  // corners that pass beside each other
        return;
      case FreeImpact::Result::pass:
        m_.impact_points.clear();
        break;
    }
    impact.finish(m_.impact_points);
    const bool is_among_others = meets_others(impact, bodies);
    if (is_among_others || impact.meets_again(motion_.near_distance(bodies[0], bodies[1]))) {
      if (is_among_others || has_acted(bodies[0])) leave(contact);
      return;
    }
    book(impact, bodies);
    for (std::size_t i = 0; i < 2; ++i) {
      if (sides[i].moves()) move(impact, bodies, i);
    }
  }

  /// Solves for the impulses. False if the sides do not bounce in all points.
  bool bounce(FreeImpact& impact, const ContactMaterial& material) {
    if (!impact.find_points(material, m_.of_impact, m_.impact_points)) return false;
    if (material.friction > 0.0) {
      m_.impact_path.follow(m_.impact_points, material.restitution, tolerance_);
    } else {
      m_.impact_path.part_at_once(m_.impact_points, material.restitution, tolerance_);
    }
    return true;
  }

  void book(const FreeImpact& impact, const std::array<int, 2>& bodies) {
    m_.work += impact.work();
    for_each_contact(bodies[0], [&](std::size_t i) {
      m_.contacts[i].has_met = true;
      m_.work -= m_.work_of_start[i];
      m_.work_of_start[i] = 0.0;
    });
    for (const ImpactPoint& point : m_.impact_points) {
      m_.met_freely.push_back(
          {bodies[0], bodies[1], point.at, point.impulse->normal(), point.impulse->given()});
    }
  }

  /// Of a box that has contacts with one other body.
  template <class Visit>
  void for_each_contact(int body, const Visit& visit) const {
    const Partner& partner = m_.partners[at(body)];
    std::size_t i = partner.first_contact;
    for (int left = partner.contacts; left > 0; ++i) {
      const SweptContact& contact = m_.contacts[i];
      if (contact.first.body != body && contact.second.body != body) continue;
      --left;
      visit(i);
    }
  }

  /// Whether impulses of the start have. Without them, what comes near by the end of the step is
  /// met there.
  bool has_acted(int body) const {
    bool has = false;
    for_each_contact(body, [&](std::size_t i) { has |= m_.impulses[i].normal_impulse() > 0.0; });
    return has;
  }

  bool bounces(const SweptContact& contact) const {
    return motion_.material(contact).restitution > least_restitution &&
           contact.approach > least_approach(world_.settings);
  }

  /// To the impulses at both ends of the step, or to its parts, which may meet freely.
  void leave(const SweptContact& contact) { bounces_left_ = bounces_left_ || bounces(contact); }

  /// Whether the sides may meet others in the step, or turn far.
  bool meets_others(const FreeImpact& impact, const std::array<int, 2>& bodies) const {
    const bool reaches_ground = world_.settings.ground && bodies[1] != swept_ground;
    for (std::size_t i = 0; i < 2; ++i) {
      const ImpactSide& side = impact.sides()[i];
      if (!side.moves()) continue;
      const double turn = impact.time_left() * impact.at_end(i).angular_velocity.norm();
      if (turn > allowed_turn) return true;
      if (reaches_ground && side.bounds(impact.at_end(i)).low.z() < 0.0) return true;
      const auto may_meet = [&](int other) { return !is_beside(impact, i, bodies[i], other); };
      if (m_.bodies.any_near_way(way(bodies, impact, i), {bodies[0], bodies[1]}, may_meet)) {
        return true;
      }
    }
    return false;
  }

  /// Bounds say little of boxes that are not upright.
  bool is_beside(const FreeImpact& impact, std::size_t i, int body, int other) const {
    if (!m_.bodies.is_box(other)) return false;
    const ImpactSide &of = impact.sides()[i], beside = side(other);
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
    if (stands(other)) return 0.0;
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
    add_gravity_and_drag(box, world_.settings.gravity, time_step(world_.settings));
    m_.bodies.set_end(world_, body);
  }

  ImpactSide side(int body) const {
    if (body == swept_ground) return {};
    const int box = m_.bodies.box(body);
    return {world_.rigid[at(box)], start_.rigid[at(box)], moves_freely(body),
            world_.settings.gravity};
  }

  World& world_;
  SweptMemory& m_;
  ContactMotion motion_;
  const MotionStart& start_;
  double tolerance_;  // m/s
  bool bounces_left_ = false;
};

}  // namespace

bool is_hit_twice(const World& world, SweptMemory& memory, const ContactMotion& motion,
                  double fraction) {
  if (fraction <= least_part) return false;
  const auto bounces = [&](const SweptContact& contact) {
    return motion.is_rigid(contact) && motion.material(contact).restitution > least_restitution;
  };
  const double least = least_approach(world.settings);
  const auto meets = [&](const SweptContact& contact) {
    return (is_hit(contact) || !contact.is_near) && contact.approach > least;
  };
  const auto hits = [&](const SweptContact& contact) { return meets(contact) && bounces(contact); };
  if (std::ranges::none_of(memory.contacts, hits)) return false;
  memory.partners.assign(at(memory.bodies.count()), {});
  const auto each_box = [&](const SweptContact& contact, const auto& visit) {
    const int first = contact.first.body, second = contact.second.body;
    for (const auto& [body, other] : {std::pair(first, second), std::pair(second, first)}) {
      const bool moves = memory.bodies.is_box(body) && !is_fixed(world, body);
      if (moves) visit(memory.partners[at(body)], other);
    }
  };
  bool twice = false;
  for (const SweptContact& contact : memory.contacts) {
    if (!meets(contact)) continue;
    const double restitution = motion.material(contact).restitution;
    const bool bounces_back = bounces(contact);
    each_box(contact, [&](Partner& partner, int other) {
      partner.restitution = std::min(partner.restitution, restitution);
      if (!bounces_back) return;
      partner.is_hit = true;
      twice = twice || (partner.contacts > 0 && partner.body != other);
      partner.body = other;
      ++partner.contacts;
    });
  }
  if (weight_of_hit(memory.partners) > most_boxes) return false;
  for (const SweptContact& contact : memory.contacts) {
    if (!contact.is_new || !bounces(contact)) continue;
    each_box(contact, [&](const Partner& partner, int other) {
      twice = twice || (partner.contacts > 0 && partner.body != other);
    });
  }
  return twice;
}

bool meet_freely(World& world, SweptMemory& memory, const MotionStart& start, double tolerance,
                 double fraction) {
  memory.met_freely.clear();
  if (world.rigid.empty()) return true;
  FreeImpacts impacts(world, memory, start, tolerance);
  impacts.meet();
  impacts.note_pushed_bodies();
  return fraction <= least_part || !impacts.would_gain_by_parts();
}

}  // namespace pneuma::sim
