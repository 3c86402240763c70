#include "benchmarks/piles/pile_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/host/clock.h"
#include "app/world/replay.h"
#include "benchmarks/peer/bullet_settings.h"
#include "benchmarks/peer/bullet_world.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/response/fall_asleep.h"
#include "sim/step/stepper.h"

namespace pneuma::benchmarks {
namespace {

constexpr double at_rest_speed = 0.01;  // m/s

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double fastest(const sim::World& world) {
  double speed = 0.0;
  for (const sim::RigidBox& box : world.rigid) speed = std::max(speed, box.velocity.norm());
  for (const sim::SoftBody& body : world.soft) {
    speed = std::max(speed, std::sqrt(body.velocities.rows().colwise().squaredNorm().maxCoeff()));
  }
  return speed;
}

/// What is told from the states of a run, whoever made them.
class PileLog {
 public:
  PileLog(const PileWorld& pile, const PileOptions& options)
      : start_(pile.world), look_every_(options.look_every), steps_(step_count(pile)) {}

  int steps() const { return steps_; }

  void add(int step, const sim::World& world, double seconds, bool is_awake, bool touches) {
    const double now = (step + 1) / static_cast<double>(world.settings.steps_per_second);
    if (is_awake) awake_.push_back(seconds);
    if (10 * step >= 9 * steps_) end_.push_back(seconds);
    if (touches) first_contact_ = std::min(first_contact_, now);
    const double speed = fastest(world);
    if (speed > at_rest_speed) result_.rests_at = now;
    if (step + 1 == steps_) finish(world, speed);
    if (now < first_contact_ + 1.0 || step % look_every_ != 0) return;
    result_.deepest = std::max(result_.deepest, sim::max_penetration(world));
    result_.crossings += sim::crossings(world).between_bodies;
  }

  PileResult result() const {
    PileResult result = result_;
    result.awake_seconds = median(awake_);
    result.end_seconds = median(end_);
    return result;
  }

 private:
  static int step_count(const PileWorld& pile) {
    return static_cast<int>(pile.seconds * pile.world.settings.steps_per_second + 0.5);
  }

  void finish(const sim::World& world, double speed) {
    result_.end_speed = speed;
    if (speed > at_rest_speed) result_.rests_at = std::numeric_limits<double>::infinity();
    const sim::Vec3 way = world.rigid.back().position - start_.rigid.back().position;
    result_.drift = way.head<2>().norm();
  }

  const sim::World& start_;
  int look_every_;
  int steps_;
  double first_contact_ = std::numeric_limits<double>::infinity();  // s
  std::vector<double> awake_, end_;
  PileResult result_;
};

}  // namespace

PileResult run_ours(const PileWorld& pile, const PileOptions& options) {
  sim::World world = pile.world;
  if (options.without_sleep) world.settings.sleep_speed = 0.0;
  sim::Stepper stepper(world);
  PileLog log(pile, options);
  for (int i = 0; i < log.steps(); ++i) {
    const bool is_awake = !sim::is_at_rest(world);
    const double before = app::thread_seconds();
    app::advance(stepper, world, 1, pile.name);
    log.add(i, world, app::thread_seconds() - before, is_awake, !stepper.contacts().empty());
  }
  return log.result();
}

PileResult run_bullet(const PileWorld& pile, const PileOptions& options) {
  sim::World world = pile.world;
  BulletWorld bullet(world, bullet_setting(pile.name));
  PileLog log(pile, options);
  for (int i = 0; i < log.steps(); ++i) {
    const double before = app::thread_seconds();
    bullet.step();
    const double seconds = app::thread_seconds() - before;
    bullet.copy_state(world);
    log.add(i, world, seconds, true, bullet.contact_count() > 0);
  }
  return log.result();
}

}  // namespace pneuma::benchmarks
