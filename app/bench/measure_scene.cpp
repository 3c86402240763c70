#include "app/bench/measure_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "app/host/budget.h"
#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/picture/run_camera.h"
#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "app/world/start_overlap.h"
#include "scenes/loader/apply_method.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

// The paper's program steps at 1/60 s and draws once a step.
constexpr double paper_frames_per_second = 60.0;
// A reading of the clock that is off by its resolution then falsifies a time by at most 5 %.
constexpr double least_resolutions = 20.0;
// Before anything is measured: caches are filled and the processor is at its clock speed.
constexpr double wall_warm_up = 0.1;
// So that a 5th percentile of frame times is more than the min. of them.
constexpr std::int64_t least_frames = 20;
// A step that takes longer than so many of all steps was interrupted by the system.
constexpr double undisturbed_percent = 95.0;

/// The part of a scene's run that is measured, in steps.
struct Part {
  std::int64_t begin = 0;
  std::int64_t length = 1;
};

Part measured_part(const scenes::Scene& scene, std::optional<double> warm_up) {
  const double per_second = scene.settings.steps_per_second;
  const auto all = std::max<std::int64_t>(1, std::llround(scene.duration * per_second));
  const std::int64_t half = all / 2;
  const std::int64_t begin =
      warm_up ? std::min<std::int64_t>(std::llround(*warm_up * per_second), half) : half;
  return {begin, all - begin};
}

/// Mean time of a step after the caches are warm.
double warm_up(Replay& replay) {
  const Clock::time_point start = Clock::now();
  std::int64_t steps = 0;
  double elapsed = 0.0;
  do {
    replay.prepare(1);
    replay.run(1);
    ++steps;
    elapsed = seconds_since(start);
  } while (elapsed < wall_warm_up);
  return elapsed / static_cast<double>(steps);
}

void measure_steps(Replay& replay, const MeasureOptions& options, SceneTimes& times) {
  const double mean = warm_up(replay);
  const double least = least_resolutions * clock_resolution();
  times.steps_per_reading = std::max(1, static_cast<int>(std::ceil(least / mean)));
  const int batch = times.steps_per_reading;
  replay.restart();

  std::vector<double> readings;
  const Budget budget(options.steps, options.seconds, 1);
  const Clock::time_point wall_start = Clock::now();
  const double thread_start = thread_seconds();
  while (budget.more(times.steps)) {
    replay.prepare(batch);
    const Clock::time_point start = Clock::now();
    replay.run(batch);
    readings.push_back(seconds_since(start) / batch);
    times.contacts.add(replay.stepper().contacts());
    times.steps += batch;
  }
  if (options.threads == 1) {  // of several threads, one also waits for the others
    times.processor_share = (thread_seconds() - thread_start) / seconds_since(wall_start);
  }
  times.step_seconds = spread(std::move(readings));
}

/// The fraction of each stage in the sum over all undisturbed steps.
sim::StageTimes shares(const std::vector<sim::StageTimes>& steps) {
  const auto sum = [](const sim::StageTimes& times) {
    return std::accumulate(times.begin(), times.end(), 0.0);
  };
  std::vector<double> sums;
  for (const sim::StageTimes& step : steps) sums.push_back(sum(step));
  std::ranges::sort(sums);
  const double longest = percentile(sums, undisturbed_percent);

  sim::StageTimes total = {};
  for (const sim::StageTimes& step : steps) {
    if (sum(step) > longest) continue;
    for (std::size_t s = 0; s < total.size(); ++s) total[s] += step[s];
  }
  const double whole = sum(total);
  for (double& share : total) share /= whole > 0.0 ? whole : 1.0;
  return total;
}

/// In a run of its own, because the readings of the clock in between cost time themselves.
void measure_stages(Replay& replay, const MeasureOptions& options, SceneTimes& times) {
  std::vector<sim::StageTimes> steps;
  sim::StageTimes before = replay.stepper().stage_times();
  const Budget budget(options.steps, 0.25 * options.seconds, 1);
  while (budget.more(static_cast<std::int64_t>(steps.size()))) {
    replay.prepare(1);
    replay.run(1);
    const sim::StageTimes& after = replay.stepper().stage_times();
    sim::StageTimes& step = steps.emplace_back();
    for (std::size_t s = 0; s < step.size(); ++s) step[s] = after[s] - before[s];
    before = after;
  }
  times.plan = replay.stepper().plan();
  times.stage_shares = shares(steps);
}

}  // namespace

double clock_resolution() {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const Clock::time_point start = Clock::now();
    Clock::time_point next = start;
    while (next == start) next = Clock::now();
    least = std::min(least, std::chrono::duration<double>(next - start).count());
  }
  return least;
}

Spread simulation_fps(const SceneTimes& times) {
  const Spread steps_per_second = inverse(times.step_seconds);
  const double frame = times.steps_per_frame;
  return {steps_per_second.low / frame, steps_per_second.median / frame,
          steps_per_second.high / frame};
}

SceneTimes measure_scene(const scenes::Scene& scene, const MeasureOptions& options) {
  SceneTimes times;
  times.name = scene.name;
  times.title = scene.title;
  times.figure = scene.figure;
  times.paper_fps = scene.paper_fps;
  const double per_second = scene.settings.steps_per_second;
  times.steps_per_frame =
      std::max(1, static_cast<int>(std::lround(per_second / paper_frames_per_second)));

  sim::World start = build_world(scene);
  start.settings.sleep_speed = 0.0;  // a step that nothing moves in would flatter the mean
  start.settings.particles.shown = options.show.particles;
  refuse_start_overlap(scene, start);
  times.bodies = static_cast<std::int64_t>(start.soft.size() + start.rigid.size());
  const Part part = measured_part(scene, options.warm_up);
  times.measured_from = static_cast<double>(part.begin) / per_second;
  times.measured_to = static_cast<double>(part.begin + part.length) / per_second;

  sim::World world = start;
  sim::Stepper lead_in(world, {.threads = options.threads, .plan = {}});
  advance(lead_in, world, part.begin, scene.name);

  const sim::StepperOptions plain = {
      .threads = options.threads, .plan = {}, .may_leave_obstacles = true};
  sim::StepperOptions profiled = plain;
  profiled.profile = true;
  Replay steps(scene.name, world, part.length, plain);
  measure_steps(steps, options, times);
  Replay stages(scene.name, world, part.length, profiled);
  measure_stages(stages, options, times);
  if (options.pictures) {
    CameraEvents events;
    events.looked_ahead = [](const sim::World&, double) { throw_if_interrupted(); };
    RunCamera camera(scene, start, options.threads, OnDivergence::automatic, events);
    camera.look_to_the_end(start);  // not while frames are measured
    Replay frames(scene.name, world, part.length, plain);
    times.frames =
        measure_frames(frames, times.steps_per_frame, scene, camera, options.show,
                       Budget(options.steps, options.seconds, least_frames), options.backend);
  }
  return times;
}

PaperMethodFps measure_paper_method(const scenes::Scene& scene, const MeasureOptions& options) {
  if (sim::is_as_printed(scene.settings)) return {};
  for (const scenes::BodyScene& body : scene.bodies) {
    const bool is_free =
        body.kind == scenes::BodyKind::soft || body.kind == scenes::BodyKind::rigid;
    if (!is_free || !body.pinned.empty()) return {{}, "the paper's method holds and moves nothing"};
  }
  scenes::Scene as_printed = scene;
  scenes::use_paper_method(as_printed);
  if (!scene.names_step) {
    as_printed.settings.steps_per_second =
        scenes::default_steps_per_second(scene.picture.frames_per_second);
  }
  MeasureOptions simulation = options;
  simulation.pictures = false;
  simulation.show = {};
  try {
    return {simulation_fps(measure_scene(as_printed, simulation)), ""};
  } catch (const DivergenceError& error) {
    return {{}, error.what()};
  } catch (const scenes::SceneError& error) {
    return {{}, error.diagnostics().front().message};
  }
}

}  // namespace pneuma::app
