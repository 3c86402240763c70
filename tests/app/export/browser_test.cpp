// The replay page in a real browser: it draws what the program's own renderer draws, and nothing
// goes wrong.
#include "app/files/scene_catalogue.h"
#include "app/host/find_program.h"
#include "render/image/compare.h"
#include "tests/app/export/read_replay.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

/// Runs Debian's chromium without a window, drawing by software.
class LongBrowser : public testing::Test {
 protected:
  void SetUp() override {
    browser_ = find_program("chromium").value_or("");
    if (browser_.empty()) GTEST_SKIP() << "chromium is not installed";
  }

  void export_page(const std::string& options) const {
    const ProgramResult result = run_pneuma(fmt::format(
        "export {} --set picture.width=640 --set picture.height=480 --format html --out '{}' 2>&1",
        options, folder_.path().string()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }

  /// What the browser shows; `said` is what the page wrote on its console.
  render::Image shown(const std::string& page, const std::string& wishes, std::string& said) const {
    const auto picture = folder_ / "shown.png";
    const auto log = folder_ / "log";
    const std::string command = fmt::format(
        "'{}' --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
        "--hide-scrollbars --window-size=800,700 --virtual-time-budget=20000 "
        "--enable-logging=stderr --user-data-dir='{}' --screenshot='{}' 'file://{}#{}' 2>'{}'",
        browser_, (folder_ / "profile").string(), picture.string(), (folder_ / page).string(),
        wishes, log.string());
    EXPECT_EQ(std::system(command.c_str()), 0) << read_text(log);
    std::istringstream lines(read_text(log));
    for (std::string line; std::getline(lines, line);) {
      if (line.find("CONSOLE") != std::string::npos) said += line + "\n";
    }
    return upper_left(render::read_png(picture.string()));
  }

  /// What the browser shows after `script` has done to the opened page what its user may do.
  render::Image shown_after(const std::string& script, const std::string& page,
                            const std::string& wishes, std::string& said) const {
    write_text(folder_ / "used.html",
               read_text(folder_ / page) +
                   fmt::format("<script>setTimeout(() => {{ {} }}, 5000)</script>\n", script));
    return shown("used.html", wishes + "&bare=640x480", said);
  }

  /// Of the window, which is larger than the picture in it.
  static render::Image upper_left(const render::Image& window) {
    render::Image part{640, 480, {}};
    for (int y = 0; y < part.height; ++y) {
      const auto row = window.pixels.begin() + std::ptrdiff_t{3} * y * window.width;
      part.pixels.insert(part.pixels.end(), row, row + std::ptrdiff_t{3} * part.width);
    }
    return part;
  }

  render::Image rendered(const std::string& scene, int frame, const std::string& options) const {
    const std::string name = fmt::format("{}{}{}", scene, frame, options.size());
    const ProgramResult result = run_pneuma(fmt::format(
        "render {} --frames {}-{} --size 640x480 --set picture.caption=false --out '{}' {} 2>&1",
        scene, frame, frame, (folder_ / name).string(), options));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return render::read_png((folder_ / name / fmt::format("{}_{:05}.png", scene, frame)).string());
  }

  TemporaryFolder folder_;
  std::string browser_;
};

/// Edges, the grid and the soft rims of shadows fall a little differently; a body, a shadow or a
/// disc that is missing or in another place changes more pixels than these.
void expect_alike(const render::Image& browser, const render::Image& own, double mean = 0.9,
                  double beyond = 0.005) {
  const render::ImageDifference difference = render::compare_images(browser, own, 24);
  EXPECT_LE(difference.mean, mean);
  EXPECT_LE(difference.fraction_beyond, beyond);
}

TEST_F(LongBrowser, DrawsWhatTheRendererDraws) {
  export_page(
      "torus_three_spheres_four_cubes --set camera.eye=[0,-30,14] --set camera.target=[0,0,3]");
  std::string said;
  for (const int frame : {0, 75, 200}) {
    const std::string camera = "--set camera.eye=[0,-30,14] --set camera.target=[0,0,3]";
    expect_alike(shown("torus_three_spheres_four_cubes.html",
                       fmt::format("frame={}&bare=640x480", frame), said),
                 rendered("torus_three_spheres_four_cubes", frame, camera));
  }
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, DrawsEveryPaperSceneAtThreeTimes) {
  for (const std::filesystem::path& scene : scenes_of_the_paper()) {
    const std::string name = scene.stem().string();
    SCOPED_TRACE(name);
    export_page(name + " --set picture.caption=false");
    const int last =
        ReadReplay(read_text(folder_ / (name + ".html"))).header["frames"].get<int>() - 1;
    std::string said;
    for (const int frame : {0, last / 2, last}) {
      SCOPED_TRACE(frame);
      expect_alike(shown(name + ".html", fmt::format("frame={}&bare=640x480", frame), said),
                   rendered(name, frame, ""));
    }
    EXPECT_EQ(said, "");
  }
}

/// Flat faces alone make smaller differences: a crack that is not dark is one beyond these.
TEST_F(LongBrowser, DrawsAHeapOfCubes) {
  export_page("cubes_on_torus --frames 90-220");
  std::string said;
  for (const int frame : {90, 220}) {
    SCOPED_TRACE(frame);
    expect_alike(shown("cubes_on_torus.html", fmt::format("frame={}&bare=640x480", frame), said),
                 rendered("cubes_on_torus", frame, ""), 0.4, 0.002);
  }
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, DrawsParticlesAndContacts) {
  export_page("two_spheres_contact --frames 31");
  std::string said;
  expect_alike(
      shown("two_spheres_contact.html", "frame=30&show=particles,contacts&bare=640x480", said),
      rendered("two_spheres_contact", 30, "--show particles,contacts"));
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, DrawsEdges) {
  export_page("torus_four_cubes --frames 61");
  std::string said;
  expect_alike(shown("torus_four_cubes.html", "frame=60&show=wireframe&bare=640x480", said),
               rendered("torus_four_cubes", 60, "--show wireframe"));
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, FollowsACameraThatMoves) {
  const std::string camera =
      "--set camera.eye=[0,-30,14] --set camera.target=[0,0,3] --set camera.orbit=90";
  export_page("two_spheres_contact --frames 41 " + camera);
  std::string said;
  const render::Image turned = shown("two_spheres_contact.html", "frame=40&bare=640x480", said);
  expect_alike(turned, rendered("two_spheres_contact", 40, camera));
  const render::Image first = shown("two_spheres_contact.html", "frame=0&bare=640x480", said);
  EXPECT_GT(render::compare_images(turned, first, 24).fraction_beyond, 0.02) << "it stays";
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, CanBeScrubbedAndToggled) {
  export_page("two_spheres_contact --frames 41");
  const std::string page = "two_spheres_contact.html";
  const std::string scrub =
      "element('frame').value = 30; element('frame').dispatchEvent(new Event('input'));";
  const std::string press_p = "dispatchEvent(new KeyboardEvent('keydown', {key: 'p'}));";
  std::string said;
  const render::Image plain = rendered("two_spheres_contact", 30, "");
  const render::Image particles = rendered("two_spheres_contact", 30, "--show particles");
  EXPECT_GT(render::compare_images(plain, particles, 24).fraction_beyond, 0.01);
  expect_alike(shown_after(scrub, page, "frame=0", said), plain);
  expect_alike(shown_after("element('particles').click();", page, "frame=30", said), particles);
  expect_alike(shown_after(scrub + press_p, page, "frame=0", said), particles);
  expect_alike(shown_after(press_p + press_p, page, "frame=30", said), plain);
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, LeavesTheCameraToWhoTakesHoldOfIt) {
  const std::string still = "--set camera.eye=[0,-30,14] --set camera.target=[0,0,3] ";
  export_page("two_spheres_contact --frames 41 --set camera.orbit=90 " + still);
  const std::string page = "two_spheres_contact.html";
  const std::string take =
      "element('picture').dispatchEvent(new WheelEvent('wheel', {deltaY: 1e-9}));";
  const std::string go_on =
      "element('frame').value = 40; element('frame').dispatchEvent(new Event('input'));";
  std::string said;
  expect_alike(shown_after(take + go_on, page, "frame=0", said),
               rendered("two_spheres_contact", 40, still));
  expect_alike(
      shown_after(take + go_on + "element('picture').dispatchEvent(new MouseEvent('dblclick'));",
                  page, "frame=0", said),
      rendered("two_spheres_contact", 40, "--set camera.orbit=90 " + still));
  EXPECT_EQ(said, "");
}

TEST_F(LongBrowser, ShowsThePlayer) {
  export_page("one_sphere --frames 40");
  std::string said;
  const render::Image player = shown("one_sphere.html", "frame=30", said);
  const render::Image bare = shown("one_sphere.html", "frame=30&bare=640x480", said);
  EXPECT_GT(render::compare_images(player, bare, 24).fraction_beyond, 0.1) << "no controls";
  EXPECT_EQ(said, "");
}

}  // namespace
}  // namespace pneuma::app
