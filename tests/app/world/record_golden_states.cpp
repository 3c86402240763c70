// Runs every scene under every integrator, prints old and new of what changed, and records the new:
//   pneuma_record_golden_states STATES PAPER     state_hashes.txt and paper_hashes.txt of
//   tests/golden; run by scripts/golden-hashes. PAPER: by the paper's method.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>

#include "app/record/world_json.h"
#include "sim/base/file.h"
#include "tests/app/world/golden_states.h"

namespace pneuma::app {
namespace {

void print(const char* which, const GoldenState& state) {
  fmt::print("  {:3} {:4} steps {} {:16.8g} J {:13.7g} m^3 {:10.3g} m\n", which, state.steps,
             hex(state.hash), state.energy, state.volume, state.penetration);
}

/// Returns whether it changed.
bool compare(const GoldenState& now, const GoldenSection* golden) {
  const GoldenState* before = nullptr;
  if (golden != nullptr) {
    for (const GoldenState& state : golden->states) {
      if (state.scene == now.scene && state.integrator == now.integrator) before = &state;
    }
  }
  if (before != nullptr && before->hash == now.hash && before->steps == now.steps) return false;
  fmt::print("{} under {}\n", now.scene, now.integrator);
  if (before != nullptr) print("old", *before);
  print("new", now);
  std::fflush(stdout);
  return true;
}

using Measure = std::vector<GoldenState> (*)(const std::string& scene);

void record(const std::filesystem::path& file, const std::vector<std::string>& scenes,
            Measure measure) {
  std::vector<GoldenSection> sections;
  if (std::filesystem::exists(file)) sections = read_golden_states(file);
  const GoldenSection* golden = section_of(sections, this_system());
  if (golden == nullptr) fmt::print("Nothing is on record for {}\n", this_system());

  std::vector<GoldenState> states;
  int changed = 0;
  for (const std::string& scene : scenes) {
    for (const GoldenState& state : measure(scene)) {
      changed += compare(state, golden) ? 1 : 0;
      states.push_back(state);
    }
  }
  record_states(this_system(), states, sections);
  std::ostringstream text;
  write_golden_states(sections, text);
  const std::string bytes = text.str();
  base::write_file_atomically(file.string(),
                              {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});

  fmt::print("{} of {} states changed\n", changed, states.size());
  const GoldenSection& recorded = *section_of(sections, this_system());
  fmt::print("On record for: {}\n", fmt::join(recorded.systems, "; "));
  for (const GoldenSection& section : sections) {
    if (&section == &recorded) continue;
    fmt::print("Other states are on record for: {}\n", fmt::join(section.systems, "; "));
  }
}

}  // namespace
}  // namespace pneuma::app

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: pneuma_record_golden_states STATES PAPER\n");
    return 2;
  }
  try {
    using namespace pneuma::app;
    record(argv[1], all_scenes(), measure_states);
    record(argv[2], paper_method_scenes(), measure_paper_state);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
