// `pneuma sweep`: its table is the same bytes however the runs were distributed and interrupted.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "app/sweep/sweep_plots.h"
#include "app/sweep/workflow.h"
#include "render/image/png.h"
#include "tests/app/sweep/sweep_folder.h"
#include "tests/support/paths.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class SweepTest : public SweepFolder {
 protected:
  std::string csv(const std::string& name = "out") const {
    return read_text(out(name) / "six.csv");
  }
  json table(const std::string& name = "out") const {
    return json::parse(read_text(out(name) / "six.json"));
  }
};

TEST_F(SweepTest, ARowIsWhatTheCommandSaysOfTheRun) {
  const ProgramResult result = sweep("--cores 2");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const json runs = table()["runs"];
  ASSERT_EQ(runs.size(), 6u);
  for (const json& run : runs) {
    const ProgramResult checked = run_pneuma(
        fmt::format("check '{}' --run --json --set body.k={} --set body.n={} 2>/dev/null",
                    (folder_ / "fall.toml").string(), run["parameters"]["body.k"].dump(),
                    run["parameters"]["body.n"].dump()));
    ASSERT_EQ(checked.exit_code, run["exit_code"].get<int>());
    const json said = json::parse(checked.output)["run"];
    EXPECT_EQ(run["values"]["energy"], said["energy_J"]["end"]["total"]);
    EXPECT_EQ(run["values"]["volume"], said["volumes_m3"][0]["end"]);
    EXPECT_EQ(run["values"]["state_hash"], said["state_hash"]);
  }
  EXPECT_EQ(csv().substr(0, csv().find('\n')),
            "run,scene,body.k,body.n,verdict,exit_code,energy,volume,state_hash,words");
}

TEST_F(SweepTest, CoresChunksAndTheirOrderChangeNoByte) {
  ASSERT_EQ(sweep("--cores 1").exit_code, 0);
  ASSERT_EQ(sweep("--cores 3", "three").exit_code, 0);
  EXPECT_EQ(csv("three"), csv());
  for (const char* jobs : {"4-5", "0-0", "1-3"}) {
    const ProgramResult result = sweep(fmt::format("--jobs {}", jobs), "parts");
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  ASSERT_EQ(sweep("--gather", "parts").exit_code, 0);
  EXPECT_EQ(csv("parts"), csv());
  EXPECT_EQ(read_text(out("parts") / "six.json"), read_text(out() / "six.json"));
}

TEST_F(SweepTest, AResumedSweepRunsOnlyWhatIsMissing) {
  ASSERT_EQ(sweep("--cores 1").exit_code, 0);
  const std::string whole = csv(), journal = read_text(out() / "six.journal");
  const ProgramResult refused = sweep("--cores 1");
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_NE(refused.output.find("continue it with --resume"), std::string::npos) << refused.output;

  // As a kill leaves it: the fourth line torn, no table.
  std::istringstream lines(journal);
  std::string kept, line;
  for (int i = 0; i < 4 && std::getline(lines, line); ++i) kept += line + '\n';
  write_text(out() / "six.journal", kept + "{\"run\":3,\"exi");
  fs::remove(out() / "six.csv");
  ASSERT_EQ(sweep("--cores 2 --resume").exit_code, 0);
  EXPECT_EQ(csv(), whole);
  const std::string resumed = read_text(out() / "six.journal");
  EXPECT_TRUE(resumed.starts_with(kept)) << "a run that was done is done again";
  EXPECT_EQ(std::ranges::count(resumed, '\n'), 7);
}

TEST_F(SweepTest, SaysThatThereIsNothingToContinue) {
  const std::string command =
      fmt::format("sweep '{}' --resume --out '{}' 2>&1", file().string(), out().string());
  const std::string said = out().string() + " holds no run of this sweep";
  EXPECT_NE(run_pneuma(command).output.find(said), std::string::npos);
  EXPECT_EQ(run_pneuma(command).output.find(said), std::string::npos);
}

TEST_F(SweepTest, AKilledSweepLosesNothing) {
  write_text(file(), std::string(six_runs) +
                         "[[parameter]]\nkey = \"body.rho_g\"\nrange = [0, 0.1]\ncount = 40\n");
  ASSERT_EQ(sweep("--cores 2", "whole").exit_code, 0);
  for (int kills = 0; kills < 3; ++kills) {
    const std::string program = program_file();
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      execl(program.c_str(), "pneuma", "sweep", file().c_str(), "--quiet", "--resume", "--cores",
            "2", "--out", out().c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    // Until it has some more rows.
    const auto rows = [&] {
      const std::string text =
          fs::exists(out() / "six.journal") ? read_text(out() / "six.journal") : "";
      return std::ranges::count(text, '\n');
    };
    const auto before = rows();
    for (int waits = 0; rows() < before + 5 && waits < 3000; ++waits) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  ASSERT_EQ(sweep("--cores 2 --resume").exit_code, 0);
  EXPECT_EQ(csv(), csv("whole"));
}

TEST_F(SweepTest, AFailedRunIsARowWithItsCodeAndWords) {
  write_text(file(), R"(scenes = ["fall.toml"]
set = ["simulation.steps_per_second=60"]
measure = ["energy", "seconds"]
[[parameter]]
key = "body.k"
values = [50, -1, 1e12]
)");
  const ProgramResult result = sweep("--cores 2");
  EXPECT_EQ(result.exit_code, 3) << result.output;
  const json runs = table()["runs"];
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0]["verdict"], "done");
  EXPECT_EQ(runs[0]["words"], "");
  EXPECT_EQ(runs[1]["exit_code"], 3);
  EXPECT_NE(runs[1]["words"].get<std::string>().find("--set body.k=-1"), std::string::npos);
  EXPECT_TRUE(runs[1]["values"]["energy"].is_null());
  EXPECT_EQ(runs[2]["exit_code"], 5);
  EXPECT_NE(runs[2]["words"].get<std::string>().find("ball"), std::string::npos);
  EXPECT_LT(runs[2]["values"]["seconds"].get<double>(), 0.2);
  EXPECT_TRUE(runs[2]["values"]["energy"].is_null()) << "of where it diverged";
  for (const char* said :
       {"3 runs, 1 done, 1 invalid, 1 diverged\n",
        "\nrun 1, the first with verdict \"invalid\" (body.k = -1): --set",
        "\nrun 2, the first with verdict \"diverged\" (body.k = 1000000000000.0): "}) {
    EXPECT_NE(result.output.find(said), std::string::npos) << result.output;
  }
  EXPECT_EQ(sweep("--resume").exit_code, 3) << "all runs are there already";
}

TEST_F(SweepTest, GatherNamesWhatIsMissingTwiceOrOfAnotherSweep) {
  ASSERT_EQ(sweep("--jobs 0-1").exit_code, 0);
  ASSERT_EQ(sweep("--jobs 4-5").exit_code, 0);
  const ProgramResult missing = sweep("--gather");
  EXPECT_EQ(missing.exit_code, 6);
  EXPECT_NE(missing.output.find("2 of 6 runs are missing"), std::string::npos) << missing.output;
  EXPECT_NE(missing.output.find("--jobs 2-3"), std::string::npos) << missing.output;
  ASSERT_EQ(sweep("--jobs 1-3").exit_code, 0);
  const ProgramResult twice = sweep("--gather");
  EXPECT_EQ(twice.exit_code, 6);
  EXPECT_NE(twice.output.find("run 1 is in another chunk too"), std::string::npos) << twice.output;
  write_text(file(), std::string(six_runs) + "# another\n");
  EXPECT_NE(sweep("--gather").output.find("its rows are of another sweep file"), std::string::npos);
  EXPECT_NE(sweep("--jobs 4-5").output.find("its rows are of another sweep file"),
            std::string::npos);
  EXPECT_EQ(sweep("--jobs 5-6").exit_code, 2);
  EXPECT_EQ(sweep("--jobs five").exit_code, 2);
}

TEST_F(SweepTest, AFullDiskIsNamedAndTheSweepGoesOn) {
  ASSERT_EQ(sweep("--cores 1", "whole").exit_code, 0);
  // Files of at most 1 KiB: a few rows.
  const ProgramResult full = run_command(
      fmt::format("bash -c \"ulimit -f 1; '{}' sweep '{}' --quiet --cores 1 --out '{}'\" 2>&1",
                  program_file(), file().string(), out().string()));
  EXPECT_EQ(full.exit_code, 6) << full.output;
  EXPECT_NE(full.output.find("free some space"), std::string::npos) << full.output;
  ASSERT_EQ(sweep("--resume --cores 1").exit_code, 0);
  EXPECT_EQ(csv(), csv("whole"));
}

TEST_F(SweepTest, PicturesOfTheLastFrameComeOnOnePage) {
  write_text(file(), "frames = \"last\"\nsize = \"32x24\"\n" + std::string(six_runs));
  const ProgramResult result = sweep("--cores 2");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (int run = 0; run < 6; ++run) {
    EXPECT_TRUE(fs::exists(out() / fmt::format("pictures/run_{}/fall_00006.png", run))) << run;
  }
  // Two rows of three pictures of 32 x 24, and below each what was varied.
  const render::Image sheet = render::read_png((out() / "six_sheet.png").string());
  EXPECT_EQ(sheet.width, 6 + 3 * (32 + 6));
  EXPECT_GT(sheet.height, 6 + 2 * (24 + 6 + 9));

  fs::create_directory(out() / "pictures/run_of_mine");
  fs::create_directory(out() / "pictures/run_9");
  EXPECT_EQ(sweep("--overwrite").exit_code, 0);
  EXPECT_TRUE(fs::exists(out() / "pictures/run_of_mine"));
  EXPECT_FALSE(fs::exists(out() / "pictures/run_9")) << "of an earlier sweep";
}

TEST_F(SweepTest, AFilmInPartsHasTheSameBytes) {
  write_text(file(), R"(scenes = ["fall.toml"]
set = ["simulation.steps_per_second=60"]
frames = "all"
size = "32x24"
[[parameter]]
key = "body.k"
values = [50, 1e12]
)");
  ASSERT_EQ(sweep("--cores 1", "whole").exit_code, 5);
  // A part and the gathering have done their work whatever the runs came to.
  for (const char* part : {"--jobs 0-1 --no-pictures", "--frames 0:4-6", "--frames 0:0-3",
                           "--frames 1:0-6", "--gather"}) {
    const ProgramResult result = sweep(part);
    ASSERT_EQ(result.exit_code, 0) << part << ": " << result.output;
  }
  EXPECT_EQ(csv(), csv("whole"));
  for (int frame = 0; frame <= 6; ++frame) {
    const std::string name = fmt::format("pictures/run_0/fall_{:05}.png", frame);
    ASSERT_TRUE(fs::exists(out() / name)) << name;
    EXPECT_EQ(read_text(out() / name), read_text(out("whole") / name)) << name;
  }
  EXPECT_FALSE(fs::exists(out("whole") / "pictures/run_1"))
      << "a run that diverges has no pictures";
  EXPECT_NE(read_text(out() / "pictures/run_1/0-6/run.json").find("no_pictures"),
            std::string::npos);
  EXPECT_EQ(sweep("--frames 0:3-1").exit_code, 2);
  const ProgramResult beyond = sweep("--frames 2:0-1");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_NE(beyond.output.find("--frames 2: the sweep has runs 0 to 1"), std::string::npos)
      << beyond.output;
  for (const char* typed : {"99:..", "x:0-1", "0:1", "0:-1", "0"}) {
    const ProgramResult wrong = sweep(fmt::format("--frames {}", typed));
    EXPECT_EQ(wrong.exit_code, 2) << typed;
    EXPECT_NE(
        wrong.output.find(fmt::format("--frames {}: give run and frames, as 3:120-179", typed)),
        std::string::npos)
        << wrong.output;
  }
}

TEST(SweepChunks, HoldEveryRunOnceAndNoMoreThanTheirSeconds) {
  const std::vector<double> seconds = {5, 5, 30, 70, 1, 1, 1, 50, 10};
  const std::vector<RunRange> chunks = make_chunks(seconds, 60.0);
  std::int64_t next = 0;
  for (const RunRange& chunk : chunks) {
    EXPECT_EQ(chunk.first, next);
    double sum = 0.0;
    for (auto i = chunk.first; i <= chunk.last; ++i) sum += seconds[static_cast<std::size_t>(i)];
    EXPECT_TRUE(sum <= 60.0 || chunk.first == chunk.last) << chunk.first;
    next = chunk.last + 1;
  }
  EXPECT_EQ(next, 9);
  EXPECT_EQ(chunks.size(), 4u);
}

TEST_F(SweepTest, ReplacesNothingUnasked) {
  fs::create_directories(out());
  const auto expect_refused = [&](const ProgramResult& result, const std::string& file) {
    EXPECT_EQ(result.exit_code, 6) << result.output;
    EXPECT_NE(result.output.find((out() / file).string() + " is there already; replace it with "
                                                           "--overwrite"),
              std::string::npos)
        << result.output;
    EXPECT_EQ(read_text(out() / file), "mine");
  };
  write_text(out() / "six.csv", "mine");
  expect_refused(sweep(""), "six.csv");
  expect_refused(sweep("--resume"), "six.csv");
  ASSERT_EQ(sweep("--jobs 0-5").exit_code, 0);
  expect_refused(sweep("--gather"), "six.csv");
  ASSERT_EQ(sweep("--gather --overwrite").exit_code, 0);
  const std::string whole = csv();
  ASSERT_EQ(sweep("--overwrite").exit_code, 0);
  EXPECT_EQ(csv(), whole);

  write_text(out() / "Snakefile", "mine");
  write_text(out() / "measured", "mine");
  const std::string flow = fmt::format("--chunk-seconds 0.1 --snakemake '{}'", out().string());
  expect_refused(sweep(flow), "Snakefile");
  ASSERT_EQ(sweep(flow + " --overwrite").exit_code, 0);
  EXPECT_NE(read_text(out() / "Snakefile"), "mine");
  EXPECT_EQ(read_text(out() / "measured"), "mine");
}

TEST_F(SweepTest, WritesAWorkflowOfAllRuns) {
  const ProgramResult result = run_pneuma(fmt::format(
      "sweep '{}' --snakemake '{}' --chunk-seconds 0.1 2>&1", file().string(), out().string()));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::string text = read_text(out() / "Snakefile");
  EXPECT_NE(text.find("\"0-"), std::string::npos) << text;
  EXPECT_NE(text.find("-5\",\n]"), std::string::npos) << text;
  EXPECT_NE(text.find(file().string()), std::string::npos) << text;
}

// The workflow in one Snakemake, which takes seconds to start.
TEST_F(SweepTest, LongASnakemakeRunGivesTheSameBytes) {
  if (run_command("snakemake --version >/dev/null 2>&1").exit_code != 0) {
    GTEST_SKIP() << "snakemake is not installed: scripts/test-slurm installs it";
  }
  ASSERT_EQ(sweep("--cores 1").exit_code, 0);
  ASSERT_EQ(run_pneuma(fmt::format("sweep '{}' --snakemake '{}' --chunk-seconds 0.1 2>&1",
                                   file().string(), out("flow").string()))
                .exit_code,
            0);
  const ProgramResult ran =
      run_command(fmt::format("cd '{}' && snakemake --cores 2 2>&1", out("flow").string()));
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_EQ(csv("flow"), csv());
}

TEST_F(SweepTest, MapsLeaveOutWhatARunHadWhenItDiverged) {
  write_text(file(), R"(scenes = ["fall.toml"]
set = ["simulation.steps_per_second=60"]
measure = ["energy"]
[[parameter]]
key = "body.k"
values = [50, 1e12]
[[parameter]]
key = "body.n"
values = [1, 2]
)");
  ASSERT_EQ(sweep("--cores 2").exit_code, 5);
  const std::string script = read_text(out() / "six_energy.gp");
  std::istringstream lines(script);
  int unknown = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.ends_with(" NaN")) continue;
    ++unknown;
    EXPECT_NE(line.find("1000000000"), std::string::npos) << line;
  }
  EXPECT_EQ(unknown, 2) << script;
}

TEST(Measures, HaveTheUnitOfTheirPath) {
  for (const auto& [name, unit] : {std::pair("energy_drift", "J"),
                                   {"penetration", "m"},
                                   {"speed", "m/s"},
                                   {"volume", "m^3"},
                                   {"seconds", "s"},
                                   {"penetration_m.at_s", "s"},
                                   {"crossings", ""},
                                   {"steps", ""}}) {
    EXPECT_EQ(unit_of(find_measure(name)), unit) << name;
  }
}

TEST(HeatMap, CellsReachHalfWayToTheNextAndLeaveNoGap) {
  HeatMap map{"title", "value", {.label = "x"}, {.label = "y"}, false, {}};
  for (const double x : {1.0, 3.0}) {
    for (const double y : {0.0, 1.0, 3.0}) map.cells.push_back({.x = x, .y = y, .value = x * y});
  }
  const std::string script = heat_map_script(map, "name");
  for (const char* cell : {"\n1 0 0 2 -0.5 0.5 0\n", "\n1 1 0 2 0.5 2 1\n", "\n3 3 2 4 2 4 9\n"}) {
    EXPECT_NE(script.find(cell), std::string::npos) << script;
  }
  EXPECT_NE(script.find("set rmargin at screen 0.8\n"), script.npos) << script;
  EXPECT_THROW(heat_map_script({}, "name"), std::invalid_argument);
}

}  // namespace
}  // namespace pneuma::app
