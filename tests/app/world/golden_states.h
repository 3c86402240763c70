// The state of every scene after a short run under every integrator, as it is on record in
// tests/golden/state_hashes.txt, and by the paper's method in paper_hashes.txt: "nothing changed"
// is checked and not believed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace pneuma::app {

/// One scene under one integrator. The hash is what counts; the rest says what a change means.
struct GoldenState {
  std::string scene;
  std::string integrator;
  std::int64_t steps = 0;  // fewer than the others of its scene where it diverges
  std::uint64_t hash = 0;
  double energy = 0.0;       // J
  double volume = 0.0;       // m^3, of all soft bodies
  double penetration = 0.0;  // m, the greatest at the end

  bool operator==(const GoldenState&) const = default;
};

/// States that all of these systems come to. A system is a compiler and a C library, since
/// mathematical functions may be rounded otherwise by another: "g++ 12, glibc 2.36".
struct GoldenSection {
  std::vector<std::string> systems;
  std::vector<GoldenState> states;
};

/// What this program was compiled with, and the C library it runs with.
std::string this_system();

/// The names of the scene files, sorted.
std::vector<std::string> all_scenes();

/// Runs a scene under each integrator.
std::vector<GoldenState> measure_states(const std::string& scene);

/// The scenes with a frame rate of the paper's that its method can run: not those whose rest shape
/// is an equilibrium, which valence pressure has none of (ERRATA row 27).
std::vector<std::string> paper_method_scenes();

/// Runs a scene by the paper's method (ERRATA row 68), with "paper" for its integrator.
std::vector<GoldenState> measure_paper_state(const std::string& scene);

/// Throws std::runtime_error that names file and line.
std::vector<GoldenSection> read_golden_states(const std::filesystem::path& path);
void write_golden_states(const std::vector<GoldenSection>& sections, std::ostream& out);

/// The section of a system, or nullptr.
const GoldenSection* section_of(const std::vector<GoldenSection>& sections,
                                const std::string& system);

/// Records the states of a system: in the section of others that come to the same, or in one of its
/// own. What was on record for it is gone, what others have stays.
void record_states(const std::string& system, const std::vector<GoldenState>& states,
                   std::vector<GoldenSection>& sections);

}  // namespace pneuma::app
