#include "benchmarks/peer/search_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pneuma::benchmarks {
namespace {

constexpr std::array varied_voxel_sizes = {0.25, 0.5, 1.0, 2.0, 4.0};  // m
constexpr std::size_t finalists = 6;

/// As it will stand in a table: runs are chaotic enough for a fourth digit to matter.
double three_digits(double value) { return std::stod(fmt::format("{:.3g}", value)); }

class Search {
 public:
  Search(const sim::World& world, double seconds, const SearchGrid& grid, const Trial& ours)
      : world_(world), seconds_(seconds), grid_(grid) {
    result_.ours = ours;
  }

  SettingSearch run() {
    for (const auto& [substeps, iterations] : grid_.efforts) {
      search_effort({.position_iterations = iterations, .substeps = substeps});
    }
    vary_the_cheapest();
    measure_again();
    return std::move(result_);
  }

 private:
  void search_effort(BulletOptions options) {
    for (const double margin : grid_.margins) {
      options.margin = margin;
      for (const double voxel_size : grid_.voxel_sizes) {
        options.voxel_size = voxel_size;
        for (const double drag : grid_.drags) {
          options.drag = drag;
          if (!search_stiffness(options)) return;
        }
      }
    }
  }

  /// False where this costs more than what has been found.
  bool search_stiffness(BulletOptions options) {
    double gas = 1.0;
    double least_time = lost;
    for (const double stiffness : grid_.stiffnesses) {
      options.link_stiffness = stiffness;
      options.gas_fraction = gas;
      const Candidate fitted = fit_gas(options);
      gas = fitted.options.gas_fraction;
      least_time = std::min(least_time, fitted.trial.frame_seconds);
    }
    return least_time < 1.2 * cheapest();
  }

  /// The gas with which the bodies are inflated as ours are, by bisection and steps of Newton over
  /// the logarithms; from that of the options.
  Candidate fit_gas(BulletOptions options) {
    double below = std::log(least_gas), above = std::log(most_gas);
    double guess = std::clamp(std::log(options.gas_fraction), below + 0.1, above - 0.1);
    Candidate best{options, {Quality{}, lost}};
    double least_error = lost;
    for (int i = 0; i < most_fits; ++i) {
      options.gas_fraction = three_digits(std::exp(guess));
      const Trial trial = add(options);
      const double error = std::log(trial.quality.inflation / result_.ours.quality.inflation);
      if (std::abs(error) < least_error) {
        least_error = std::abs(error);
        best = {options, trial};
      }
      if (least_error < 0.3 * inflation_bound) break;
      (error > 0.0 ? above : below) = guess;
      guess -= std::isfinite(error) ? error : 1.0;  // inflation grows about as the gas does
      if (!(guess > below && guess < above)) guess = 0.5 * (below + above);
    }
    return best;
  }

  double cheapest() const {
    return result_.reaching.empty() ? lost : result_.reaching.front().trial.frame_seconds;
  }

  Trial run(const BulletOptions& options) const {
    return try_out(*simulate_by_bullet(world_, options), seconds_);
  }

  /// What reaches ours must do so with a little less and more gas too: some rest by chance.
  Trial run_thrice(BulletOptions options) const {
    const Quality& ours = result_.ours.quality;
    Trial trial = run(options);
    const double gas = options.gas_fraction;
    for (const double factor : {0.97, 1.03}) {
      if (!reaches(trial.quality, ours)) break;
      options.gas_fraction = factor * gas;
      const Quality other = run(options).quality;
      if (!reaches(other, ours)) trial.quality = other;
    }
    return trial;
  }

  Trial add(const BulletOptions& options) {
    const Trial trial = run_thrice(options);
    ++result_.tried;
    const Candidate candidate{options, trial};
    if (reaches(trial.quality, result_.ours.quality)) {
      result_.reaching.push_back(candidate);
      std::ranges::stable_sort(result_.reaching, {}, time);
    } else {
      result_.nearest.push_back(candidate);
      // Differences below a quarter of a bound do not count against the time.
      std::ranges::stable_sort(result_.nearest, {}, [&](const Candidate& one) {
        const double quarters = 4.0 * shortfall(one.trial.quality, result_.ours.quality);
        return std::pair(std::round(quarters), one.trial.frame_seconds);
      });
      result_.nearest.resize(std::min(result_.nearest.size(), finalists));
    }
    return trial;
  }

  static double time(const Candidate& candidate) { return candidate.trial.frame_seconds; }

  void vary_the_cheapest() {
    std::vector<Candidate> best = result_.reaching.empty() ? result_.nearest : result_.reaching;
    best.resize(std::min(best.size(), finalists));
    for (const Candidate& one : best) {
      BulletOptions options = one.options;
      for (const double voxel_size : varied_voxel_sizes) {
        options.voxel_size = voxel_size;
        if (voxel_size != one.options.voxel_size) add(options);
      }
      options = one.options;
      options.ground = BulletGround::plane;
      add(options);
    }
  }

  /// Least of five, taken in turns.
  void measure_again() {
    std::vector<Candidate>& best = result_.reaching;
    best.resize(std::min(best.size(), finalists));
    for (int repeat = 0; repeat < 5; ++repeat) {
      for (Candidate& one : best) {
        double& least = one.trial.frame_seconds;
        least = std::min(least, run(one.options).frame_seconds);
      }
    }
    std::ranges::stable_sort(best, {}, time);
  }

  static constexpr double lost = std::numeric_limits<double>::infinity();
  static constexpr double least_gas = 0.002;  // of ours
  static constexpr double most_gas = 30.0;
  static constexpr int most_fits = 5;

  const sim::World& world_;
  double seconds_;
  const SearchGrid& grid_;
  SettingSearch result_;
};

}  // namespace

SearchGrid search_grid(const sim::World& world) {
  SearchGrid grid = {.efforts = {{1, 1}, {1, 2}, {1, 4}, {2, 1}, {2, 2}, {4, 2}},
                     .stiffnesses = {1.0, 0.4, 0.2, 0.1, 0.05, 0.02, 0.01},
                     .margins = {0.25, 0.1},
                     .drags = {0.0, 0.05},
                     .voxel_sizes = {1.0}};
  if (world.rigid.empty() && world.soft.size() == 1) {
    grid.stiffnesses = {1.0, 0.6, 0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02, 0.01};
    grid.drags = {0.0, 0.02, 0.05};
  }
  if (!world.rigid.empty()) grid.voxel_sizes = {0.5};  // large ones blunt the corners of boxes
  if (world.rigid.size() > 20) {                       // of which a run takes seconds
    grid.efforts.resize(4);
    grid.margins.resize(1);
  }
  return grid;
}

SettingSearch search_setting(const std::string& name, const sim::World& given, double seconds,
                             const SearchGrid& grid) {
  sim::World world = given;
  world.settings.sleep_speed = 0.0;
  world.settings.integrator = sim::Integrator::rk4;
  const auto ours = simulate_by_ours(world, name);
  return Search(world, seconds, grid, try_out(*ours, seconds)).run();
}

}  // namespace pneuma::benchmarks
