#include "sim/step/swept_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/soft/pins.h"
#include "sim/step/alone_on_ground.h"
#include "sim/step/find_divergence.h"
#include "sim/step/free_impacts.h"
#include "sim/step/returned_energy.h"
#include "sim/step/shift_boxes.h"
#include "sim/step/stage_runner.h"
#include "sim/step/stages.h"
#include "sim/step/swept_warm_start.h"

namespace pneuma::sim {
namespace {

/// How often impulses at the start are computed before the step is halved.
constexpr int max_rounds = 4;
/// Of the thinnest skin, per whole step: velocities are solved for to this.
constexpr double solver_tolerance = 1e-3;
/// Of what a step of free fall gains: what arrives at the end of a step bounces by no less.
constexpr double least_of_falls = 4.0;
/// Of the distance wanted: what a step leaves of it between boxes that it brings together. More
/// than it is solved for, so that they do not cross.
constexpr double least_of_wanted = 0.02;

/// Those that have candidates.
void list_paired_bodies(SweptMemory& memory) {
  memory.paired.clear();
  for (const SweptCandidate& candidate : memory.candidates) {
    if (memory.paired.empty() || memory.paired.back() != candidate.bodies) {
      memory.paired.push_back(candidate.bodies);
    }
  }
}

class SweptStep {
 public:
  SweptStep(World& world, StepWorkspace& workspace)
      : world_(world),
        w_(workspace),
        m_(*workspace.swept),
        bodies_(m_.bodies),
        search_(world, workspace.motion_start, m_),
        warm_start_(world, workspace.motion_start, m_),
        run_(workspace) {}

  /// Half steps, if the whole one fails.
  std::optional<Divergence> advance(int halvings) {
    SweptStart& start = m_.starts[at(halvings)];
    start.warm_start_impulses = world_.warm_start_impulses;
    start.friction_slips = world_.friction_slips;
    start.lost_energy = world_.lost_energy;
    const double work = m_.work, driven_work = m_.driven_work;
    const std::size_t contacts = w_.contacts.size();
    const std::size_t parts_done = m_.parts_done.size();
    const auto take_all_back = [&] {
      take_back(start);
      m_.parts_done.resize(parts_done);
      m_.work = work;
      m_.driven_work = driven_work;
      w_.contacts.resize(contacts);
    };
    fraction_ = std::ldexp(1.0, -halvings);
    was_hit_twice_ = false;
    auto failure = try_step();
    const bool would_do = was_hit_twice_;
    if (!failure) {
      m_.parts_done.push_back(fraction_);
      if (w_.options.after_part) w_.options.after_part(world_);
      return std::nullopt;
    }
    start.motion = w_.motion_start;  // which half steps change
    was_halved_ = true;
    take_all_back();
    if (failure->stage != Stage::resolve_contacts || halvings == max_halvings) return failure;
    world_.settings.steps_per_second *= 2;
    auto half = advance(halvings + 1);
    if (!half) half = advance(halvings + 1);
    world_.settings.steps_per_second /= 2;
    if (half) take_all_back();
    if (!half || !would_do) return half;
    tells_hits_apart_ = false;  // as it cannot
    return advance(halvings);
  }

  /// Of the whole step, once it is done.
  const MotionStart& whole_start() const {
    return was_halved_ ? m_.starts[0].motion : w_.motion_start;
  }

 private:
  void take_back(const SweptStart& start) {
    restore_soft(world_, start.motion.soft);
    restore_rigid(world_, start.motion.rigid);
    world_.warm_start_impulses = start.warm_start_impulses;
    world_.friction_slips = start.friction_slips;
    world_.lost_energy = start.lost_energy;
  }

  std::optional<Divergence> try_step() {
    if (auto failed = move_freely()) return failed;
    run_(Stage::find_contacts, [&] {
      bodies_.set_start(world_, start(), m_.parts_done, fraction_);
      bodies_.set_end(world_);
      search_.find_candidates();
      if (!m_.touched_asleep.empty()) return;
      bodies_.begin_at_start(world_, start());
      const bool fell = let_boxes_fall();
      const bool shifted = shift_near_boxes(world_, m_, search_, fraction_);
      if (fell || shifted) search_.follow_ends();
      search_.start();
    });
    if (!m_.touched_asleep.empty()) return touched_asleep();
    if (auto squeezed = find_squeezed_box(world_, bodies_, m_.contacts)) return squeezed;
    std::size_t first_new = 0;  // contact that was not yet solved for
    for (int round = 0; round < max_rounds; ++round) {
      bool collides = false;
      if (!m_.contacts.empty()) {
        std::optional<Divergence> failed;
        run_(Stage::resolve_contacts, [&] {
          aim_at_distances();
          if (round == 0) warm_start_.apply(Moment::start, fraction_);
          solve(first_new);
          failed = bodies_.move_again(world_, start(), w_.integrate_soft);
        });
        if (failed) {
          failed->stage = Stage::resolve_contacts;  // whose impulses it could not bear
          return failed;
        }
      }
      first_new = m_.contacts.size();
      run_(Stage::find_contacts, [&] { collides = search_.find_collisions(); });
      if (!m_.touched_asleep.empty()) return touched_asleep();
      const bool was_last = round + 1 == max_rounds;
      if (!collides || (was_last && !search_.blocked())) {
        if (hits_twice()) return hit_twice();
        std::optional<Divergence> divergence;
        run_(Stage::resolve_contacts, [&] { divergence = finish(); });
        return divergence;
      }
    }
    return blocked();
  }

  /// Soft bodies press within the step: what they carry must weigh on them within it too. And what
  /// nothing bears flies.
  bool let_boxes_fall() {
    if (world_.rigid.empty()) return false;
    list_paired_bodies(m_);
    m_.carried_boxes.find(world_, m_.paired);
    search_.find_borne_boxes();
    return bodies_.let_fall(
        world_, start(), m_.carried_boxes,
        fall_within(step(), world_.settings.integrator, world_.settings.gravity), m_.is_borne);
  }

  /// What sleeps must wake before the step can be done.
  Divergence touched_asleep() const { return {Stage::find_contacts, world_.steps + 1, {}, {}}; }

  std::optional<Divergence> move_freely() {
    std::optional<Divergence> of_soft, of_rigid;
    run_(Stage::integrate_soft,
         [&] { of_soft = integrate_soft(world_, start().soft, w_.integrate_soft, w_.workers); });
    run_(Stage::integrate_rigid, [&] { of_rigid = integrate_rigid(world_, start().rigid); });
    return of_soft ? of_soft : of_rigid;  // both have kept what they started from
  }

  void solve(std::size_t first_new) {
    if (m_.contacts.empty()) return;
    m_.solver.solve(m_.contacts, m_.impulses, tolerance(), first_new);
  }

  /// m/s. In parts of a step no more: impulses that shift what is near grow as these get shorter.
  double tolerance() const {
    return solver_tolerance * bodies_.thinnest_skin() * fraction_ / step();
  }
  MotionStart& start() { return w_.motion_start; }
  double step() const { return time_step(world_.settings); }

  /// What the impulses at the start must still change, with the motion as it came out: what moved
  /// the sides other than the impulses stays. Shifts are no motion: impulses do not resist them.
  /// What friction let slip in earlier steps it takes back.
  void aim_at_distances() {
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      const SweptContact& contact = m_.contacts[i];
      const Vec3 shift = search_.shift(contact);
      const Vec3 moved = (search_.displacement(contact) - shift) / step();
      const Vec3 free = moved - m_.impulses[i].change();
      const double parting = may_move(contact, contact.normal.dot(shift)) / step();
      const Vec3 slip = warm_start_.slip(contact) / step();
      m_.impulses[i].aim(parting - contact.normal.dot(free), free + slip);
    }
  }

  /// m, along the normal in this step and besides the `shift` (m) along it, at least: negative if
  /// there is room.
  double may_move(const SweptContact& contact, double shift) const {
    const double closer = std::max(0.0, -shift);
    if (contact.distance > contact.wanted) return closer + contact.wanted - contact.distance;
    if (contact.wanted < 0.0) return closer;  // boxes that turn past each other
    if (contact.is_of_near_boxes || on_ground_as_box(contact)) {
      // Shifts do the rest. What presses boxes together must not take them back.
      const bool is_held = shift > 0.0 || is_carried(contact.first) || is_carried(contact.second);
      const double least = contact.is_of_near_boxes ? least_of_wanted * contact.wanted : 0.0;
      const double room = is_held ? -missing_distance(contact) : contact.distance - least;
      return closer - std::max(0.0, room);
    }
    // Springs take back most of what holds up a vertex that others press into the ground.
    const double made_up = contact.second.body == swept_ground ? 1.0 : made_up_per_step;
    return closer + made_up * std::max(0.0, missing_distance(contact));
  }

  bool is_carried(const SurfacePoint& box) const {
    return box.body != swept_ground && m_.carried_boxes.is_carried(bodies_.box(box.body));
  }

  bool on_ground_as_box(const SweptContact& contact) const {
    return contact.second.body == swept_ground && search_.is_rigid(contact);
  }

  std::optional<Divergence> finish() {
    count_work_of_start();
    warm_start_.remember_slips(search_);
    m_.work += keep_angular_momentum(world_, m_);
    const bool met = meet_freely(world_, m_, search_, start(), tolerance(), fraction_);
    if (!met && tells_hits_apart_) return hit_twice();
    std::swap(m_.first_contacts, m_.contacts);
    std::swap(m_.first_impulses, m_.impulses);
    m_.contacts.clear();
    m_.impulses.clear();
    m_.end_velocities.clear();
    m_.given_at_start.clear();
    bodies_.begin_at_end(world_);
    if (world_.settings.ground) {
      m_.work += resolve_alone_on_ground(world_, search_, w_);
      m_.work += lift_sunk_vertices(world_, w_);
    }
    touch_at_end();
    if (hits_twice()) return hit_twice();
    warm_start_.apply(Moment::end, fraction_);
    solve(0);
    follow_impacts(m_, tolerance());
    limit_returned_energy(m_, tolerance());
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      m_.work += m_.impulses[i].work(m_.end_velocities[i]);
      m_.driven_work += driven_work(i, Moment::end);
    }
    bodies_.add_changes(world_);
    const Excess excess = take_back_excess_work(world_, start(), m_, tolerance());
    if (excess.left > 0.0) return added_energy(excess);
    m_.work -= excess.taken;
    warm_start_.remember(fraction_);
    warm_start_.remember_held_boxes(search_, tolerance());
    list_pressing(m_, w_.contacts);
    list_held_on_ground(world_, m_, w_.contacts);
    if (w_.has_pins) hold_pins(world_, start().soft, w_.integrate_soft);
    return find_first_divergence(world_, w_.resolve_contacts.outcomes, w_.workers);
  }

  void count_work_of_start() {
    m_.work_of_start.clear();
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      m_.work_of_start.push_back(work_of_start(i));
      m_.work += m_.work_of_start.back();
      m_.driven_work += driven_work(i, Moment::start);
    }
  }

  /// J. Where the velocity v' at the end of a step moves soft bodies in all of it, the change of
  /// m v^2 / 2 is (J + F h) (v + v') / 2, and an impulse J at the start has its share: none at
  /// rest, where its velocity is what the forces F take again.
  double work_of_start(std::size_t i) const {
    const SweptContact& contact = m_.contacts[i];
    const Vec3 before = search_.start_velocity(contact);
    if (search_.is_rigid(contact) || !moves_by_new_velocity(world_.settings.integrator)) {
      return m_.impulses[i].work(before);
    }
    const Vec3 after = (search_.displacement(contact) - search_.shift(contact)) / step();
    return 0.5 * m_.impulses[i].given().dot(before + after);
  }

  /// J, of what moves a side of the contact: by its velocity, while the work of contacts is by that
  /// of one side against the other.
  double driven_work(std::size_t contact, Moment moment) const {
    return m_.impulses[contact].given().dot(search_.driven_velocity(m_.contacts[contact], moment));
  }

  /// What a pair of features has been given at the start.
  struct Given {
    bool is_known = false;
    bool is_of_end = false;  // the speed with which they meet
    bool is_near = false;    // of the first contact that they made
    double approach = 0.0;   // m/s, of that
    double drift = 0.0;      // m/s, of that
    double normal = 0.0;     // N s, of all
    Vec3 friction = Vec3::Zero();
    Vec3 impulse = Vec3::Zero();  // N s, of all, along the normals that they had
  };

  bool has_met(const SweptCandidate& candidate) const {
    return candidate.contact >= 0 && m_.first_contacts[at(candidate.contact)].has_met;
  }

  Given given_at_start(const SweptCandidate& candidate) const {
    Given given;
    for (int i = candidate.contact; i >= 0; i = m_.first_contacts[at(i)].previous) {
      given.is_known = true;
      given.is_near = m_.first_contacts[at(i)].is_near;
      given.approach = m_.first_contacts[at(i)].approach;
      given.drift = m_.first_contacts[at(i)].drift;
      given.normal += m_.first_impulses[at(i)].normal_impulse();
      given.friction += m_.first_impulses[at(i)].friction_impulse();
      given.impulse += m_.first_impulses[at(i)].given();
    }
    return given;
  }

  void touch_at_end() {
    const auto all = std::span(m_.candidates);
    for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
      const BodyPair bodies = all[first].bodies;
      while (end < all.size() && all[end].bodies == bodies) ++end;
      touch_at_end(all.subspan(first, end - first));
    }
  }

  /// Of two bodies. The points of faces that come together differ by what is left of a solution;
  /// boxes of which one corner alone were hit would turn.
  void touch_at_end(std::span<const SweptCandidate> candidates) {
    const std::size_t before = m_.contacts.size();
    for (const SweptCandidate& candidate : candidates) {
      if (!has_met(candidate)) touch(candidate);
    }
    const auto touched = std::span(m_.contacts).subspan(before);
    if (touched.empty() || !search_.is_rigid(touched.front())) return;
    if (std::ranges::none_of(touched, is_hit)) return;
    for (const SweptCandidate& candidate : candidates) {
      if (!has_met(candidate)) hit_as_well(candidate);
    }
  }

  /// What touches at the end does not approach, or bounces. An impulse of the start whose features
  /// did not meet is given back.
  void touch(const SweptCandidate& candidate) {
    const auto [first, second] = candidate.bodies;
    const Given before = given_at_start(candidate);
    const bool acted = before.normal > 0.0;
    auto contact = search_.place_at_end(candidate, acted);
    if (!contact) return;
    const ContactMaterial both = search_.material(*contact);
    const bool rubs = contact->is_near || (acted && before.is_near);
    SweptImpulse impulse = search_.impulse(*contact, rubs ? both.friction : 0.0);
    if (acted) impulse.start_from(before.normal, before.friction);
    if (!contact->is_near) impulse.only_give_back();
    contact->is_new = !before.is_known;
    const bool arrives = !acted && search_.is_rigid(*contact) && flew(first) && flew(second);
    set_parting(arrives ? hit_at_end(*contact, true) : before, both.restitution, *contact);
    add_at_end(*contact, impulse, before.impulse);
  }

  /// Nothing has pushed it in this step: it has the speed with which it arrives.
  bool flew(int body) const { return body == swept_ground || m_.is_pushed[at(body)] == 0; }

  /// `alone`: no other point of the two bodies says that they are hit.
  Given hit_at_end(const SweptContact& contact, bool alone) const {
    const double approach = -contact.normal.dot(search_.end_velocity(contact));
    return {.is_known = true, .is_of_end = alone, .approach = approach};
  }

  void hit_as_well(const SweptCandidate& candidate) {
    if (given_at_start(candidate).normal > 0.0) return;
    auto contact = search_.place_beside_hit(candidate);
    if (!contact) return;
    const ContactMaterial both = search_.material(*contact);
    set_parting(hit_at_end(*contact, false), both.restitution, *contact);
    if (!is_hit(*contact)) return;
    add_at_end(*contact, search_.impulse(*contact, both.friction), Vec3::Zero());
  }

  void add_at_end(const SweptContact& contact, SweptImpulse impulse, const Vec3& given_at_start) {
    const Vec3 velocity = search_.end_velocity(contact);
    Vec3 sliding = velocity;
    if (search_.is_rigid(contact)) sliding += warm_start_.slip(contact) / step();
    impulse.aim(contact.parting - contact.normal.dot(velocity), sliding);
    m_.contacts.push_back(contact);
    m_.impulses.push_back(impulse);
    m_.end_velocities.push_back(velocity);
    m_.given_at_start.push_back(given_at_start);
  }

  /// m/s. A box that gravity brings back within the step does not bounce: it would fall by other
  /// ways as it leaves and as it comes back, and bounce for ever. At the end of a step, and of what
  /// is near as it begins, the speed may be that of such a fall, more than once if it turns.
  double least_bounce(const Given& before, const SweptContact& contact) const {
    if (!search_.is_rigid(contact)) return min_bounce_speed;
    const double fallen = step() * world_.settings.gravity.norm();
    const bool may_be_fall = before.is_of_end || before.is_near;
    return std::max(min_bounce_speed, may_be_fall ? least_of_falls * fallen : 0.5 * fallen);
  }

  void set_parting(const Given& before, double restitution, SweptContact& contact) const {
    const double bounce = restitution * before.approach;
    // Soft bodies that touch at the start are pressed together, whatever their vertices' speed.
    const bool may_bounce = before.is_known && (!before.is_near || search_.is_rigid(contact));
    if (!contact.is_near) {
      contact.parting = -before.approach;
      contact.returns_energy = true;
    } else if (may_bounce && bounce >= least_bounce(before, contact)) {
      contact.approach = before.approach;
      contact.drift = before.drift;
      contact.restitution = restitution;
      contact.parting = bounce - before.drift;  // of what is borne: it moves by its first velocity
      contact.returns_energy = true;
    }
  }

  /// Words, which need memory, are for steps that cannot.
  bool can_be_halved() const { return fraction_ > std::ldexp(1.0, -max_halvings); }

  /// Of the contact that has given most.
  Divergence added_energy(const Excess& excess) const {
    if (can_be_halved()) return {Stage::resolve_contacts, world_.steps + 1, {}, {}};
    const auto impulses = m_.solver.impulses_of(excess.island);
    const SweptImpulse* most = std::ranges::max(
        impulses, {}, [](const SweptImpulse* impulse) { return impulse->normal_impulse(); });
    const SweptContact& contact = m_.contacts[at(static_cast<int>(most - m_.impulses.data()))];
    return of_added_energy(world_, bodies_, contact, excess.left);
  }

  /// Parts of the step tell its impacts apart.
  Divergence hit_twice() {
    was_hit_twice_ = true;
    return {Stage::resolve_contacts, world_.steps + 1, {}, {}};
  }
  bool hits_twice() const {
    return tells_hits_apart_ && is_hit_twice(world_, m_, search_, fraction_);
  }

  Divergence blocked() const {
    if (can_be_halved()) return {Stage::resolve_contacts, world_.steps + 1, {}, {}};
    return of_blocked_bodies(world_, bodies_, *search_.blocked());
  }

  World& world_;
  StepWorkspace& w_;
  SweptMemory& m_;
  SweptBodies& bodies_;
  SweptSearch search_;
  SweptWarmStart warm_start_;
  StageRunner run_;
  double fraction_ = 1.0;  // of a whole step
  bool was_halved_ = false;
  bool tells_hits_apart_ = true;  // by parts of the step
  bool was_hit_twice_ = false;    // in the last try
};

/// Returns whether there were any.
bool wake_what_was_touched(World& world, SweptMemory& memory) {
  for (const int body : memory.touched_asleep) wake(world, body);
  return !memory.touched_asleep.empty();
}

void put_to_sleep(World& world, const MotionStart& start, StepWorkspace& workspace) {
  SweptMemory& m = *workspace.swept;
  if (!m.fall_asleep.count_quiet_steps(world, start)) return;
  list_paired_bodies(m);
  m.work -= m.fall_asleep.put_to_sleep(world, m.paired, workspace.contacts);
}

}  // namespace

std::optional<Divergence> swept_step(World& world, StepWorkspace& workspace) {
  SweptMemory& m = *workspace.swept;
  m.work = m.driven_work = 0.0;
  workspace.contacts.clear();
  forget_other_bodies(world);
  m.rest = world.rest;
  m.bodies.begin_step(world);
  wake_moving(world);
  if (is_at_rest(world) && !m.bodies.any_driven_moves()) return std::nullopt;
  while (true) {
    m.touched_asleep.clear();
    m.parts_done.clear();
    SweptStep step(world, workspace);
    const auto divergence = step.advance(0);
    if (wake_what_was_touched(world, m)) continue;
    if (divergence) {
      world.rest = m.rest;
    } else {
      put_to_sleep(world, step.whole_start(), workspace);
    }
    return divergence;
  }
}

}  // namespace pneuma::sim
