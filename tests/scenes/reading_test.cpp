// What a valid scene file sets, compared with a scene put together by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/sections.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

TEST(Reading, ABareBodyGivesTheStructsDefaults) {
  Scene expected;
  expected.name = "bare";
  expected.bodies.resize(2);
  expected.bodies[0].name = "body1";
  expected.bodies[1].name = "body2";
  expected.bodies[1].kind = BodyKind::rigid;
  expected.bodies[1].shape = Shape::box;
  expected.bodies[1].colours = palette_colours(1);
  const Scene scene = parse_scene("[[body]]\n[[body]]\nkind = \"rigid\"\n", "folder/bare.toml");
  EXPECT_EQ(difference(scene, expected), "");
}

/// Each key has another value than its default, but `contact`, on which others depend.
constexpr std::string_view every_key = R"(
title = "A title"
figure = "figure 6.4"
paper_fps = 51.5
duration = 2.5

[simulation]
steps_per_second = 240
integrator = "velocity_verlet"
gravity = [1.0, 2.0, -3.0]
ambient_pressure = 101325
skin_thickness = 0.25
soft_search = "exact"
contact = "impulses"
relaxation_time = 0.125
contact_iterations = 4
seed = 9223372036854775807

[simulation.particles]
per_vertex = 0.5
attraction = 3.0
max_sweeps = 11
settled_below = 7

[ground]
restitution = 0.75
friction = 0.125

[camera]
azimuth = 10.0
elevation = 20.0
field_of_view = 30.0

[picture]
width = 640
height = 480
frames_per_second = 24
samples = 2
shadows = false
caption = false
pressures = true
grid = false
rounded = false

[limits]
bodies = 31
vertices_per_body = 1001
vertices = 1002
frames = 1003
memory_gib = 0.5
picture_side = 4096
model_file_mib = 32.5
scene_file_mib = 0.25

[[body]]
)";

Scene every_member() {
  Scene expected;
  expected.name = "all";
  expected.title = "A title";
  expected.figure = "figure 6.4";
  expected.paper_fps = 51.5;
  expected.duration = 2.5;
  expected.settings = {
      .steps_per_second = 240,
      .integrator = sim::Integrator::velocity_verlet,
      .gravity = {1.0, 2.0, -3.0},
      .ground = sim::ContactMaterial{.restitution = 0.75, .friction = 0.125},
      .contact = sim::ContactMethod::impulses,
      .skin_thickness = 0.25,
      .soft_search = sim::SoftSearch::exact,
      .potential = {},
      .particles = {.per_vertex = 0.5, .attraction = 3.0, .max_sweeps = 11, .settled_below = 7},
      .relaxation_time = 0.125,
      .contact_iterations = 4,
      .seed = 9223372036854775807u};
  expected.ambient_pressure = 101325.0;
  expected.camera.azimuth = 10.0;
  expected.camera.elevation = 20.0;
  expected.camera.field_of_view = 30.0;
  expected.picture = {.width = 640,
                      .height = 480,
                      .frames_per_second = 24,
                      .samples = 2,
                      .shadows = false,
                      .caption = false,
                      .pressures = true,
                      .grid = false,
                      .rounded = false};
  expected.limits = {.bodies = 31,
                     .vertices_per_body = 1001,
                     .vertices = 1002,
                     .frames = 1003,
                     .memory_gib = 0.5,
                     .picture_side = 4096,
                     .model_file_mib = 32.5,
                     .scene_file_mib = 0.25};
  expected.bodies.resize(1);
  expected.bodies[0].name = "body1";
  return expected;
}

TEST(Reading, EveryKeyOutsideOfBodiesSetsItsMember) {
  const Scene scene = parse_scene(every_key, "all.toml");
  EXPECT_EQ(difference(scene, every_member()), "");
}

constexpr std::string_view soft_body = R"(
[[body]]
name = "wheel"
kind = "soft"
shape = "torus"
radius = 4.5
tube_radius = 1.25
stacks = 12
slices = 10
rest = "equilibrium"
k = 400
n = 11
temperature = 300.5
gas_exponent = 1.4
vertex_mass = 0.75
pressure_weighting = "valence"
damping = "literal"
rho_g = 0.0625
k_max = 1000
restitution = 0.375
friction = 0.875
position = [1, 2.5, 3]
rotation = [4, 5, 6]
velocity = [7, 8, 9]
angular_velocity = [10, 11, 12]
copies = [2, 3, 4]
spacing = [13, 14, 15]
jitter = 0.5
tumble = true
colours = ["#0123aB", "#456789"]
colour_axis = [0.0, 1.0, 0.5]
roughness = 0.75
drawn = "edges"
)";

Scene soft_body_scene() {
  BodyScene expected;
  expected.name = "wheel";
  expected.shape = Shape::torus;
  expected.roughness = 0.75;
  expected.drawn = Drawn::edges;
  expected.radius = 4.5;
  expected.tube_radius = 1.25;
  expected.stacks = 12;
  expected.slices = 10;
  expected.rest = Rest::equilibrium;
  expected.material = {.k = 400.0,
                       .n = 11.0,
                       .temperature = 300.5,
                       .gas_exponent = 1.4,
                       .vertex_mass = 0.75,
                       .pressure_weighting = sim::PressureWeighting::valence,
                       .damping = sim::Damping::literal,
                       .rho_g = 0.0625,
                       .k_max = 1000.0,
                       .surface = {.restitution = 0.375, .friction = 0.875}};
  expected.position = {1.0, 2.5, 3.0};
  expected.rotation = {4.0, 5.0, 6.0};
  expected.velocity = {7.0, 8.0, 9.0};
  expected.angular_velocity = {10.0, 11.0, 12.0};
  expected.copies = {2, 3, 4};
  expected.spacing = {13.0, 14.0, 15.0};
  expected.jitter = 0.5;
  expected.tumble = true;
  expected.colours = {"#0123aB", "#456789"};
  expected.colour_axis = {0.0, 1.0, 0.5};
  Scene whole;
  whole.name = "soft";
  whole.bodies = {expected};
  return whole;
}

TEST(Reading, EveryKeyOfASoftBodySetsItsMember) {
  const Scene scene = parse_scene(soft_body, "soft.toml");
  EXPECT_EQ(difference(scene, soft_body_scene()), "");
}

/// The names of the keys that apply to a section and have the same value as in one of the defaults.
std::vector<std::string> keys_at_default(const Section& section, const Section& of_defaults) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < section.keys.size(); ++i) {
    const Key& key = section.keys[i];
    if (!key.applies || value_text(key.slot) != value_text(of_defaults.keys[i].slot)) continue;
    names.push_back(std::string(section.table).append(".").append(key.name));
  }
  return names;
}

// So that a new key is also tested above. The keys named here exclude others, which are set there;
// KeysOfTheOtherShapesSetTheirMembers sets them, method_test.cpp the method, gas_keys_test.cpp the
// gas, joint_keys_test.cpp gas that flows and the skin, camera_keys_test.cpp moving cameras;
// bending_keys_test.cpp bending.
TEST(Reading, NoKeyIsLeftOutAbove) {
  Scene scene = parse_scene(every_key, "all.toml"), defaults;
  const std::vector<Section> sections = fixed_sections(scene);
  const std::vector<Section> of_defaults = fixed_sections(defaults);
  std::vector<std::string> missed;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    std::ranges::copy(keys_at_default(sections[i], of_defaults[i]), std::back_inserter(missed));
  }
  std::erase(missed, "simulation.contact");  // either one: it decides about others
  EXPECT_EQ(missed, std::vector<std::string>({"simulation.method", "ground.present", "camera.eye",
                                              "camera.target", "camera.path", "camera.follow",
                                              "camera.orbit"}));

  Scene soft = parse_scene(soft_body, "soft.toml");
  BodyScene body;
  EXPECT_EQ(keys_at_default(body_section(soft.bodies[0]), body_section(body)),
            std::vector<std::string>({"body.kind", "body.stiffness", "body.bending",
                                      "body.gauge_pressure", "body.inflation", "body.supply.n",
                                      "body.supply.temperature", "body.leak.area", "body.density",
                                      "body.mass", "body.pinned"}));
}

TEST(Reading, KeysOfTheOtherShapesSetTheirMembers) {
  const Scene scene = parse_scene(R"(
[camera]
eye = [1, 2, 3]
target = [4, 5, 6]
[ground]
present = false
[[body]]
shape = "icosphere"
subdivisions = 3
[[body]]
shape = "box"
divisions = 5
size = [1, 2, 3]
[[body]]
kind = "rigid"
size = [4, 5, 6]
mass = 7
rho_g = 0.75
restitution = 0.5
friction = 0.25
)",
                                  "x.toml");
  EXPECT_EQ(scene.camera.eye, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(scene.camera.target, Vec3(4.0, 5.0, 6.0));
  EXPECT_FALSE(scene.settings.ground);
  EXPECT_EQ(scene.bodies[0].subdivisions, 3);
  EXPECT_EQ(scene.bodies[1].divisions, 5);
  EXPECT_EQ(scene.bodies[1].size, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(scene.bodies[2].size, Vec3(4.0, 5.0, 6.0));
  EXPECT_EQ(scene.bodies[2].mass, 7.0);
  EXPECT_EQ(scene.bodies[2].rho_g, 0.75);
  EXPECT_EQ(scene.bodies[2].surface.restitution, 0.5);
  EXPECT_EQ(scene.bodies[2].surface.friction, 0.25);
}

TEST(Reading, ZeroIsAllowedWhereItHasAMeaning) {
  const Scene scene = parse_scene("[[body]]\nk = 0\nn = 0\ntemperature = 0\nrho_g = 0\n", "x.toml");
  EXPECT_EQ(scene.bodies[0].material.k, 0.0);
  EXPECT_EQ(scene.bodies[0].material.n, 0.0);
  EXPECT_EQ(scene.bodies[0].material.temperature, 0.0);
  EXPECT_EQ(scene.bodies[0].material.rho_g, 0.0);
}

TEST(Reading, DurationsThatBinaryCannotHoldAreWholeFrames) {
  for (const char* duration : {"0.1", "0.7", "1.1", "0.03333333333333333", "1199.9"}) {
    const std::string text = std::string("duration = ") + duration + "\n[[body]]\n";
    EXPECT_NO_THROW(parse_scene(text, "x.toml")) << duration;
  }
}

TEST(Reading, FramesAloneGetTheNextStepsThatTheyDivide) {
  const auto read = [](const std::string& text) {
    return parse_scene(text + "[[body]]\n", "x.toml");
  };
  const auto steps = [&](const std::string& text) { return read(text).settings.steps_per_second; };
  EXPECT_EQ(steps(""), 60);
  EXPECT_EQ(steps("[picture]\nframes_per_second = 20\n"), 60);
  EXPECT_EQ(steps("[picture]\nframes_per_second = 24\n"), 72);
  EXPECT_EQ(steps("[picture]\nframes_per_second = 120\n"), 120);
  EXPECT_FALSE(read("[picture]\nframes_per_second = 24\n").names_step);
  EXPECT_TRUE(read("simulation.steps_per_second = 60\n").names_step);
}

TEST(Reading, QuotesAndCommentsHoldWhatTomlLetsThem) {
  const std::string dots(150, '.');  // more than keys may have on a line
  std::string text = "\xef\xbb\xbf# gr\xc3\xb6\xc3\x9fte \"Kugel\r\n";  // as Windows writes it
  text.append("title = \"a \\\" # ").append(dots).append("\" # \"\"\" \xff ").append(dots);
  text.append("\r\nfigure = 'a\\\"b' # '''\r\n[[body]]\r\n");
  const Scene scene = parse_scene(text, "x.toml");
  EXPECT_EQ(scene.title, std::string("a \" # ").append(dots));
  EXPECT_EQ(scene.figure, "a\\\"b");
}

// As programs write them. Dots of numbers nest no tables.
TEST(Reading, ALineMayHoldAnyNumberOfNumbers) {
  std::string text = "[[body]]\nkind = \"moved\"\nmotion.path = [";
  for (int i = 0; i < 150; ++i) text += fmt::format("[{}.5, 0.25, -1.5e-3, 9.0], ", i);
  const Scene scene = parse_scene(text + "]\n", "test.toml");
  EXPECT_EQ(scene.bodies.front().motion.path.size(), 150U);
}

TEST(Reading, AFileThatCannotBeReadSaysWhy) {
  const auto message = [](const char* path) {
    try {
      load_scene(path);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("/nowhere/x.toml"),
            "/nowhere/x.toml: cannot be opened: No such file or directory; check the name and its "
            "permissions");
  EXPECT_EQ(message("/tmp"), "/tmp: is a folder; name a scene file in it");
  EXPECT_NE(message("/dev/zero").find("1048577 bytes and more are more than the limit of 1 MiB"),
            std::string::npos);
}

}  // namespace
}  // namespace pneuma::scenes
