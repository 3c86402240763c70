#include "sim/boxes/move_box_island.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/boxes/slow_boxes.h"
#include "sim/collision/separating_axis.h"
#include "sim/inspect/inspect.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// Of a step; each part of a step has some of them.
constexpr int substeps_per_step = 4;
/// Of the shortest side. Boxes this near each other have a contact.
constexpr double near_of_side = 0.02;
/// What lies deeper in another is moved apart by other means.
constexpr double too_deep_of_side = 0.02;
/// Of the gap that boxes keep. Nearer ones that rest are also moved apart by other means, if there
/// are no more of them than this: here they would lean on each other until they are apart.
constexpr double too_near_of_gap = 0.2;
constexpr std::size_t few_members = 50;
/// An impulse of the last step goes to a point no further away than this.
constexpr double same_point_of_side = 0.05;
/// What goes further in a step has its contacts found twice, or before each substep.
constexpr double long_way_of_side = 0.03;
/// What goes less far does not sink in unseen.
constexpr double still_way_of_side = 0.005;
/// By how much boxes may sink into each other in a step before it is repeated in as many parts as
/// it has substeps, of half the length, solved for to a tenth of the tolerance.
constexpr double sunk_of_side = 0.003;
constexpr double finer = 10.0;
/// Steps in which gravity gives the speed below which nothing bounces: what rests meets the ground
/// about as fast.
constexpr double bounce_steps = 2.0;

/// To the impulse of the nearest point of a contact, if one is no further than `same` (m) from
/// `arm`, m from the first box's centre.
void add_to_nearest(const SubstepContact& contact, const Vec3& arm, const Vec3& impulse,
                    double same, SubstepContact::Impulses& impulses) {
  double nearest = same * same;
  std::size_t found = contact.count();
  for (std::size_t i = 0; i < contact.count(); ++i) {
    const double squared = (contact.arm(i) - arm).squaredNorm();
    if (squared >= nearest) continue;
    nearest = squared;
    found = i;
  }
  if (found < contact.count()) impulses[found] += impulse;
}

}  // namespace

double BoxIslandMover::gap(const SweptBodies& bodies, const BodyPair& pair) {
  return pair.second == swept_ground ? 0.0 : bodies.skin(pair.first) + bodies.skin(pair.second);
}

/// The second is for what the first has let sink in.
std::array<BoxIslandMover::Division, 2> BoxIslandMover::divisions_of(const BoxIsland& island) {
  const double way = island.longest_way / island.thinnest;
  int parts = 1;
  if (way > long_way_of_side) parts = 2;
  if (way > 2.0 * long_way_of_side) parts = 4;
  return {
      Division{parts, substeps_per_step / parts, 1.0, way > still_way_of_side ? sunk_of_side : 0.0},
      Division{2 * substeps_per_step, 1, finer, 0.0}};
}

void BoxIslandsMoved::clear() {
  near_pairs.clear();
  contacts.clear();
  impulses.clear();
  work = driven_work = 0.0;
}

BoxIslandMover::BoxIslandMover(const World& world)
    : numbers_(world.soft.size() + world.rigid.size() + 1, -1) {}

void BoxIslandMover::begin(const World& world) {
  moved_.clear();
  list_impulses(world);
}

/// By their first box, in the order in which they are.
void BoxIslandMover::list_impulses(const World& world) {
  impulse_begin_.assign(world.rigid.size() + 1, 0);
  for (const WarmStartImpulse& one : world.warm_start_impulses) ++impulse_begin_[at(one.first) + 1];
  for (std::size_t i = 0; i < world.rigid.size(); ++i) impulse_begin_[i + 1] += impulse_begin_[i];
  filled_.assign(impulse_begin_.begin(), impulse_begin_.end());
  ordered_impulses_.resize(world.warm_start_impulses.size());
  for (int i = 0; i < static_cast<int>(world.warm_start_impulses.size()); ++i) {
    ordered_impulses_[at(filled_[at(world.warm_start_impulses[at(i)].first)]++)] = i;
  }
}

bool BoxIslandMover::move(World& world, const MotionStart& start, const SweptBodies& bodies,
                          const BoxIsland& island) {
  thinnest_ = island.thinnest;
  rests_ =
      island.longest_way <= still_way_of_side * thinnest_ && island.members.size() <= few_members;
  boxes_.clear();
  for (const int body : island.members) boxes_.push_back(&world.rigid[at(bodies.box(body))]);
  const double free = energy(world);
  double before = 0.0;
  bool is_done = false;
  for (const Division& division : divisions_of(island)) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      set_motion(*boxes_[i], start.rigid[at(bodies.box(island.members[i]))]);
    }
    before = energy(world);
    is_done = try_to_move(world, start, bodies, island, division);
    forget_numbers(island);
    if (is_done) break;
  }
  if (!is_done) {
    take_back(world, start, bodies, island);
    return false;
  }
  double after = energy(world);
  const double gained = after - before - solver_.parting_work();
  if (!is_driven_ && gained > 0.0) after -= slow_boxes(boxes_, is_held_, gained);
  moved_.work += after - free;
  moved_.driven_work += solver_.driven_work();
  report(bodies);
  return true;
}

bool BoxIslandMover::try_to_move(World& world, const MotionStart& start, const SweptBodies& bodies,
                                 const BoxIsland& island, const Division& division) {
  is_held_ = is_driven_ = false;
  is_first_part_ = true;
  last_contacts_.clear();
  pair_of_last_contact_.clear();
  substeps_per_step_ = division.parts * division.substeps;
  const double substep = time_step(world.settings) / substeps_per_step_;
  add_boxes(world, start, island, division.fineness);
  for (int part = 0; part < division.parts; ++part) {
    solver_.begin_part();
    if (!find_contacts(world, bodies, division.substeps * substep)) return false;
    solver_.run(division.substeps, substep, world.settings.gravity);
    solver_.end_part();
    is_first_part_ = false;
  }
  return division.may_sink == 0.0 || !have_sunk(division.may_sink * thinnest_);
}

/// Whether boxes lie deeper in each other than they may, and than they did.
bool BoxIslandMover::have_sunk(double allowed) {
  for (const PairOfNumbers& pair : pairs_) {
    if (pair.bodies.second == swept_ground) continue;
    const auto overlap =
        find_min_overlap(solver_.shape_now(pair.first), solver_.shape_now(pair.second));
    if (!overlap || overlap->overlap <= allowed) continue;
    const auto before = find_min_overlap(solver_.shape(pair.first), solver_.shape(pair.second));
    if (!before || before->overlap + allowed < overlap->overlap) return true;
  }
  return false;
}

void BoxIslandMover::add_boxes(World& world, const MotionStart& start, const BoxIsland& island,
                               double fineness) {
  const double substep = time_step(world.settings) / substeps_per_step_;
  const int soft = static_cast<int>(world.soft.size());
  solver_.clear(fineness);
  others_.clear();
  pairs_.clear();
  for (const int body : island.members) {
    numbers_[at(body)] =
        solver_.add(world.rigid[at(body - soft)], start.rigid[at(body - soft)], substep);
  }
  for (const BodyPair& pair : island.pairs) {
    pairs_.push_back(
        {pair, number_of(world, start, pair.first), number_of(world, start, pair.second)});
  }
}

/// The ground's is behind those of the bodies.
int BoxIslandMover::number_of(const World& world, const MotionStart& start, int body) {
  int& number = body == swept_ground ? numbers_.back() : numbers_[at(body)];
  if (number >= 0) return number;
  others_.push_back(body);
  if (body == swept_ground) return number = solver_.add_ground();
  const std::size_t box = at(body) - world.soft.size();
  return number = solver_.add_driven(world.rigid[box], start.rigid[box]);
}

void BoxIslandMover::forget_numbers(const BoxIsland& island) {
  for (const int body : island.members) numbers_[at(body)] = -1;
  for (const int body : others_) (body == swept_ground ? numbers_.back() : numbers_[at(body)]) = -1;
}

void BoxIslandMover::take_back(World& world, const MotionStart& start, const SweptBodies& bodies,
                               const BoxIsland& island) {
  for (const int body : island.members) {
    const int box = bodies.box(body);
    integrate_rigid_again(world, box, start.rigid[at(box)]);
  }
}

/// m: what is further away than this does not touch within so many seconds.
double BoxIslandMover::reach(const PairOfNumbers& pair, double seconds, const Vec3& gravity) const {
  const SubstepBox& a = solver_.box(pair.first);
  const SubstepBox& b = solver_.box(pair.second);
  const auto turns = [&](const SubstepBox& box, int number) {
    return std::sqrt(dot(box.angular_velocity, box.angular_velocity)) *
           solver_.shape(number).half.norm();
  };
  const Vec4d moves = a.velocity - b.velocity;
  const double speed = std::sqrt(dot(moves, moves)) + turns(a, pair.first) + turns(b, pair.second);
  const double of_first = 2.0 * solver_.shape(pair.first).half.minCoeff();
  const double of_second = 2.0 * solver_.shape(pair.second).half.minCoeff();
  const double shortest =
      pair.bodies.second == swept_ground ? of_first : std::min(of_first, of_second);
  const double gained = a.is_driven() || b.is_driven() ? gravity.norm() * seconds : 0.0;
  return near_of_side * shortest + seconds * (speed + gained);
}

/// False if boxes lie too deep in each other.
bool BoxIslandMover::find_contacts(const World& world, const SweptBodies& bodies, double seconds) {
  std::swap(last_contacts_, solver_.contacts());
  std::swap(pair_of_last_contact_, pair_of_contact_);
  solver_.contacts().clear();
  pair_of_contact_.clear();
  next_last_contact_ = 0;
  const double too_deep = too_deep_of_side * thinnest_;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const PairOfNumbers& pair = pairs_[i];
    const double near = reach(pair, seconds, world.settings.gravity);
    const bool on_ground = pair.bodies.second == swept_ground;
    const auto contact =
        on_ground ? find_ground_manifold(near, solver_.shape(pair.first))
                  : find_box_manifold(near, solver_.shape(pair.first), solver_.shape(pair.second));
    if (!contact) continue;
    if (contact->depth > too_deep) return false;
    if (rests_ && !on_ground && contact->depth > -too_near_of_gap * gap(bodies, pair.bodies)) {
      return false;
    }
    add_contact(world, bodies, i, *contact);
  }
  return true;
}

void BoxIslandMover::add_contact(const World& world, const SweptBodies& bodies, std::size_t pair,
                                 const BoxContact& found) {
  const auto& [of_bodies, first, second] = pairs_[pair];
  const bool on_ground = of_bodies.second == swept_ground;
  const ContactMaterial& of_first = world.rigid[at(bodies.box(of_bodies.first))].surface;
  const ContactMaterial material =
      combine(of_first, on_ground ? *world.settings.ground
                                  : world.rigid[at(bodies.box(of_bodies.second))].surface);
  const double min_bounce =
      std::max(min_bounce_speed, material.restitution * bounce_steps *
                                     world.settings.gravity.norm() * time_step(world.settings));
  const SubstepBox& a = solver_.box(first);
  const SubstepBox& b = solver_.box(second);
  for (const SubstepBox* box : {&a, &b}) {
    if (!box->is_driven()) continue;
    is_held_ = true;
    is_driven_ = is_driven_ || dot(box->velocity, box->velocity) > 0.0 ||
                 dot(box->angular_velocity, box->angular_velocity) > 0.0;
  }
  SubstepContact& contact = solver_.contacts().emplace_back(
      first, second, a, b, found, gap(bodies, of_bodies), material, min_bounce);
  pair_of_contact_.push_back(pair);
  if (is_first_part_) {
    start_from_last_step(world, bodies, of_bodies, contact);
  } else {
    start_from_last_part(pair, contact);
  }
}

/// Each point starts from the impulse of the nearest point of the same boxes.
void BoxIslandMover::start_from_last_step(const World& world, const SweptBodies& bodies,
                                          const BodyPair& pair, SubstepContact& contact) {
  const int first = bodies.box(pair.first);
  const int second = pair.second == swept_ground ? -1 : bodies.box(pair.second);
  const OrientedBox& shape = solver_.shape(contact.first());
  SubstepContact::Impulses impulses;
  impulses.fill(Vec3::Zero());
  const double same = same_point_of_side * thinnest_;
  for (int i = impulse_begin_[at(first)]; i < impulse_begin_[at(first) + 1]; ++i) {
    const WarmStartImpulse& one = world.warm_start_impulses[at(ordered_impulses_[at(i)])];
    if (one.second != second) continue;
    add_to_nearest(contact, shape.axes * one.point, one.impulse / substeps_per_step_, same,
                   impulses);
  }
  contact.start_from(impulses);
}

void BoxIslandMover::start_from_last_part(std::size_t pair, SubstepContact& contact) {
  const double same = same_point_of_side * thinnest_;
  SubstepContact::Impulses impulses;
  impulses.fill(Vec3::Zero());
  std::size_t& i = next_last_contact_;
  while (i < last_contacts_.size() && pair_of_last_contact_[i] < pair) ++i;
  if (i == last_contacts_.size() || pair_of_last_contact_[i] != pair) return;
  const SubstepContact::Impulses before = last_contacts_[i].impulses();
  for (std::size_t point = 0; point < last_contacts_[i].count(); ++point) {
    add_to_nearest(contact, last_contacts_[i].arm(point), before[point], same, impulses);
  }
  contact.start_from(impulses);
}

/// J, of the members.
double BoxIslandMover::energy(const World& world) const {
  double sum = 0.0;
  for (const RigidBox* box : boxes_) sum += sim::energy(*box, world.settings.gravity).total();
  return sum;
}

void BoxIslandMover::report(const SweptBodies& bodies) {
  const auto side = [&](int body) {
    return body == swept_ground ? ContactSide{}
                                : ContactSide{SideKind::rigid, bodies.box(body), {}};
  };
  for (std::size_t i = 0; i < solver_.contacts().size(); ++i) {
    const SubstepContact& contact = solver_.contacts()[i];
    const BodyPair& pair = pairs_[pair_of_contact_[i]].bodies;
    if (pair.second != swept_ground) moved_.near_pairs.push_back(pair);
    if (!contact.presses()) continue;
    const SubstepContact::Impulses impulses = contact.impulses();
    const int first = bodies.box(pair.first);
    const OrientedBox& shape = solver_.shape(contact.first());
    const int second = pair.second == swept_ground ? -1 : bodies.box(pair.second);
    for (std::size_t point = 0; point < contact.count(); ++point) {
      if (impulses[point].isZero(0.0)) continue;
      const Vec3 arm = contact.arm(point);
      moved_.impulses.push_back(
          {first, second, shape.axes.transpose() * arm, substeps_per_step_ * impulses[point]});
      moved_.contacts.push_back({.first = side(pair.first),
                                 .second = side(pair.second),
                                 .point = shape.centre + arm,
                                 .normal = contact.normal()});
    }
  }
}

}  // namespace pneuma::sim
