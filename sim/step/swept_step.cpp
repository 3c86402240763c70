#include "sim/step/swept_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/soft/pins.h"
#include "sim/step/stage_runner.h"
#include "sim/step/stages/find_divergence.h"
#include "sim/step/stages/stages.h"
#include "sim/step/swept/alone_on_ground.h"
#include "sim/step/swept/end_contacts.h"
#include "sim/step/swept/excess_work.h"
#include "sim/step/swept/impacts/free_impacts.h"
#include "sim/step/swept/impacts/hits_apart.h"
#include "sim/step/swept/returned_energy.h"
#include "sim/step/swept/shift_boxes.h"
#include "sim/step/swept/start_aims.h"
#include "sim/step/swept/swept_failure.h"
#include "sim/step/swept/swept_warm_start.h"

namespace pneuma::sim {
namespace {

/// How often impulses at the start are computed before the step is halved.
constexpr int max_rounds = 4;
/// Of the thinnest skin, per whole step: velocities are solved for to this.
constexpr double solver_tolerance = 1e-3;

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
        motion_(search_.motion()),
        warm_start_(world, workspace.motion_start, m_),
        run_(workspace) {}

  /// Half steps, if the whole one fails.
  std::optional<Divergence> advance(int halvings) {
    SweptStart& start = m_.starts[at(halvings)];
    start.warm_start_impulses = world_.warm_start_impulses;
    start.feature_impulses = world_.feature_impulses;
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
    wanted_parts_ = false;
    auto failure = try_step();
    const bool would_do = wanted_parts_;
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
    world_.feature_impulses = start.feature_impulses;
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
      search_.find_boxes_between_walls();
      const bool fell = let_boxes_fall();
      const bool shifted = shift_near_boxes(world_, m_, search_, fraction_);
      if (fell || shifted) search_.follow_ends();
      search_.start();
    });
    if (!m_.touched_asleep.empty()) return touched_asleep();
    if (auto squeezed = find_squeezed_box(world_, m_)) return squeezed;
    std::size_t first_new = 0;  // contact that was not yet solved for
    int rounds = max_rounds;
    for (int round = 0; round < rounds; ++round) {
      bool collides = false;
      if (!m_.contacts.empty()) {
        std::optional<Divergence> failed;
        run_(Stage::resolve_contacts, [&] {
          aim_at_distances(world_, start(), m_, warm_start_, fraction_ / w_.options.parts);
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
      run_(Stage::find_contacts, [&] {
        collides = search_.find_collisions();
        // Parts of a step, in which boxes turn by less, are for those that this does not help.
        const bool may_aim_again = fraction_ == 1.0 && rounds == max_rounds;
        if (collides || !may_aim_again || !search_.find_missed()) return;
        ++rounds;
        collides = true;
      });
      if (!m_.touched_asleep.empty()) return touched_asleep();
      const bool was_last = round + 1 == rounds;
      if (!collides || (was_last && !search_.blocked())) {
        if (wants_parts()) return want_parts();
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

  std::optional<Divergence> finish() {
    count_work_of_start();
    warm_start_.remember_slips();
    m_.work += keep_angular_momentum(world_, m_);
    const bool met = meet_freely(world_, m_, start(), tolerance(), fraction_);
    if (!met && tells_hits_apart_) return want_parts();
    std::swap(m_.first_contacts, m_.contacts);
    std::swap(m_.first_impulses, m_.impulses);
    m_.contacts.clear();
    m_.impulses.clear();
    m_.end_velocities.clear();
    m_.given_at_start.clear();
    bodies_.begin_at_end(world_);
    if (world_.settings.ground) {
      m_.work += resolve_alone_on_ground(world_, start(), search_, m_, w_.contacts);
      m_.work += lift_sunk_vertices(world_, m_);
    }
    find_end_contacts(world_, start(), m_, warm_start_);
    if (wants_parts()) return want_parts();
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
    warm_start_.remember_held_boxes(tolerance());
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
    const Vec3 before = motion_.start_velocity(contact);
    if (motion_.is_rigid(contact) || !moves_by_new_velocity(world_.settings.integrator)) {
      return m_.impulses[i].work(before);
    }
    const Vec3 after = (motion_.displacement(contact) - motion_.shift(contact)) / step();
    return 0.5 * m_.impulses[i].given().dot(before + after);
  }

  /// J, of what moves a side of the contact: by its velocity, while the work of contacts is by that
  /// of one side against the other.
  double driven_work(std::size_t contact, Moment moment) const {
    return m_.impulses[contact].given().dot(motion_.driven_velocity(m_.contacts[contact], moment));
  }

  /// Words, which need memory, are for steps that cannot.
  bool can_be_halved() const { return fraction_ > std::ldexp(1.0, -max_halvings); }

  /// Of the contact that has given most.
  Divergence added_energy(const Excess& excess) const {
    if (can_be_halved()) return {Stage::resolve_contacts, world_.steps + 1, {}, {}};
    const auto impulses = m_.solver.impulses_of(excess.island);
    const SweptImpulse* most = std::ranges::max(
        impulses, {}, [](const SweptImpulse* impulse) { return impulse->normal_impulse(); });
    const SweptContact& contact = m_.contacts[m_.contact_of(most)];
    return of_added_energy(world_, bodies_, contact, excess.left);
  }

  /// Parts of the step tell its impacts apart, or find when a box tips.
  Divergence want_parts() {
    wanted_parts_ = true;
    return {Stage::resolve_contacts, world_.steps + 1, {}, {}};
  }
  bool wants_parts() const {
    return tells_hits_apart_ &&
           (is_hit_twice(world_, m_, motion_, fraction_) || is_tipped_onto(world_, m_, fraction_));
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
  const ContactMotion& motion_;
  SweptWarmStart warm_start_;
  StageRunner run_;
  double fraction_ = 1.0;  // of a whole step
  bool was_halved_ = false;
  bool tells_hits_apart_ = true;  // by parts of the step
  bool wanted_parts_ = false;     // in the last try
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
