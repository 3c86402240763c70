// A study of many runs as plain data: scenes, what is varied, what is measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/sweep/measures.h"

namespace pneuma::app {

/// Numbers drawn at random for each sample.
struct RandomRange {
  double low = 0.0;
  double high = 0.0;
};

/// A key of the scenes that is varied.
struct Parameter {
  std::string key;                  // as --set has it: "body.k"
  std::vector<std::string> values;  // as TOML; empty: drawn at random
  RandomRange random;
  bool logarithmic = false;  // of a range
  bool whole = false;        // rounded to whole numbers

  bool is_random() const { return values.empty(); }
};

enum class SweepFrames { none, last, all };

struct Sweep {
  std::string name;  // the file's, without its ending
  std::filesystem::path file;
  std::string text;                      // of the file
  std::vector<std::string> scenes;       // as the file has them
  std::vector<std::string> scene_paths;  // names or absolute paths, one for each
  std::vector<std::string> overrides;    // of every run, "PATH=VALUE"
  std::vector<Parameter> parameters;
  std::vector<Measure> measures;
  std::uint64_t seed = 1;
  std::int64_t samples = 1;  // of the random parameters
  SweepFrames frames = SweepFrames::none;
};

/// One run of a sweep.
struct SweepRun {
  std::int64_t number = 0;
  std::string scene;                // as the file has it
  std::string scene_path;           // to be opened
  std::vector<std::string> values;  // of the parameters, as TOML

  /// The sweep's overrides, then the values.
  std::vector<std::string> overrides(const Sweep& sweep) const;
};

/// Scenes x values of each parameter x samples.
std::int64_t run_count(const Sweep& sweep);

/// Runs count from 0: the scene changes slowest, then the parameters in the order of the file, the
/// sample fastest. Sample i has the same random numbers whatever else is varied, on every system,
/// so that runs can be compared in pairs. `number` is below run_count.
SweepRun run_of(const Sweep& sweep, std::int64_t number);

/// What the rows of a sweep depend on: its file, its scenes as loaded, and the program's build.
/// Rows of another fingerprint cannot stand in the same table. Throws scenes::SceneError.
std::string sweep_fingerprint(const Sweep& sweep);

/// At most so many runs.
inline constexpr std::int64_t most_runs = 100'000'000;

}  // namespace pneuma::app
