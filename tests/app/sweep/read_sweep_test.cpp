// Sweep files: what they mean, and every slip at its place.
#include "app/sweep/read_sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/sweep/sweep_table.h"
#include "scenes/loader/load_scene.h"
#include "tests/app/sweep/sweep_folder.h"

namespace pneuma::app {
namespace {

class ReadSweep : public SweepFolder {
 protected:
  Sweep read(const std::string& text) const {
    write_text(file(), text);
    return read_sweep(file());
  }

  /// The first error without the file's name; empty: there is none.
  std::string error_of(const std::string& text) const {
    try {
      read(text);
      return "";
    } catch (const scenes::SceneError& error) {
      const scenes::Diagnostic& first = error.diagnostics().front();
      return fmt::format("{}:{}: {}", first.line, first.column, first.message);
    }
  }
};

TEST_F(ReadSweep, RunsGoThroughAllValuesTheLastParameterFastest) {
  const Sweep sweep = read(six_runs);
  ASSERT_EQ(run_count(sweep), 6);
  std::vector<std::string> seen;
  for (int i = 0; i < 6; ++i) {
    const SweepRun run = run_of(sweep, i);
    EXPECT_EQ(std::filesystem::path(run.scene).filename(), "fall.toml");
    seen.push_back(run.values[0] + " " + run.values[1]);
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"50 0.1", "50 1", "50 10", "80 0.1", "80 1", "80 10"}));
  EXPECT_EQ(run_of(sweep, 3).overrides(sweep),
            (std::vector<std::string>{"body.k=80", "body.n=0.1"}));
}

TEST_F(ReadSweep, RandomNumbersAreSpreadOverTheirRangeAndComeAgain) {
  const std::string text = R"(scenes = "fall.toml"
samples = 2000
seed = 7
[[parameter]]
key = "body.k"
log_random = [1, 100]
[[parameter]]
key = "body.name"
values = ["a", "b"]
)";
  const Sweep sweep = read(text);
  ASSERT_EQ(run_count(sweep), 4000);
  int below_ten = 0;
  std::set<std::string> distinct;
  for (int i = 0; i < 2000; ++i) {
    const double k = number_of(run_of(sweep, i).values[0]);
    EXPECT_GE(k, 1.0);
    EXPECT_LE(k, 100.0);
    below_ten += k < 10.0 ? 1 : 0;
    distinct.insert(run_of(sweep, i).values[0]);
    // The other value of the grid meets the same numbers.
    EXPECT_EQ(run_of(sweep, i).values[0], run_of(sweep, 2000 + i).values[0]);
  }
  EXPECT_EQ(distinct.size(), 2000u);
  // Half of them, within five standard deviations of a binomial distribution.
  EXPECT_NEAR(below_ten, 1000, 5.0 * std::sqrt(2000 * 0.25));
  EXPECT_EQ(run_of(read(text), 123).values, run_of(sweep, 123).values);
  Sweep other = sweep;
  other.seed = 8;
  EXPECT_NE(run_of(other, 123).values, run_of(sweep, 123).values);
}

TEST_F(ReadSweep, RangesHaveTheirEndsAndWholeNumbersComeOnce) {
  const Sweep sweep = read(R"(scenes = ["fall.toml"]
[[parameter]]
key = "simulation.seed"
range = [0, 4]
count = 9
whole = true
[[parameter]]
key = "body.n"
range = [0.5, 1]
count = 3
)");
  EXPECT_EQ(sweep.parameters[0].values, (std::vector<std::string>{"0", "1", "2", "3", "4"}));
  EXPECT_EQ(sweep.parameters[1].values, (std::vector<std::string>{"0.5", "0.75", "1"}));
}

struct Slip {
  const char* text;
  const char* error;  // the beginning of the first
};

TEST_F(ReadSweep, SaysWhereASlipIsAndWhatIsAllowed) {
  const std::vector<Slip> slips = {
      {"measure = [\"energy\"]\n", "1:1: scenes is missing"},
      {"scenes = [1]\n", "1:11: scenes takes strings; this is integer 1"},
      {"scenes = [\"no_such\"]\n", "1:11: scene no_such: no_such: no such file"},
      {"scenes = [\"fall.toml\"]\nmesure = []\n",
       "2:1: no key 'mesure' in a sweep; did you mean 'measure'?"},
      {"scenes = [\"fall.toml\"]\nmeasure = [\"penetratoin\"]\n",
       "2:12: nothing that is called 'penetratoin' is measured; did you mean 'penetration'?"},
      {"scenes = [\"fall.toml\"]\nmeasure = [\"energy\", \"energy\"]\n",
       "2:22: 'energy' is measured already"},
      {"scenes = [\"fall.toml\"]\nmeasure = [\"energy_J\"]\n", "2:12: nothing that is called"},
      {"scenes = [\"fall.toml\"]\nframes = \"some\"\n",
       "2:10: frames is string \"some\"; it takes one of none, last, all"},
      {"scenes = [\"fall.toml\"]\nsamples = 0\n", "2:11: samples is integer 0; it takes a whole"},
      {"scenes = [\"fall.toml\"]\nsamples = 5\n", "2:1: samples has no effect"},
      {"scenes = [\"fall.toml\"]\nset = [\"body.kk=3\"]\n", "1:11: scene"},
      {"scenes = [\"fall.toml\"]\nparameter = 3\n", "2:1: parameter is integer 3; write each"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nvalues = [1]\n", "2:1: key is missing"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\n",
       "2:1: no values: give one of"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\nvalues = [1]\nrandom = [1, 2]\n",
       "5:1: random stands beside values"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\nlog_range = [0, 2]\ncount = 3\n",
       "4:13: log_range = [0, 2]: logarithms need numbers above 0"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\nrange = [2, 1]\ncount = 3\n",
       "4:9: range = [2, 1]: low must be below high"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\nrange = [1, 2]\n",
       "4:1: range needs count"},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.kk\"\nvalues = [1, 2]\n",
       "2:1: --set body.kk=1: "},
      {"scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\nvalues = "
       "[1]\n[[parameter]]\nkey = "
       "\"body.k\"\nvalues = [2]\n",
       "5:1: 'body.k' is varied already"},
      {"scenes = [\"fall.toml\"\n", "1:23: Error while parsing array"},
  };
  for (const Slip& slip : slips) {
    const std::string error = error_of(slip.text);
    EXPECT_TRUE(error.starts_with(slip.error)) << slip.text << "\n  " << error;
  }
  EXPECT_EQ(error_of("scenes = [\"fall.toml\"]\n"), "");
}

// Of which the first and the last run have none.
TEST_F(ReadSweep, TakesAKeyOfWhichAnyValueIsTaken) {
  const std::string values = "scenes = [\"fall.toml\"]\n[[parameter]]\nkey = \"body.k\"\nvalues = ";
  EXPECT_EQ(error_of(values + "[-1, 50, -3]\n"), "");
  EXPECT_TRUE(error_of(values + "[-1, -2, -3]\n").starts_with("2:1: --set body.k=-1: "));
}

TEST_F(ReadSweep, RefusesMoreRunsThanAnybodyWaitsFor) {
  std::string text = "scenes = [\"fall.toml\"]\n";
  for (const char* key : {"body.k", "body.n", "body.rho_g"}) {
    text += fmt::format("[[parameter]]\nkey = \"{}\"\nrange = [0, 1]\ncount = 1000\n", key);
  }
  EXPECT_TRUE(error_of(text).starts_with("1:1: 1e+09 runs are more than")) << error_of(text);
}

// A measure that is renamed in the JSON of a run would be an empty column.
TEST(Measures, AreAllFound) {
  for (const std::string& name : measure_names()) EXPECT_NE(find_measure(name).path, "") << name;
  EXPECT_EQ(find_measure("volumes_m3.12.least").path, "/volumes_m3/12/least");
  EXPECT_EQ(find_measure("volumes_m3.x.least").path, "");
  EXPECT_EQ(find_measure("").path, "");
}

}  // namespace
}  // namespace pneuma::app
