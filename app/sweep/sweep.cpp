#include "app/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/record/provenance.h"
#include "app/record/world_json.h"
#include "app/world/open_scene.h"
#include "scenes/loader/print_scene.h"
#include "sim/base/hash.h"

namespace pneuma::app {
namespace {

/// Between 0 and 1, of the standard library only the engine, whose numbers are the same everywhere.
double random_fraction(std::uint64_t seed, std::int64_t sample, std::size_t parameter) {
  base::Hash mixed;
  mixed.add(seed);
  mixed.add(static_cast<std::uint64_t>(sample));
  mixed.add(static_cast<std::uint64_t>(parameter));
  std::mt19937_64 engine(mixed.value());
  engine.discard(8);
  return static_cast<double>(engine() >> 11) * 0x1.0p-53;
}

std::string random_value(const Parameter& parameter, double fraction) {
  const auto [low, high] = parameter.random;
  const double value =
      parameter.logarithmic ? low * std::pow(high / low, fraction) : low + (high - low) * fraction;
  if (parameter.whole) return fmt::format("{}", std::llround(value));
  return fmt::format("{}", std::clamp(value, low, high));
}

}  // namespace

std::vector<std::string> SweepRun::overrides(const Sweep& sweep) const {
  std::vector<std::string> all = sweep.overrides;
  for (std::size_t p = 0; p < values.size(); ++p) {
    all.push_back(fmt::format("{}={}", sweep.parameters[p].key, values[p]));
  }
  return all;
}

std::int64_t run_count(const Sweep& sweep) {
  auto count = static_cast<std::int64_t>(sweep.scenes.size()) * sweep.samples;
  for (const Parameter& parameter : sweep.parameters) {
    if (!parameter.is_random()) count *= static_cast<std::int64_t>(parameter.values.size());
  }
  return count;
}

SweepRun run_of(const Sweep& sweep, std::int64_t number) {
  SweepRun run;
  run.number = number;
  run.values.resize(sweep.parameters.size());
  std::int64_t rest = number;
  const std::int64_t sample = rest % sweep.samples;
  rest /= sweep.samples;
  for (std::size_t p = sweep.parameters.size(); p-- > 0;) {
    const Parameter& parameter = sweep.parameters[p];
    if (parameter.is_random()) {
      run.values[p] = random_value(parameter, random_fraction(sweep.seed, sample, p));
      continue;
    }
    const auto count = static_cast<std::int64_t>(parameter.values.size());
    run.values[p] = parameter.values[static_cast<std::size_t>(rest % count)];
    rest /= count;
  }
  run.scene = sweep.scenes[static_cast<std::size_t>(rest)];
  run.scene_path = sweep.scene_paths[static_cast<std::size_t>(rest)];
  return run;
}

std::string sweep_fingerprint(const Sweep& sweep) {
  base::Hash hash;
  hash.add(program_json().dump());
  hash.add(sweep.text);
  for (const std::string& scene : sweep.scene_paths) {
    hash.add(scenes::scene_fingerprint(open_scene(scene, sweep.overrides)));
  }
  return hex(hash.value());
}

}  // namespace pneuma::app
