// `pneuma render` from the outside: what it makes.
#include <fmt/format.h>

#include <set>

#include "app/record/world_json.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "tests/app/render/rendered_run.h"
#include "tests/support/json_numbers.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::set<std::string> names(const std::map<std::string, std::string>& pictures) {
  std::set<std::string> result;
  for (const auto& [name, bytes] : pictures) result.insert(name);
  return result;
}

TEST_F(RenderTest, MakesAPicturePerFrameAndARecord) {
  const ProgramResult result = render("");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  std::set<std::string> expected;
  for (int frame = 0; frame <= 21; ++frame) {  // 0.7 s at 30 frames/s, and the start
    expected.insert(fmt::format("fall_{:05}.png", frame));
  }
  EXPECT_EQ(names(pictures()), expected);
  expect_whole(pictures());

  std::set<std::string> others;
  for (const auto& entry : fs::directory_iterator(out())) {
    if (entry.path().extension() != ".png") others.insert(entry.path().filename().string());
  }
  EXPECT_EQ(others, std::set<std::string>{"run.json"});
}

TEST_F(RenderTest, PrintsTheFolderAsItsOnlyData) {
  const ProgramResult result = run_pneuma("render '" + scene().string() + "' --out '" +
                                          out().string() + "' --sheet 2x2 2>/dev/null");
  EXPECT_EQ(result.output, out().string() + "\n" + (out() / "fall_sheet.png").string() + "\n");
}

TEST_F(RenderTest, IsSilentWhenAskedTo) {
  EXPECT_EQ(render("--quiet").output, out().string() + "\n");
  EXPECT_NE(render_into("other", "").output, out("other").string() + "\n");
}

TEST_F(RenderTest, MakesNoSecondFrameFromTheFirst) {
  render("");
  EXPECT_NE(pictures()["fall_00000.png"], pictures()["fall_00021.png"]);
}

TEST_F(RenderTest, DrawsAPartOfTheRunAsInTheWhole) {
  render("");
  EXPECT_EQ(render_into("first", "--frames 3").exit_code, 0);
  EXPECT_EQ(render_into("part", "--frames 5-7").exit_code, 0);
  EXPECT_EQ(render_into("rest", "--frames 20-").exit_code, 0);
  EXPECT_EQ(names(pictures("first")),
            (std::set<std::string>{"fall_00000.png", "fall_00001.png", "fall_00002.png"}));
  EXPECT_EQ(names(pictures("part")),
            (std::set<std::string>{"fall_00005.png", "fall_00006.png", "fall_00007.png"}));
  EXPECT_EQ(names(pictures("rest")), (std::set<std::string>{"fall_00020.png", "fall_00021.png"}));
  auto whole = pictures();
  for (const char* part : {"first", "part", "rest"}) {
    for (const auto& [name, bytes] : pictures(part)) EXPECT_EQ(bytes, whole[name]) << name;
  }
}

TEST_F(RenderTest, FollowsSizeCaptionAndShow) {
  render("--frames 1");
  EXPECT_EQ(render_into("large", "--frames 1 --size 80x60").exit_code, 0);
  EXPECT_EQ(render::read_png((out("large") / "fall_00000.png").string()).width, 80);
  for (const char* option : {"--no-caption", "--show wireframe"}) {
    EXPECT_EQ(render_into(option, std::string("--frames 1 ") + option).exit_code, 0);
    EXPECT_NE(pictures(option), pictures()) << option;
  }
}

TEST_F(RenderTest, MakesACleanAndAnOverlaySequenceInOneRun) {
  const std::string overlay = "wireframe,contacts";
  EXPECT_EQ(render("--overlay " + overlay + " --frames 10-20 --sheet 2x2").exit_code, 0);
  render_into("clean", "--frames 10-20 --sheet 2x2");
  render_into("marked", "--frames 10-20 --show " + overlay);
  const auto both = pictures();
  auto clean = pictures("clean");
  auto marked = pictures("marked");
  EXPECT_EQ(both.size(), 11u + 11u + 1u);
  for (auto& [name, bytes] : clean) EXPECT_EQ(both.at(name), bytes) << name;
  for (const auto& [name, bytes] : marked) {
    EXPECT_EQ(both.at(fmt::format("fall_overlay{}", name.substr(4))), bytes) << name;
  }
  EXPECT_NE(clean["fall_00020.png"], marked["fall_00020.png"]);
  EXPECT_EQ(record()["run"]["overlay"], (json{"wireframe", "contacts"}));
  EXPECT_EQ(record()["frames"][3]["overlay_png_bytes"], both.at("fall_overlay_00013.png").size());
  // A lost overlay is drawn again, as a lost frame is.
  fs::remove(out() / "fall_overlay_00013.png");
  EXPECT_EQ(render("--overlay " + overlay + " --frames 10-20 --resume").exit_code, 0);
  EXPECT_EQ(pictures().at("fall_overlay_00013.png"), both.at("fall_overlay_00013.png"));
  EXPECT_EQ(render("--frames 1 --overwrite").exit_code, 0);
  EXPECT_EQ(pictures().size(), 1u);
}

TEST_F(RenderTest, MakesTheSameBytesOnAnyNumberOfThreads) {
  render("");
  render_into("threads", "--threads 3");
  EXPECT_EQ(pictures("threads"), pictures());
}

TEST_F(RenderTest, DoesNotDisturbTheSimulation) {
  render("");
  const json run = record();
  // The same steps without a renderer, a camera that looks ahead, or files.
  const scenes::Scene loaded = scenes::load_scene(scene());
  sim::World world = app::build_world(loaded);
  sim::Stepper stepper(world, {.threads = 1, .plan = {}});
  for (const json& frame : run["frames"]) {
    while (world.steps < frame["step"]) ASSERT_FALSE(stepper.step(world));
    EXPECT_EQ(frame["state_hash"], app::hex(sim::state_hash(world))) << frame["frame"];
  }
}

TEST_F(RenderTest, SaysWhenBodiesPassThroughEachOther) {
  const auto render_cubes = [&](const std::string& folder, const std::string& contact) {
    return run_pneuma("render torus_four_cubes --frames 34-36 --size 64x48 --out '" +
                      out(folder).string() + "' --set simulation.contact=" + contact + " 2>&1")
        .output;
  };
  const std::string crossing = render_cubes("crossing", "impulses");
  EXPECT_NE(crossing.find("torus and cube."), std::string::npos) << crossing;
  EXPECT_NE(crossing.find("simulation.contact = \"swept\" keeps bodies apart"), std::string::npos);
  EXPECT_NE(crossing.find("bodies pass through each other in 3 of 3 frames"), std::string::npos)
      << crossing;
  EXPECT_GT(record("crossing")["frames"][0]["crossings"]["between_bodies"], 0);
  const std::string apart = render_cubes("apart", "swept");
  EXPECT_EQ(apart.find("pass through"), std::string::npos) << apart;
}

TEST_F(RenderTest, RecordsWhatEachFrameShows) {
  render("--set body.k=60");
  const json run = record();
  ASSERT_EQ(run["frames"].size(), 22u);
  // No overlay, and an empty list, which looks like a null when flattened.
  expect_nulls_only_at(run, {"/run/overlay", "/run/show"});
  bool touched = false;
  for (std::size_t i = 0; i < 22; ++i) {
    const json& frame = run["frames"][i];
    EXPECT_EQ(frame["frame"], i);
    EXPECT_EQ(frame["step"], 2 * i);
    EXPECT_DOUBLE_EQ(frame["time"].get<double>(), static_cast<double>(i) / 30.0);
    const json& energy = frame["energy"];
    const double sum = energy["kinetic"].get<double>() + energy["spring"].get<double>() +
                       energy["gas"].get<double>() + energy["gravity"].get<double>();
    EXPECT_DOUBLE_EQ(energy["total"].get<double>(), sum);
    EXPECT_GT(frame["volumes"]["ball"], 0.0);
    EXPECT_EQ(frame["momentum"]["angular"].size(), 3u);
    EXPECT_EQ(frame["contacts"]["count"], frame["contacts"]["soft_ground"]);
    EXPECT_GE(frame["greatest_penetration"], 0.0);
    EXPECT_EQ(frame["crossings"]["between_bodies"], 0);
    EXPECT_EQ(frame["crossings"]["within_bodies"], 0);
    EXPECT_GE(frame["seconds"]["total"], frame["seconds"]["draw"]);
    EXPECT_EQ(frame["png_bytes"], pictures()[fmt::format("fall_{:05}.png", i)].size());
    touched |= frame["contacts"]["count"] > 0;
  }
  EXPECT_TRUE(touched);
  EXPECT_GT(run["frames"][21]["seconds"]["integrate_soft"], 0.0);
  EXPECT_FALSE(run["frames"][21]["seconds"].contains("integrate_rigid"));  // not in the plan
}

TEST_F(RenderTest, RecordsWhatMadeTheRun) {
  render("--set body.k=60 --set simulation.seed=7 --threads 2");
  const json run = record();
  EXPECT_EQ(run["run"]["scene"], "fall");
  EXPECT_EQ(run["seed"], 7);
  EXPECT_EQ(run["units"].get<std::string>().substr(0, 5), "metre");
  EXPECT_FALSE(run["program"]["compiler"].get<std::string>().empty());
  EXPECT_TRUE(run["program"]["libraries"].contains("Eigen"));
  EXPECT_NE(run["run"]["gl"].get<std::string>().find("OpenGL"), std::string::npos);
  EXPECT_GT(run["wall_seconds"], 0.0);
  // Of the camera, which looks ahead before the first frame: no time of a frame.
  EXPECT_GT(run["look_ahead_seconds"], 0.0);
  EXPECT_EQ(run["frames"][0]["look_ahead_seconds"], run["look_ahead_seconds"]);
  EXPECT_FALSE(run["frames"][1].contains("look_ahead_seconds"));
  ASSERT_EQ(run["launches"].size(), 1u);
  const json& launch = run["launches"][0];
  EXPECT_EQ(launch["threads"], 2);
  EXPECT_EQ(launch["date"].get<std::string>().size(), std::string("2009-04-25T12:00:00Z").size());
  EXPECT_NE(launch["command_line"].get<std::string>().find("--set body.k=60"), std::string::npos);
  EXPECT_GE(launch["machine"]["cores"], 1);

  // The effective scene, as the file it would be.
  const scenes::Scene again =
      scenes::parse_scene(run["scene_toml"].get<std::string>(), "fall.toml");
  EXPECT_EQ(again.bodies[0].material.k, 60.0);
  EXPECT_EQ(again.settings.seed, 7u);
}

TEST_F(RenderTest, PutsFramesOnASheet) {
  EXPECT_EQ(render("--sheet 3x2").exit_code, 0);
  const render::Image sheet = render::read_png((out() / "fall_sheet.png").string());
  EXPECT_GT(sheet.width, 3 * 64);
  EXPECT_GT(sheet.height, 2 * 48);
}

TEST_F(RenderTest, FindsScenesByName) {
  EXPECT_EQ(run_pneuma("render one_sphere --frames 1 --size 64x48 --set duration=0.5 --out '" +
                       out().string() + "' 2>&1")
                .exit_code,
            0);
  EXPECT_EQ(names(pictures()), std::set<std::string>{"one_sphere_00000.png"});
}

TEST_F(RenderTest, WritesToOutAndTheNameByDefault) {
  const ProgramResult result =
      run_pneuma("render fall.toml --frames 1 --quiet", "cd '" + folder_.path().string() + "' &&");
  EXPECT_EQ(result.output, "out/fall\n");
  EXPECT_TRUE(fs::exists(folder_ / "out/fall/fall_00000.png"));
}

TEST_F(RenderTest, PrintsTheVideoCommandWithoutFfmpeg) {
  const std::string video = (folder_ / "film.mp4").string();
  const ProgramResult result = render("--frames 2 --video '" + video + "'", "PATH=");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("ffmpeg -y"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("file:" + video), std::string::npos) << result.output;
}

TEST_F(RenderTest, WithoutFfmpegRefusesAVideoOfNoKnownKindBeforeTheRun) {
  for (const char* video : {"film.xyz", "film"}) {
    const ProgramResult result =
        render("--frames 2 --video '" + (folder_ / video).string() + "'", "PATH=");
    EXPECT_EQ(result.exit_code, 6) << result.output;
    EXPECT_NE(result.output.find(".mp4, "), std::string::npos) << result.output;
    EXPECT_FALSE(fs::exists(out()));
  }
}

/// Makes a shell script stand in for ffmpeg, which need not be installed. Returns the setting of
/// the environment with which it is found.
std::string stand_in_for_ffmpeg(const fs::path& folder, const std::string& script) {
  fs::create_directories(folder / "bin");
  const fs::path ffmpeg = folder / "bin/ffmpeg";
  write_text(ffmpeg, "#!/bin/sh\n" + script);
  fs::permissions(ffmpeg, fs::perms::owner_all);
  return "PATH='" + (folder / "bin").string() + "':\"$PATH\"";
}

TEST_F(RenderTest, RunsFfmpegAndReportsItsFailure) {
  const std::string path = stand_in_for_ffmpeg(
      folder_.path(), "echo \"$@\" > '" + (folder_ / "arguments").string() + "'\n");
  const std::string video = (folder_ / "film.mp4").string();
  EXPECT_EQ(render("--frames 1-2 --quiet --video '" + video + "'", path).output,
            out().string() + "\n" + video + "\n");
  EXPECT_NE(read_text(folder_ / "arguments").find("-start_number 1 "), std::string::npos);

  stand_in_for_ffmpeg(folder_.path(), "echo no such codec >&2\nexit 1\n");
  const ProgramResult failed = render("--frames 1-2 --resume --video '" + video + "'", path);
  EXPECT_EQ(failed.exit_code, 6);
  EXPECT_NE(failed.output.find("no such codec"), std::string::npos) << failed.output;
  EXPECT_EQ(pictures().size(), 2u);
  // Before a run, not after it.
  EXPECT_EQ(render_into("not_begun", "--video '" + video + "'", path).exit_code, 6);
  EXPECT_FALSE(fs::exists(out("not_begun")));
}

TEST_F(RenderTest, DoesNotBeginWithoutAPlaceForItsVideo) {
  write_text(folder_ / "file", "");
  // Writes to its last argument, file:PATH.
  const std::string path =
      stand_in_for_ffmpeg(folder_.path(), "for last; do :; done\necho film > \"${last#file:}\"\n");
  for (const char* place : {"gone/film.mp4", "file/film.mp4", ".", "/proc/film.mp4"}) {
    const fs::path video = folder_ / place;  // an absolute place stays as it is
    const ProgramResult result = render("--video '" + video.string() + "'", path);
    EXPECT_EQ(result.exit_code, 6) << result.output;
    EXPECT_NE(result.output.find(" the video " + video.string() + ": "), std::string::npos)
        << result.output;
    EXPECT_FALSE(fs::exists(out()));
  }
}

TEST_F(RenderTest, SaysThatThereAreNoParticlesToDraw) {
  const std::string words = "fall: there are no collision particles to draw: ";
  for (const char* options : {"--overlay particles", "--overwrite --show contacts,particles"}) {
    const ProgramResult result = render(std::string(options) + " --frames 1");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output.find(words), std::string::npos) << result.output;
  }
  EXPECT_EQ(render("--overwrite --overlay contacts --frames 1").output.find(words),
            std::string::npos);
  write_text(scene(), std::string(falling_ball) + "copies = [2, 1, 1]\n");
  EXPECT_EQ(render("--overwrite --overlay particles --frames 1").output.find(words),
            std::string::npos);
}

}  // namespace
}  // namespace pneuma
