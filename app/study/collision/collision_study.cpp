#include "app/study/collision/collision_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/check/run_statistics.h"
#include "app/host/clock.h"
#include "app/host/interrupt.h"
#include "app/record/statistics.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "app/world/start_overlap.h"
#include "scenes/loader/load_scene.h"
#include "sim/collision/find_exact.h"
#include "sim/collision/find_soft_soft.h"
#include "sim/collision/particles.h"
#include "sim/collision/sweep_and_prune.h"

namespace pneuma::app {
namespace {

using sim::at;
using sim::SurfaceView;

SurfaceView view(const sim::SoftBody& body) { return {body.mesh->topology, body.positions}; }

/// Of every search; the min. time is taken, which nothing else that the machine does can shorten.
constexpr int repeats = 3;

/// One setting at work, with particles that persist.
class TrackedSearch {
 public:
  explicit TrackedSearch(const SearchSetting& setting) { result_.setting = setting; }

  void begin_step() { step_seconds_.push_back(0.0); }

  void look(const sim::World& world, int first, int second, const ContactTruth& truth) {
    double least = std::numeric_limits<double>::infinity();
    sim::ParticlePair* const pair = result_.setting.search == sim::SoftSearch::particles
                                        ? &pair_of(world, first, second)
                                        : nullptr;
    if (pair) before_ = *pair;
    for (int i = 0; i < repeats; ++i) {
      if (pair) *pair = before_;
      contacts_.clear();
      const double start = thread_seconds();
      if (pair) {
        find_by_particles(world, *pair);
      } else {
        sim::find_exact(world, first, second, exact_, contacts_);
      }
      least = std::min(least, thread_seconds() - start);
    }
    step_seconds_.back() += least;
    result_.contacts += static_cast<double>(contacts_.size());
    add_score(truth, world.soft[at(first)].mesh->topology, world.soft[at(second)].mesh->topology,
              contacts_, result_.score);
  }

  SearchResult result(std::int64_t steps) const {
    SearchResult result = result_;
    if (steps == 0) return result;
    result.step_seconds = spread(step_seconds_).median;
    result.contacts /= static_cast<double>(steps);
    return result;
  }

 private:
  sim::ParticlePair& pair_of(const sim::World& world, int first, int second) {
    for (sim::ParticlePair& pair : pairs_) {
      if (pair.first == first && pair.second == second) return pair;
    }
    pairs_.push_back(sim::make_particles(first, world.soft[at(first)].mesh->topology, second,
                                         world.soft[at(second)].mesh->topology,
                                         result_.setting.particles, world.settings.seed));
    return pairs_.back();
  }

  void find_by_particles(const sim::World& world, sim::ParticlePair& pair) {
    sim::settle_particles(view(world.soft[at(pair.first)]), view(world.soft[at(pair.second)]),
                          result_.setting.particles,
                          sim::min_particle_distance(world.settings.skin_thickness), pair, places_);
    sim::find_soft_soft(world, pair, scratch_, contacts_);
  }

  SearchResult result_;
  std::vector<double> step_seconds_;
  std::vector<sim::ParticlePair> pairs_;
  sim::ParticlePair before_;
  sim::ParticleScratch places_;
  sim::SoftSoftScratch scratch_;
  sim::ExactScratch exact_;
  std::vector<sim::Contact> contacts_;
};

std::vector<SearchSetting> settings_to_try(bool few) {
  std::vector<SearchSetting> settings = {{sim::SoftSearch::exact, {}}};
  const auto add = [&](double per_vertex, int sweeps, double attraction) {
    SearchSetting setting;
    setting.particles.per_vertex = per_vertex;
    setting.particles.max_sweeps = sweeps;
    setting.particles.attraction = attraction;
    settings.push_back(setting);
  };
  if (few) {
    for (const double per_vertex : {0.125, 0.5}) {
      for (const int sweeps : {1, 10}) add(per_vertex, sweeps, 2.0);
    }
    return settings;
  }
  for (const double per_vertex : {1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1.0}) {
    for (const int sweeps : {1, 2, 5, 10, 20}) add(per_vertex, sweeps, 2.0);
  }
  for (const double attraction : {1.0, 4.0, 8.0}) add(0.125, 10, attraction);
  return settings;
}

/// Whether it differs from the default in the number of particles only.
bool runs_on_its_own(const SearchSetting& setting) {
  const sim::ParticleSettings defaults;
  return setting.particles.max_sweeps == defaults.max_sweeps &&
         setting.particles.attraction == defaults.attraction;
}

double penetration_in_own_run(scenes::Scene scene, const SearchSetting& setting) {
  scene.settings.soft_search = setting.search;
  scene.settings.particles = setting.particles;
  const RunStatistics run = run_statistics(scene, 1, OnDivergence::stop);
  if (run.divergence) throw DivergenceError(*run.divergence);
  return run.penetration.value;
}

/// The scene's own frames that fit, so that the duration stays a whole number of them.
void shorten(scenes::Scene& scene, double seconds) {
  const double rate = scene.picture.frames_per_second;
  scene.duration = std::min(scene.duration, std::max(1.0, std::floor(seconds * rate)) / rate);
}

class Runner {
 public:
  Runner(const scenes::Scene& scene, const std::vector<SearchSetting>& settings)
      : scene_(scene), world_(build_world(scene)) {
    refuse_start_overlap(scene_, world_);
    world_.settings.soft_search = sim::SoftSearch::exact;
    for (const SearchSetting& setting : settings) searches_.emplace_back(setting);
  }

  void run() {
    sim::Stepper stepper(world_);
    const auto steps =
        static_cast<std::int64_t>(std::lround(scene_.duration * world_.settings.steps_per_second));
    while (world_.steps < steps) {
      throw_if_interrupted();
      if (const auto divergence = stepper.step(world_)) {
        throw divergence_error(scene_.name, *divergence, world_);
      }
      look();
    }
  }

  std::int64_t near_steps() const { return near_steps_; }
  double seconds() const { return sim::time(world_); }
  std::vector<SearchResult> results() const {
    std::vector<SearchResult> all;
    for (const TrackedSearch& search : searches_) all.push_back(search.result(near_steps_));
    return all;
  }

 private:
  void look() {
    const double skin = world_.settings.skin_thickness;
    spheres_.clear();
    for (const sim::SoftBody& body : world_.soft) {
      spheres_.push_back(sim::bounding_sphere(body.positions, skin));
    }
    finder_.find(spheres_, pairs_);
    if (pairs_.empty()) return;
    ++near_steps_;
    for (TrackedSearch& search : searches_) search.begin_step();
    for (const auto& [first, second] : pairs_) {
      const ContactTruth truth =
          find_truth(view(world_.soft[at(first)]), view(world_.soft[at(second)]), 2.0 * skin);
      for (TrackedSearch& search : searches_) search.look(world_, first, second, truth);
    }
  }

  const scenes::Scene& scene_;
  sim::World world_;
  std::vector<TrackedSearch> searches_;
  std::int64_t near_steps_ = 0;
  std::vector<sim::BoundingSphere> spheres_;
  sim::SweepAndPrune finder_;
  std::vector<sim::BodyPair> pairs_;
};

/// "1/8" of 0.125.
std::string share_text(double share) {
  const double inverse = 1.0 / share;
  return inverse == std::round(inverse) && inverse > 1.0 ? fmt::format("1/{:.0f}", inverse)
                                                         : fmt::format("{:g}", share);
}

}  // namespace

std::string SearchSetting::name() const {
  if (search == sim::SoftSearch::exact) return "exact";
  return fmt::format("{} per vertex, {} sweeps, attraction {:g}", share_text(particles.per_vertex),
                     particles.max_sweeps, particles.attraction);
}

bool finds_what_touches(const SearchResult& result, double skin_thickness) {
  return result.score.region_share() >= required_region_share &&
         result.score.greatest_missed <= skin_thickness;
}

const SearchResult* cheapest_sufficient(const CollisionStudy& study) {
  const SearchResult* best = nullptr;
  for (const SearchResult& result : study.results) {
    if (result.setting.search == sim::SoftSearch::exact) continue;
    if (!finds_what_touches(result, study.skin_thickness)) continue;
    if (!best || result.step_seconds < best->step_seconds) best = &result;
  }
  return best;
}

std::vector<std::string> conclusions(const CollisionStudy& study) {
  std::vector<std::string> sentences;
  const SearchResult& exact = study.exact();
  if (exact.score.vertices == 0) return {"Nothing came within reach: there was nothing to find."};
  for (const SearchResult& result : study.results) {
    if (result.setting.name() != SearchSetting{}.name()) continue;
    sentences.push_back(fmt::format(
        "The paper's setting ({}) takes {:.3g} us per step, {:.3g} times exact, and finds "
        "{:.1f} % of the regions and {:.1f} % of the vertices within reach; the deepest vertex "
        "it misses is {:.3f} m within a reach of {:g} m.",
        result.setting.name(), 1e6 * result.step_seconds, result.step_seconds / exact.step_seconds,
        100.0 * result.score.region_share(), 100.0 * result.score.vertex_share(),
        result.score.greatest_missed, 2.0 * study.skin_thickness));
  }
  const SearchResult* const cheapest = cheapest_sufficient(study);
  if (!cheapest) {
    sentences.push_back(fmt::format(
        "Particles lose here: no setting finds {:.0f} % of the regions and every vertex deeper "
        "than the skin; exact does, in {:.3g} us per step.",
        100.0 * required_region_share, 1e6 * exact.step_seconds));
  } else {
    const double ratio = exact.step_seconds / cheapest->step_seconds;
    sentences.push_back(fmt::format(
        "Particles {} here: the cheapest that find {:.0f} % of the regions and every vertex "
        "deeper than the skin ({}) take {:.3g} us per step, exact {:.3g} us: {:.3g} times as long.",
        ratio > 1.0 ? "win" : "lose", 100.0 * required_region_share, cheapest->setting.name(),
        1e6 * cheapest->step_seconds, 1e6 * exact.step_seconds, ratio));
  }
  return sentences;
}

CollisionStudy study_collision(const scenes::Scene& given, const CollisionStudyOptions& options) {
  scenes::Scene scene = given;
  shorten(scene, options.seconds);
  Runner runner(scene, settings_to_try(options.few));
  runner.run();
  CollisionStudy study{scene.name, scene.settings.skin_thickness, runner.seconds(),
                       runner.near_steps(), runner.results()};
  for (SearchResult& result : study.results) {
    if (runs_on_its_own(result.setting)) {
      result.penetration = penetration_in_own_run(scene, result.setting);
    }
  }
  return study;
}

}  // namespace pneuma::app
