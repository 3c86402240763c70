#include "benchmarks/peer/paired_run.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

#include "app/host/clock.h"
#include "app/host/errors.h"

namespace pneuma::benchmarks {
namespace {

/// Steps between two readings of the clock: enough for a piece of the lightest scene to be a
/// hundred times what a reading takes.
constexpr int piece = 20;

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

double wall_seconds() {
  return std::chrono::duration<double>(app::Clock::now().time_since_epoch()).count();
}

/// A side's least times over the repeats, and what the last of them did.
class Side {
 public:
  using Start = std::function<std::unique_ptr<Simulation>()>;

  Side(const sim::Settings& settings, Start start, const PairedRunOptions& options)
      : start_(std::move(start)),
        // The processor time of this thread says nothing of the others'.
        now_(options.threads == 1 ? app::thread_seconds : wall_seconds),
        pieces_(piece_count(settings, options)),
        times_(pieces_) {
    result_.steps_per_second = settings.steps_per_second;
  }

  /// The first half is not measured.
  void run() {
    const std::unique_ptr<Simulation> simulation = start_();
    std::size_t contacts = 0;
    for (std::int64_t i = 0; i < pieces_; ++i) simulation->advance(piece);
    for (std::int64_t i = 0; i < pieces_; ++i) {
      const double before = now_();
      simulation->advance(piece);
      times_.add(i, now_() - before);
      contacts += simulation->contact_count();
    }
    result_.contacts_per_step = static_cast<double>(contacts) / static_cast<double>(pieces_);
  }

  void judge(double seconds) { result_.quality = try_out(*start_(), seconds).quality; }

  SideResult result() const {
    SideResult result = result_;
    result.seconds_per_second =
        times_.sum() / static_cast<double>(pieces_ * piece) * result_.steps_per_second;
    return result;
  }

 private:
  static std::int64_t piece_count(const sim::Settings& settings, const PairedRunOptions& options) {
    const double steps = 0.5 * options.seconds * settings.steps_per_second;
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps) / piece);
  }

  Start start_;
  double (*now_)();
  std::int64_t pieces_;
  LeastTimes times_;
  SideResult result_;
};

/// Ours, at the least rate at which it is stable and simulates as well as `other` does, if given.
Side stable_side(const std::string& name, sim::World world, sim::Integrator integrator,
                 const Quality* other, const PairedRunOptions& options) {
  world.settings.integrator = integrator;
  const auto make = [&](int rate) {
    world.settings.steps_per_second = rate;
    const auto start = [=] { return simulate_by_ours(world, name, options.threads); };
    Side side(world.settings, start, options);
    side.judge(options.seconds);
    return side;
  };
  return make(least_rate(world.settings.steps_per_second, [&](int rate) {
    try {
      const Quality quality = make(rate).result().quality;
      if (other == nullptr) return true;
      Quality nearly = *other;
      nearly.end_speed *= 1.1;  // where bodies still move, no two integrators have one speed
      return reaches(quality, nearly);
    } catch (const app::DivergenceError&) {
      return false;
    }
  }));
}

}  // namespace

int least_rate(int rate, const std::function<bool(int)>& is_good) {
  for (int factor = 1; factor < 8; factor *= 2) {
    if (is_good(factor * rate)) return factor * rate;
  }
  return 8 * rate;
}

/// Nothing sleeps on either side: what a step with all its bodies takes is compared.
PairedRun run_paired(const std::string& name, const sim::World& given,
                     const BulletOptions& bullet_options, const PairedRunOptions& options) {
  sim::World world = given;
  world.settings.sleep_speed = 0.0;
  PairedRunOptions one_thread = options;
  one_thread.threads = 1;
  Side bullet(
      world.settings, [&] { return simulate_by_bullet(world, bullet_options); }, one_thread);
  bullet.judge(options.seconds);
  Side rk4 = stable_side(name, world, sim::Integrator::rk4, nullptr, options);
  const Quality reference = rk4.result().quality;
  Side verlet = stable_side(name, world, sim::Integrator::velocity_verlet, &reference, options);
  for (int i = 0; i < options.repeats; ++i) {
    bullet.run();
    rk4.run();
    verlet.run();
  }
  return {name, bullet_options, bullet.result(), rk4.result(), verlet.result()};
}

}  // namespace pneuma::benchmarks
