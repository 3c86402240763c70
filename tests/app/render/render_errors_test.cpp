// `pneuma render` from the outside: what it says when it cannot.
#include <sys/mount.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "tests/app/render/rendered_run.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

void expect_failure(const ProgramResult& result, int exit_code,
                    const std::vector<std::string>& words) {
  EXPECT_EQ(result.exit_code, exit_code) << result.output;
  for (const std::string& word : words) {
    EXPECT_NE(result.output.find(word), std::string::npos) << result.output << "lacks " << word;
  }
}

TEST(Usage, IsTwo) {
  for (const char* wrong :
       {"", "paint", "render", "render a b", "render a --size 64", "render a --frames x",
        "render a --sheet 4", "render a --show dreams", "render a --threads 0",
        "render a --overwrite --resume", "render a --nonsense"}) {
    expect_failure(run_pneuma(std::string(wrong) + " 2>&1"), 2, {});
  }
}

TEST(Usage, NamesTheCommandsAndTheNearest) {
  expect_failure(
      run_pneuma("frobnicate one_sphere 2>&1"), 2,
      {"pneuma: there is no command 'frobnicate'",
       "allowed: render, export, plot, compare, bench, study, sweep, check, list, doctor"});
  expect_failure(run_pneuma("rendre one_sphere 2>&1"), 2,
                 {"no command 'rendre'; did you mean 'render'?"});
}

TEST(Help, GoesToStandardOutput) {
  for (const char* asked : {"--help", "render --help", "--version"}) {
    const ProgramResult result = run_pneuma(std::string(asked) + " 2>/dev/null");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output, "");
  }
}

/// A shell's redirections of standard error that nothing comes through; the last is a pipe without
/// a reader.
constexpr std::array<const char*, 3> unheard = {"2>&-", "2>/dev/full", "2> >(exit)"};

TEST_F(RenderTest, GoesOnWhereItsMessagesCannotBeShown) {
  for (const char* error : unheard) {
    const auto in_bash = [&](const std::string& arguments) {
      return run_command(fmt::format("bash -c \"'{}' {} {}\"", program_file(), arguments, error));
    };
    const std::string run =
        fmt::format("render '{}' --out '{}' --frames 3", scene().string(), out().string());
    const ProgramResult drawn = in_bash(run + " --overwrite");
    EXPECT_EQ(drawn.exit_code, 0) << error;
    EXPECT_EQ(drawn.output, out().string() + "\n") << error;
    EXPECT_EQ(record()["frames"].size(), 3u) << error;
    expect_whole(pictures());
    EXPECT_EQ(in_bash(run).exit_code, 6) << error << ": there is a run already";
    EXPECT_EQ(in_bash("render no_such_scene").exit_code, 3) << error;
    EXPECT_EQ(in_bash(run + " --overwrite >/dev/full").exit_code, 6) << error;
    EXPECT_EQ(in_bash(run + " --overwrite >&-").exit_code, 6) << error;
  }
}

TEST_F(RenderTest, SaysThatThereIsNoSuchScene) {
  const ProgramResult result = run_pneuma("render one_spere 2>&1");
  expect_failure(result, 3, {"one_spere", "'one_sphere'", "pneuma list"});
}

TEST_F(RenderTest, SaysWhichEndingsThereAre) {
  const std::vector<std::string> endings = {"'.foo'", ".toml", "obj, ply, stl"};
  expect_failure(run_pneuma("render x.foo 2>&1"), 3, endings);
  write_text(folder_ / "x.foo", falling_ball);
  expect_failure(run_pneuma("render '" + (folder_ / "x.foo").string() + "' 2>&1"), 3, endings);
}

TEST_F(RenderTest, SaysThatAFolderOfARunIsNoScene) {
  ASSERT_EQ(render("--frames 1").exit_code, 0);
  expect_failure(run_pneuma("render '" + out().string() + "' 2>&1"), 3, {"folder of a run"});
}

TEST_F(RenderTest, SuggestsTheFileOfAName) {
  const std::string here = "cd '" + folder_.path().string() + "' &&";
  expect_failure(run_pneuma("render fall 2>&1", here), 3, {"did you mean 'fall.toml'?"});
  fs::create_directory(folder_ / "fall");
  write_text(folder_ / "fall/run.json", "{}");
  expect_failure(run_pneuma("render fall 2>&1", here), 3,
                 {"is the folder of a run", "did you mean 'fall.toml'?"});
}

TEST_F(RenderTest, AFolderDoesNotHideTheSceneOfItsName) {
  const std::string here = "cd '" + folder_.path().string() + "' &&";
  fs::create_directory(folder_ / "one_sphere");
  const ProgramResult result = run_pneuma("check one_sphere 2>&1", here);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("name = \"sphere\""), std::string::npos) << result.output;
}

TEST_F(RenderTest, RefusesAModelWhosePathNoSceneCanSay) {
  const fs::path model = folder_ / "k\xc3\xa4tzchen.ply";
  write_text(model, "ply\n");
  const ProgramResult result = run_pneuma("render '" + model.string() + "' 2>&1");
  expect_failure(result, 3, {model.string() + ": the path ", "another name or a link"});
  EXPECT_EQ(result.output.find(".toml"), std::string::npos) << result.output;
}

TEST_F(RenderTest, SaysThatASceneCannotBeRead) {
  expect_failure(run_pneuma("render '" + folder_.path().string() + "' 2>&1"), 3,
                 {folder_.path().string()});
  write_text(scene(), "this is no scene");
  expect_failure(render(""), 3, {scene().string() + ":1:"});
}

TEST_F(RenderTest, SaysWhereAKeyIsWrong) {
  write_text(scene(), std::string(falling_ball) + "raduis = 2.0\n");
  expect_failure(render(""), 3, {scene().string() + ":14:1: ", "'raduis'", "'radius'"});
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(RenderTest, RefusesNegativeMass) {
  write_text(scene(), std::string(falling_ball) + "vertex_mass = -0.35\n");
  expect_failure(render(""), 3, {scene().string() + ":14:", "vertex_mass", "-0.35"});
}

TEST_F(RenderTest, RefusesASphereOfOneVertex) {
  write_text(scene(), std::string(falling_ball) + "stacks = 1\nslices = 1\n");
  expect_failure(render(""), 3, {"stacks", "slices"});
}

TEST_F(RenderTest, TakesBodiesWithoutSpringsOrGas) {
  const ProgramResult result = render("--set body.k=0 --set body.n=0 --set duration=0.1");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(record()["frames"].size(), 4u);
}

TEST_F(RenderTest, NamesTheOverrideThatIsWrong) {
  expect_failure(render("--set body.k=-1"), 3, {"--set body.k=-1"});
}

TEST_F(RenderTest, RefusesFramesBeyondTheEnd) {
  expect_failure(render("--frames 5-22"), 2, {"0 to 21", "duration"});
}

TEST_F(RenderTest, NeedsGl) {
  expect_failure(render("", "PNEUMA_GL=none"), 4, {"PNEUMA_GL"});
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(RenderTest, SaysWhereTheSimulationDiverged) {
  // sqrt(k/m) of 5000 N/m and 0.35 kg over six springs per vertex: 290 rad/s, where rk4 at 60 steps
  // per second is stable up to 2.8 * 60 = 170 rad/s.
  const ProgramResult result =
      render("--set body.k=5000 --set body.k_max=1e9 --set simulation.steps_per_second=60");
  expect_failure(result, 5, {"fall: step ", "(t = ", "body ball: "});
  // The start at least was sound.
  EXPECT_TRUE(pictures().contains("fall_00000.png"));
  expect_whole(pictures());
}

TEST_F(RenderTest, SaysWhenABodyIsTooFarAway) {
  // 1e8 m after 2.6 s, at 8e7 m/s: not yet faster than anything.
  const ProgramResult result = render(
      "--set ground.present=false --set body.rho_g=0 --set simulation.gravity='[0,0,-3e7]' "
      "--set duration=3");
  expect_failure(result, 5, {"body ball", "m away"});
}

TEST_F(RenderTest, NeedsAFolderToWriteTo) {
  write_text(folder_ / "file", "");
  expect_failure(render_into("file", ""), 6, {"--out"});
  expect_failure(render_into("file/below", ""), 6, {"--out"});
  expect_failure(run_pneuma("render '" + scene().string() + "' --out /proc/pneuma 2>&1"), 6,
                 {"/proc/pneuma"});
}

TEST_F(RenderTest, NeedsAFolderThatItMayWriteTo) {
  if (geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  fs::create_directory(out());
  fs::permissions(out(), fs::perms::owner_read | fs::perms::owner_exec);
  expect_failure(render(""), 6, {out().string(), "--out"});
}

TEST_F(RenderTest, SaysWhenStandardOutputIsFull) {
  expect_failure(run_pneuma("render '" + scene().string() + "' --frames 1 --quiet --out '" +
                            out().string() + "' 2>&1 >/dev/full"),
                 6, {"standard output"});
}

/// However large a file may be, at some size a write fails: of a picture, the journal or the state.
TEST_F(RenderTest, SurvivesALimitOnFileSizes) {
  render_into("reference", "");
  for (const int kibibytes : {1, 4, 8, 16}) {
    const ProgramResult result =
        render("--overwrite", "ulimit -f " + std::to_string(2 * kibibytes) + ";");  // in 512 bytes
    expect_failure(result, 6, {"File too large"});
    expect_whole(pictures());
  }
  EXPECT_EQ(render("--resume").exit_code, 0);
  EXPECT_EQ(pictures(), pictures("reference"));
}

/// A file system of 256 KiB of its own, in memory.
class SmallDisk {
 public:
  explicit SmallDisk(const fs::path& at) : at_(at) {
    fs::create_directory(at_);
    mounted_ = mount("tmpfs", at_.c_str(), "tmpfs", 0, "size=256k") == 0;
    error_ = errno;
  }
  ~SmallDisk() {
    if (mounted_) umount(at_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  std::string error() const { return std::strerror(error_); }

 private:
  fs::path at_;
  bool mounted_ = false;
  int error_ = 0;
};

TEST_F(RenderTest, SurvivesAFullDisk) {
  const SmallDisk disk(out());
  if (!disk.mounted()) GTEST_SKIP() << "cannot mount a small file system here: " << disk.error();
  const std::string all_frames = "--size 320x240 --no-caption";
  render_into("reference", all_frames);

  const ProgramResult result = render(all_frames);
  expect_failure(result, 6, {"No space left on device", "free some space"});
  const auto left = pictures();
  EXPECT_GT(left.size(), 0u);
  EXPECT_LT(left.size(), 22u);
  auto reference = pictures("reference");
  for (const auto& [name, bytes] : left) EXPECT_EQ(bytes, reference[name]) << name;

  ASSERT_EQ(mount("tmpfs", out().c_str(), "tmpfs", MS_REMOUNT, "size=8m"), 0);
  EXPECT_EQ(render(all_frames + " --resume").exit_code, 0);
  EXPECT_EQ(pictures(), reference);
}

}  // namespace
}  // namespace pneuma
