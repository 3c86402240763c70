#include "sim/step/swept/swept_warm_start.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Of the shortest side of a box: points nearer than this are one, a step later.
constexpr double same_contact = 0.05;
/// Of what a step of free fall gains: a box that changes its velocity by more is not at rest.
constexpr double most_falls = 4.0;
/// Of the friction that there may be: what has more slides.
constexpr double friction_of_sticking = 0.999;

auto bodies_of_contact(const SweptContact& contact) {
  return in_order(contact.first.body, contact.second.body);
}

template <typename OfFeatures>
auto order_of_features(const OfFeatures& known) {
  return std::tuple(in_order(known.first, known.second), known.first_feature.kind,
                    known.first_feature.index, known.second_feature.kind,
                    known.second_feature.index);
}
auto order_of(const FrictionSlip& slip) { return order_of_features(slip); }
auto order_of(const FeatureImpulse& impulse) {
  return std::tuple(impulse.is_of_start, order_of_features(impulse));
}

template <typename OfFeatures>
void sort_by_features(std::vector<OfFeatures>& known) {
  std::ranges::sort(known, {}, [](const OfFeatures& k) { return order_of(k); });
}

/// What is known of the same features; null, if nothing is.
template <typename OfFeatures>
OfFeatures* find_same(std::vector<OfFeatures>& known, const OfFeatures& wanted) {
  const auto order = [](const OfFeatures& k) { return order_of(k); };
  const auto found = std::ranges::lower_bound(known, order_of(wanted), {}, order);
  return found != known.end() && order_of(*found) == order_of(wanted) ? &*found : nullptr;
}

}  // namespace

RigidState SweptWarmStart::state(int box, Moment moment) const {
  if (moment == Moment::start) return start_.rigid[at(box)];
  const RigidBox& now = world_.rigid[at(box)];
  return {now.position, now.orientation, now.velocity, now.angular_velocity};
}

void SweptWarmStart::apply(Moment moment, double fraction) {
  apply_to_boxes(moment, fraction);
  apply_to_features(moment, fraction);
}

void SweptWarmStart::apply_to_boxes(Moment moment, double fraction) {
  first_of_pair_ = m_.contacts.size();
  for (const WarmStartImpulse& kept : world_.warm_start_impulses) {
    if (kept.is_of_start != (moment == Moment::start)) continue;
    if (SweptImpulse* impulse = find(kept, moment)) impulse->warm_start(fraction * kept.impulse);
  }
}

void SweptWarmStart::apply_to_features(Moment moment, double fraction) {
  if (world_.feature_impulses.empty()) return;
  for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
    const SweptContact& contact = m_.contacts[i];
    if (is_of_boxes(contact)) continue;
    const FeatureImpulse* kept =
        find_same(world_.feature_impulses, make_feature_impulse(contact, moment, Vec3::Zero()));
    if (kept) m_.impulses[i].warm_start(fraction * kept->impulse);
  }
}

bool SweptWarmStart::is_of_boxes(const SweptContact& contact) const {
  const int second = contact.second.body;
  return m_.bodies.is_box(contact.first.body) &&
         (second == swept_ground || m_.bodies.is_box(second));
}

FeatureImpulse SweptWarmStart::make_feature_impulse(const SweptContact& contact, Moment moment,
                                                    const Vec3& impulse) {
  return {contact.first.body,
          contact.second.body,
          contact.first.feature,
          contact.second.feature,
          impulse,
          moment == Moment::start};
}

SweptImpulse* SweptWarmStart::find(const WarmStartImpulse& kept, Moment moment) {
  const RigidState box = state(kept.first, moment);
  const Vec3 point = box.position + box.orientation * kept.point;
  double nearest = same_contact * world_.rigid[at(kept.first)].size.minCoeff();
  SweptImpulse* found = nullptr;
  const auto pair = in_order(m_.bodies.of_box(kept.first), m_.bodies.of_box(kept.second));
  // The impulses of a pair come one after the other.
  if (first_of_pair_ >= m_.contacts.size() ||
      bodies_of_contact(m_.contacts[first_of_pair_]) != pair) {
    const auto first = std::ranges::lower_bound(m_.contacts, pair, {}, bodies_of_contact);
    first_of_pair_ = static_cast<std::size_t>(first - m_.contacts.begin());
  }
  for (std::size_t i = first_of_pair_;
       i < m_.contacts.size() && bodies_of_contact(m_.contacts[i]) == pair; ++i) {
    const double distance = (m_.contacts[i].first.point - point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    found = &m_.impulses[i];
  }
  return found;
}

bool SweptWarmStart::sleeps(int first, int second) const {
  return is_asleep(world_, first) || (second != swept_ground && is_asleep(world_, second));
}

void SweptWarmStart::remember(double fraction) {
  std::erase_if(world_.warm_start_impulses, [&](const WarmStartImpulse& impulse) {
    return !sleeps(m_.bodies.of_box(impulse.first),
                   impulse.second < 0 ? swept_ground : m_.bodies.of_box(impulse.second));
  });
  std::erase_if(world_.feature_impulses, [&](const FeatureImpulse& impulse) {
    return !sleeps(impulse.first, impulse.second);
  });
  find_stopped_islands();
  remember(m_.first_contacts, m_.first_impulses, Moment::start, fraction);
  remember(m_.contacts, m_.impulses, Moment::end, fraction);
  sort_by_features(world_.feature_impulses);
}

void SweptWarmStart::remember(std::span<const SweptContact> contacts,
                              std::span<const SweptImpulse> impulses, Moment moment,
                              double fraction) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!impulses[i].may_act()) continue;
    // What stopped a body on its way is not needed again.
    if (moment == Moment::start && !contacts[i].is_near) continue;
    const Vec3 impulse = impulses[i].given() / fraction;
    if (is_of_boxes(contacts[i])) {
      remember_of_boxes(contacts[i], moment, impulse);
    } else if (contacts[i].previous < 0 && !is_stopped(contacts[i])) {
      world_.feature_impulses.push_back(make_feature_impulse(contacts[i], moment, impulse));
    }
  }
}

/// Where the step has changed the velocity of a box on something soft by more than some steps of
/// free fall: what stops it is not needed again, and of an impact more than iterations could take
/// back.
void SweptWarmStart::find_stopped_islands() {
  if (m_.first_contacts.empty() && m_.contacts.empty()) return;  // without a solution no islands
  m_.is_stopped.assign(at(m_.solver.island_count()), 0);
  const double fall = time_step(world_.settings) * world_.settings.gravity.norm();
  const double most = std::max(min_bounce_speed, most_falls * fall);
  for (const auto* contacts : {&m_.first_contacts, &m_.contacts}) {
    for (const SweptContact& contact : *contacts) {
      if (is_of_boxes(contact)) continue;
      for (const int body : {contact.first.body, contact.second.body}) {
        if (body == swept_ground || !m_.bodies.is_box(body)) continue;
        const int box = m_.bodies.box(body), island = m_.solver.island_of(body);
        const Vec3 change = world_.rigid[at(box)].velocity - start_.rigid[at(box)].velocity;
        if (island >= 0 && change.norm() > most) m_.is_stopped[at(island)] = 1;
      }
    }
  }
}

bool SweptWarmStart::is_stopped(const SweptContact& contact) {
  return std::ranges::any_of(std::array{contact.first.body, contact.second.body}, [&](int body) {
    const int island = body == swept_ground ? -1 : m_.solver.island_of(body);
    return island >= 0 && m_.is_stopped[at(island)] != 0;
  });
}

void SweptWarmStart::remember_of_boxes(const SweptContact& contact, Moment moment,
                                       const Vec3& impulse) {
  const bool on_ground = contact.second.body == swept_ground;
  const int box = m_.bodies.box(contact.first.body);
  const RigidState pose = state(box, moment);
  world_.warm_start_impulses.push_back(
      {.first = box,
       .second = on_ground ? -1 : m_.bodies.box(contact.second.body),
       .point = pose.orientation.conjugate() * (contact.first.point - pose.position),
       .impulse = impulse,
       .is_of_start = moment == Moment::start});
}

FrictionSlip* SweptWarmStart::find_slip(const SweptContact& contact) const {
  return find_same(world_.friction_slips, {contact.first.body, contact.second.body,
                                           contact.first.feature, contact.second.feature});
}

Vec3 SweptWarmStart::slip(const SweptContact& contact) const {
  const FrictionSlip* known = contact.previous < 0 ? find_slip(contact) : nullptr;
  if (!known) return Vec3::Zero();
  return known->slip - contact.normal.dot(known->slip) * contact.normal;
}

/// The slip turns with what moves the other side, or with the box.
Vec3 SweptWarmStart::turned(const SweptContact& contact, const Vec3& slip) const {
  int box = -1;
  for (const int body : {contact.first.body, contact.second.body}) {
    if (m_.bodies.is_box(body) && (box < 0 || is_kinematic(world_, body)))
      box = m_.bodies.box(body);
  }
  return box < 0 ? slip : Vec3(m_.bodies.turn(box) * slip);
}

bool SweptWarmStart::slides(const SweptContact& contact, const SweptImpulse& impulse) const {
  const double most = motion_.material(contact).friction * impulse.pressing();
  return impulse.friction_impulse().norm() >= friction_of_sticking * most;
}

void SweptWarmStart::remember_slips() {
  std::vector<FrictionSlip>& slips = m_.friction_slips;
  slips.clear();
  for (const FrictionSlip& kept : world_.friction_slips) {
    if (sleeps(kept.first, kept.second)) slips.push_back(kept);
  }
  for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
    const SweptContact& contact = m_.contacts[i];
    if (!contact.is_near || contact.previous >= 0) continue;
    if (motion_.is_rigid(contact) ? !find_slip(contact) : slides(contact, m_.impulses[i])) {
      continue;
    }
    const Vec3 moved = motion_.displacement(contact) - motion_.shift(contact);
    add_slip(contact, turned(contact, slip(contact)) + moved, slips);
  }
  keep(slips);
}

/// The two lists take turns, and the next step may need as much room.
void SweptWarmStart::keep(std::vector<FrictionSlip>& slips) {
  sort_by_features(slips);
  std::swap(slips, world_.friction_slips);
  slips.reserve(world_.friction_slips.capacity());
}

void SweptWarmStart::add_slip(const SweptContact& contact, const Vec3& slip,
                              std::vector<FrictionSlip>& slips) {
  slips.push_back({contact.first.body, contact.second.body, contact.first.feature,
                   contact.second.feature, slip});
}

/// A box that is held ends the step with the velocity that takes its slip back; one that does not
/// slides.
void SweptWarmStart::remember_held_boxes(double tolerance) {
  if (std::ranges::none_of(world_.rigid, &RigidBox::is_kinematic)) return;
  const double step = time_step(world_.settings);
  std::vector<FrictionSlip>& slips = m_.friction_slips;
  slips.clear();
  for (const FrictionSlip& kept : world_.friction_slips) {
    const bool of_boxes = m_.bodies.is_box(kept.first) && m_.bodies.is_box(kept.second);
    if (!of_boxes || sleeps(kept.first, kept.second)) slips.push_back(kept);
  }
  for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
    const SweptContact& contact = m_.contacts[i];
    if (!contact.is_near || !motion_.is_rigid(contact) || !motion_.is_driven(contact)) continue;
    const Vec3 known = slip(contact), taken_back = -known / step;
    const Vec3 velocity = m_.end_velocities[i] + m_.impulses[i].change();
    const Vec3 sliding = velocity - contact.normal.dot(velocity) * contact.normal;
    if ((sliding - taken_back).norm() > taken_back.norm() + tolerance) continue;
    add_slip(contact, known, slips);
  }
  keep(slips);
}

void forget_other_bodies(World& world) {
  const auto is_of = [](std::size_t bodies, const auto& known) {
    return known.empty() || known.size() == bodies;
  };
  const auto boxes = static_cast<int>(world.rigid.size());
  const bool knows_its_boxes =
      std::ranges::all_of(world.warm_start_impulses, [&](const WarmStartImpulse& impulse) {
        return std::max(impulse.first, impulse.second) < boxes;
      });
  if (knows_its_boxes && is_of(at(body_count(world)), world.rest) &&
      is_of(world.soft.size(), world.lost_energy) &&
      is_of(at(soft_vertex_count(world)), world.quiet_places)) {
    return;
  }
  world.rest.clear();
  world.quiet_places.clear();
  world.lost_energy.clear();
  world.friction_slips.clear();
  world.feature_impulses.clear();
  world.warm_start_impulses.clear();
}

}  // namespace pneuma::sim
