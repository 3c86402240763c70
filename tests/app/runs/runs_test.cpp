// `pneuma plot` and `pneuma compare`: what they say of runs is what run.json and the pictures have.
#include <sstream>

#include "app/host/find_program.h"
#include "app/runs/compare_runs.h"
#include "app/runs/plot_run.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

class RunsTest : public RenderTest {
 protected:
  void render_as(const std::string& name, const std::string& options) const {
    const ProgramResult result = render_into(name, options);
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  ProgramResult compare(const std::string& options) const {
    return run_pneuma(fmt::format("compare '{}' '{}' --out '{}' {} 2>&1", out("a").string(),
                                  out("b").string(), (folder_ / "compare.png").string(), options));
  }
};

TEST_F(RunsTest, CsvHasTheNumbersOfTheRecord) {
  render_as("a", "--frames 5");
  std::istringstream table(run_csv(read_run(out("a"))));
  std::string heading, row;
  std::getline(table, heading);
  EXPECT_TRUE(
      heading.starts_with("frame,time_s,state_hash,contacts,penetration_m,energy_kinetic_J"))
      << heading;
  const nlohmann::json frames = record("a")["frames"];
  for (const nlohmann::json& frame : frames) {
    ASSERT_TRUE(std::getline(table, row));
    std::vector<std::string> cells;
    std::istringstream text(row);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    EXPECT_EQ(std::stoll(cells.at(0)), frame["frame"].get<long long>());
    EXPECT_EQ(std::stod(cells.at(1)), frame["time"].get<double>());
    EXPECT_EQ(cells.at(2), frame["state_hash"].get<std::string>());
    EXPECT_EQ(std::stod(cells.at(5)), frame["energy"]["kinetic"].get<double>());
  }
  EXPECT_FALSE(std::getline(table, row));
}

TEST_F(RunsTest, DiagramsBeginWithoutEnergy) {
  render_as("a", "--frames 5");
  const nlohmann::json frames = record("a")["frames"];
  const std::vector<NamedDiagram> diagrams = run_diagrams(read_run(out("a")));
  ASSERT_EQ(diagrams.size(), 6u) << "its gas neither comes nor goes";
  EXPECT_EQ(diagrams[0].name, "fall_energy");
  const DiagramSeries& gas = diagrams[0].diagram.series.at(2);
  EXPECT_EQ(gas.name, "gas");
  EXPECT_EQ(gas.points.at(0).y, 0.0);
  EXPECT_EQ(gas.points.at(4).y,
            frames[4]["energy"]["gas"].get<double>() - frames[0]["energy"]["gas"].get<double>());
  for (const NamedDiagram& each : diagrams) EXPECT_NO_THROW(gnuplot_script(each.diagram, "x"));
}

TEST_F(RunsTest, PressureAndGasAreShownWhereThereIsSome) {
  write_text(scene(), std::string(falling_ball) +
                          "[[body]]\nname = \"filled\"\nposition = [9, 0, 4]\n"
                          "supply.n = [[0, 0], [0.1, 0.2]]\n");
  render_as("a", "--frames 5");
  const nlohmann::json frames = record("a")["frames"];
  const RecordedRun run = read_run(out("a"));
  std::map<std::string, Diagram> diagrams;
  for (const NamedDiagram& each : run_diagrams(run)) diagrams[each.name] = each.diagram;
  const std::vector<DiagramSeries>& pressures = diagrams.at("fall_pressure").series;
  ASSERT_EQ(pressures.size(), 2u);
  for (const DiagramSeries& series : pressures) {
    EXPECT_EQ(series.points.at(4).y, frames[4]["gas"][series.name]["gauge_pressure"].get<double>());
  }
  const std::vector<DiagramSeries>& gas = diagrams.at("fall_gas").series;
  ASSERT_EQ(gas.size(), 1u) << "what the other has stays";
  EXPECT_EQ(gas[0].name, "filled");
  EXPECT_EQ(gas[0].points.at(0).y, 0.0);
  EXPECT_EQ(gas[0].points.at(4).y, frames[4]["gas"]["filled"]["n"].get<double>());

  const std::string table = run_csv(run);
  const std::string heading = table.substr(0, table.find('\n'));
  EXPECT_NE(heading.find(",pressure_ball_Pa,pressure_filled_Pa,gas_filled_mol,"), std::string::npos)
      << heading;
}

TEST_F(RunsTest, ATableHasNoFolder) {
  render_as("a", "--frames 1");
  const ProgramResult result = run_pneuma(
      fmt::format("plot '{}' --csv --out '{}' 2>&1", out("a").string(), out("t.csv").string()));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("> FILE"), std::string::npos) << result.output;
}

TEST_F(RunsTest, PlotsAreDrawn) {
  if (!find_program("gnuplot")) GTEST_SKIP() << "gnuplot is not installed";
  render_as("a", "--frames 5");
  const ProgramResult result = run_pneuma(fmt::format("plot '{}' 2>&1", out("a").string()));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* what : {"energy", "volume", "penetration", "contacts", "stages"}) {
    for (const char* ending : {"svg", "png"}) {
      const fs::path file = out("a") / "plots" / fmt::format("fall_{}.{}", what, ending);
      EXPECT_TRUE(fs::exists(file)) << file;
    }
  }
  const std::string again = fmt::format("plot '{}' 2>&1", out("a").string());
  EXPECT_EQ(run_pneuma(again).exit_code, 6);
  EXPECT_NE(run_pneuma(again).output.find("_energy.gp is there already; replace it with --overwr"),
            std::string::npos);
  EXPECT_EQ(run_pneuma(again + " --overwrite").exit_code, 0);
}

TEST_F(RunsTest, EqualRunsAreEqual) {
  render_as("a", "--frames 6");
  render_as("b", "--frames 6 --threads 2");
  const RunComparison comparison = compare_runs(read_run(out("a")), read_run(out("b")));
  EXPECT_TRUE(comparison.equal());
  EXPECT_EQ(comparison.common_frames, 6);
  EXPECT_TRUE(comparison.settings.empty()) << comparison.settings.front();
  EXPECT_EQ(compare("--expect-equal").exit_code, 0);
}

TEST_F(RunsTest, FindsTheFirstFrameThatDiffers) {
  // Until the ball touches the ground nothing differs.
  // The automatic camera looks ahead, so that the pictures would differ from the start.
  const std::string higher =
      "--set 'ball.position=[0,0,4]' --set 'camera.eye=[0,-20,4]' --set 'camera.target=[0,0,2]' ";
  render_as("a", higher);
  render_as("b", higher + "--set ground.restitution=0.9 --frames 20");
  const nlohmann::json one = record("a")["frames"], other = record("b")["frames"];
  std::int64_t expected = 0;
  while (one[static_cast<std::size_t>(expected)]["state_hash"] ==
         other[static_cast<std::size_t>(expected)]["state_hash"]) {
    ++expected;
  }
  ASSERT_GT(expected, 1);
  const RecordedRun a = read_run(out("a")), b = read_run(out("b"));
  const RunComparison comparison = compare_runs(a, b);
  EXPECT_EQ(comparison.state_differs, expected);
  EXPECT_GE(comparison.picture_differs, expected);
  EXPECT_EQ(comparison.common_frames, 20);
  EXPECT_EQ(comparison.only_first, static_cast<std::int64_t>(one.size()) - 20);
  EXPECT_EQ(comparison.only_second, 0);
  const auto& settings = comparison.settings;
  EXPECT_NE(std::ranges::find(settings, "B: ground, restitution = 0.9"), settings.end());

  const auto at = static_cast<std::size_t>(expected);
  for (const ComparedNumber& number : numbers_of(a, b, expected)) {
    if (number.name != "energy, kinetic, J") continue;
    EXPECT_EQ(number.first, one[at]["energy"]["kinetic"].get<double>());
    EXPECT_EQ(number.second, other[at]["energy"]["kinetic"].get<double>());
  }
  const ProgramResult result = compare("--expect-equal");
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_NE(result.output.find(fmt::format("another state: frame {}\n", expected)),
            std::string::npos)
      << result.output;
  const render::Image page = render::read_png((folder_ / "compare.png").string());
  EXPECT_GE(page.width, 3 * 64);
}

TEST_F(RunsTest, TheComparisonIsBelowOutUnlessToldOtherwise) {
  render_as("a", "--frames 2");
  render_as("b", "--frames 2");
  const std::string there = fmt::format("cd '{}' && ", folder_.path().string());
  for (const char* ends : {"", "/"}) {
    const ProgramResult result = run_pneuma(
        fmt::format("compare '{0}{2}' '{1}{2}' 2>&1", out("a").string(), out("b").string(), ends),
        there);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const std::string name = fmt::format("out/compare/{}_{}.png", out("a").filename().string(),
                                         out("b").filename().string());
    EXPECT_NE(result.output.find("\n" + name + "\n"), std::string::npos) << result.output;
    EXPECT_TRUE(fs::exists(folder_ / name));
    fs::remove(folder_ / name);
  }
  EXPECT_NE(run_pneuma("compare --help").output.find("[out/compare/A_B.png"), std::string::npos);
}

TEST_F(RunsTest, APictureThatIsMissingIsADifference) {
  render_as("a", "--frames 4");
  render_as("b", "--frames 4");
  fs::remove(out("b") / "fall_00002.png");
  EXPECT_EQ(compare_runs(read_run(out("a")), read_run(out("b"))).picture_differs, 2);
  EXPECT_EQ(compare_runs(read_run(out("b")), read_run(out("a"))).picture_differs, 2);
  const ProgramResult result = compare("--expect-equal");
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_NE(result.output.find("fall_00002.png is not there"), std::string::npos) << result.output;
  fs::remove(out("a") / "fall_00002.png");
  EXPECT_TRUE(compare_runs(read_run(out("a")), read_run(out("b"))).equal());
}

TEST_F(RunsTest, NamesWhatIsDamaged) {
  render_as("a", "--frames 2");
  render_as("b", "--frames 2");
  const auto fails_naming = [&](const std::string& path) {
    const ProgramResult result = compare("");
    EXPECT_EQ(result.exit_code, 6) << result.output;
    EXPECT_NE(result.output.find(path), std::string::npos) << result.output;
  };
  const std::string picture = (out("b") / "fall_00001.png").string();
  write_text(picture, "not a picture");
  fails_naming(picture + " is damaged");
  for (const nlohmann::json& scene : {nlohmann::json(5), nlohmann::json()}) {
    nlohmann::json changed = record("b");
    changed["scene_toml"] = scene;
    write_text(out("b") / "run.json", changed.dump());
    fails_naming("the record in " + out("b").string());
  }
}

TEST_F(RunsTest, AnUnfinishedRunCanBeLookedAt) {
  EXPECT_EQ(render_into(
                "a", "--set ball.k=5000 --set ball.k_max=1e9 --set simulation.steps_per_second=60")
                .exit_code,
            5);
  ASSERT_FALSE(fs::exists(out("a") / "run.json"));
  EXPECT_GE(read_run(out("a")).frames().size(), 1u);
}

// A record may come from anybody, and files are called after its scene.
TEST_F(RunsTest, RefusesASceneThatIsNotAFilesName) {
  render_as("a", "--frames 2");
  nlohmann::json changed = record("a");
  for (const char* name : {"", ".", "..", "../../escape", "s\nsystem 'touch pwned'\n#", "a\x7f"}) {
    changed["run"]["scene"] = name;
    write_text(out("a") / "run.json", changed.dump());
    for (const char* options : {"", "--csv"}) {
      const ProgramResult result = run_pneuma(fmt::format(
          "plot '{}' --out '{}' {} 2>&1", out("a").string(), out("plots").string(), options));
      EXPECT_EQ(result.exit_code, 6) << result.output;
      EXPECT_NE(result.output.find("run.scene is " + changed["run"]["scene"].dump(-1, ' ', true)),
                std::string::npos)
          << result.output;
    }
  }
  EXPECT_FALSE(fs::exists(out("plots")));
}

TEST_F(RunsTest, SaysWhatIsWrong) {
  const auto fails = [&](const std::string& arguments, int code, const std::string& words) {
    const ProgramResult result = run_pneuma(arguments + " 2>&1");
    EXPECT_EQ(result.exit_code, code) << arguments;
    EXPECT_NE(result.output.find(words), std::string::npos) << result.output;
  };
  fails("plot '" + out("nowhere").string() + "'", 6, "not a folder");
  fs::create_directory(out("empty"));
  fails("plot '" + out("empty").string() + "'", 6, "no run");
  write_text(out("empty") / "run.json", "{\"frames\": [{}]}");
  fails("plot '" + out("empty").string() + "'", 6, "render the run again");
  fails("plot '" + out("empty").string() + "'", 6, "run.scene is missing or of another kind");
  write_text(out("empty") / "run.json", "{");
  fails("plot '" + out("empty").string() + "'", 6, "cannot be read");
  fails("plot '" + out("empty").string() + "'", 6, "run.json:1:2: the file ends here");
  write_text(out("empty") / "run.json", "{\n \"run\": x}");
  fails("plot '" + out("empty").string() + "'", 6, "run.json:2:9: 'x}' is not what a record has");
  render_as("a", "--frames 3");
  nlohmann::json changed = record("a");
  changed["frames"][1]["time"] = "late";
  write_text(out("empty") / "run.json", changed.dump());
  fails("plot '" + out("empty").string() + "'", 6, "frames[1].time is missing or of another kind");
  render_as("b", "--frames 4-6");
  EXPECT_EQ(compare("").exit_code, 6);
  const std::string a = "'" + out("a").string() + "'";
  fails("compare " + a + " " + a + " --frame 3", 2, "A has 0 to 2");
}

TEST_F(RunsTest, AComparisonReplacesNothingButItsOwnPicture) {
  render_as("a", "--frames 2");
  render_as("b", "--frames 2");
  EXPECT_EQ(compare("").exit_code, 0);
  EXPECT_EQ(compare("").exit_code, 0);
  write_text(folder_ / "compare.png", "a scene");
  EXPECT_EQ(compare("").exit_code, 6);
  EXPECT_EQ(read_text(folder_ / "compare.png"), "a scene");
  for (const char* run : {"a", "b"}) {
    const std::string own = fmt::format("--out '{}'", (out(run) / "run.json").string());
    const std::string runs = fmt::format("'{}' '{}' ", out("a").string(), out("b").string());
    const std::string before = read_text(out(run) / "run.json");
    EXPECT_EQ(run_pneuma("compare " + runs + own + " 2>&1").exit_code, 2);
    EXPECT_EQ(read_text(out(run) / "run.json"), before);
  }
}

}  // namespace
}  // namespace pneuma::app
