#include "benchmarks/peer/paired_run.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/world/replay.h"
#include "benchmarks/peer/bullet_world.h"
#include "sim/mesh/measure.h"
#include "sim/step/stepper.h"

namespace pneuma::benchmarks {
namespace {

/// Steps between two readings of the clock: enough for a piece of the lightest scene to be a
/// hundred times what a reading takes.
constexpr std::int64_t piece = 20;

/// Least time of each piece so far.
class LeastTimes {
 public:
  explicit LeastTimes(std::int64_t pieces)
      : least_(static_cast<std::size_t>(pieces), std::numeric_limits<double>::infinity()) {}
  void add(std::int64_t i, double seconds) {
    double& least = least_[static_cast<std::size_t>(i)];
    least = std::min(least, seconds);
  }
  double sum() const { return std::accumulate(least_.begin(), least_.end(), 0.0); }

 private:
  std::vector<double> least_;
};

/// A side's least times over the repeats, and what the last of them did.
class Side {
 public:
  Side(const sim::World& start, const PairedRunOptions& options)
      : start_(start), pieces_(piece_count(start, options)), times_(pieces_) {
    result_.steps_per_second = start.settings.steps_per_second;
  }

  /// `run_piece` steps a piece, `contacts` are those after it. The first half is not measured.
  template <class RunPiece, class CountContacts>
  void run(const RunPiece& run_piece, const CountContacts& contacts, double (*now)()) {
    std::size_t sum = 0;
    for (std::int64_t i = 0; i < pieces_; ++i) run_piece();
    for (std::int64_t i = 0; i < pieces_; ++i) {
      const double before = now();
      run_piece();
      times_.add(i, now() - before);
      sum += contacts();
    }
    result_.contacts_per_step = static_cast<double>(sum) / static_cast<double>(pieces_);
  }

  void end_with(double volume, double speed) {
    result_.volume_ratio = volume / soft_volume(start_);
    result_.end_speed = speed;
  }

  SideResult result() const {
    SideResult result = result_;
    result.seconds_per_second =
        times_.sum() / static_cast<double>(pieces_ * piece) * result_.steps_per_second;
    return result;
  }

  const sim::World& start() const { return start_; }

 private:
  static std::int64_t piece_count(const sim::World& world, const PairedRunOptions& options) {
    const double steps = 0.5 * options.seconds * world.settings.steps_per_second;
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps) / piece);
  }

  sim::World start_;
  std::int64_t pieces_;
  LeastTimes times_;
  SideResult result_;
};

double wall_seconds() {
  return std::chrono::duration<double>(app::Clock::now().time_since_epoch()).count();
}

void run_bullet(Side& side) {
  const sim::World& start = side.start();
  BulletWorld world(start, at_rest);
  const auto run_piece = [&] {
    for (std::int64_t i = 0; i < piece; ++i) world.step();
  };
  side.run(
      run_piece, [&] { return world.contact_count(); }, app::thread_seconds);
  double volume = 0.0;
  double speed = 0.0;
  for (int b = 0; b < std::ssize(start.soft); ++b) {
    volume += world.volume(b);
    speed = std::max(speed, world.mean_velocity(b).norm());
  }
  side.end_with(volume, speed);
}

void run_ours(Side& side, const std::string& name, const PairedRunOptions& options) {
  sim::World world = side.start();
  sim::StepperOptions stepping;
  stepping.threads = options.threads;
  sim::Stepper stepper(world, stepping);
  // The processor time of this thread says nothing of the others'.
  side.run([&] { app::advance(stepper, world, piece, name); },
           [&] { return stepper.contacts().size(); },
           options.threads == 1 ? app::thread_seconds : wall_seconds);
  double speed = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    speed = std::max(speed, body.velocities.rows().rowwise().mean().norm());
  }
  side.end_with(soft_volume(world), speed);
}

/// Ours, after a first run at the least rate that is stable.
Side stable_side(const std::string& name, sim::World world, sim::Integrator integrator,
                 const PairedRunOptions& options) {
  world.settings.integrator = integrator;
  const int greatest_rate = 8 * world.settings.steps_per_second;
  while (true) {
    Side side(world, options);
    try {
      run_ours(side, name, options);
      return side;
    } catch (const app::DivergenceError&) {
      world.settings.steps_per_second *= 2;
      if (world.settings.steps_per_second > greatest_rate) throw;
    }
  }
}

}  // namespace

double soft_volume(const sim::World& world) {
  double sum = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    sum += sim::volume(body.mesh->topology, body.positions);
  }
  return sum;
}

/// Nothing sleeps on either side: what a step with all its bodies takes is compared.
PairedRun run_paired(const std::string& name, const sim::World& given,
                     const PairedRunOptions& options) {
  sim::World world = given;
  world.settings.sleep_speed = 0.0;
  Side bullet(world, options);
  Side rk4 = stable_side(name, world, sim::Integrator::rk4, options);
  Side verlet = stable_side(name, world, sim::Integrator::velocity_verlet, options);
  for (int i = 0; i < options.repeats; ++i) {
    run_bullet(bullet);
    run_ours(rk4, name, options);
    run_ours(verlet, name, options);
  }
  return {name, bullet.result(), rk4.result(), verlet.result()};
}

}  // namespace pneuma::benchmarks
