// What --show takes, and what it puts into a frame.
#include "app/picture/show.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/host/errors.h"
#include "app/picture/build_frame.h"
#include "app/picture/colour_field.h"
#include "app/picture/field_scale.h"
#include "app/picture/ghost.h"
#include "app/world/build_world.h"
#include "render/frame/check_frame.h"
#include "scenes/loader/load_scene.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

TEST(ParseShow, TakesAListOfKnownNames) {
  EXPECT_TRUE(parse_show("--show", "wireframe").wireframe);
  EXPECT_TRUE(parse_show("--show", "wireframe,wireframe").wireframe);
  const Show show = parse_show("--show", "labels,velocity=2.5,ghost");
  EXPECT_TRUE(show.labels && show.ghost);
  EXPECT_EQ(show.field, ColourField::velocity);
  EXPECT_EQ(show.field_end, 2.5);
  for (const char* wrong :
       {"", "wire", "wireframe,", ",wireframe", "wireframe particles", "strain,velocity",
        "impulses=", "impulses=0", "impulses=-1", "impulses=x", "strain=", "strain=0", "strain=-1",
        "strain=x", "strain=1x", "strain=inf", "labels=1"}) {
    EXPECT_THROW(parse_show("--show", wrong), UsageError) << wrong;
  }
}

TEST(ShownNames, AreWhatParseShowTakes) {
  for (const char* list : {"wireframe,particles,contacts,impulses,ghost,labels,scale", "strain",
                           "impulses=0.25,scale,pressure=0.125"}) {
    std::string names;
    for (const std::string& name : shown_names(parse_show("--show", list))) {
      names += (names.empty() ? "" : ",") + name;
    }
    EXPECT_EQ(names, list);
  }
}

constexpr const char* ball_and_box = R"(
[[body]]
name = "ball"
radius = 2.0
n = 1.5
position = [0.0, 0.0, 5.0]
velocity = [3.0, 0.0, 4.0]
[[body]]
name = "box"
kind = "rigid"
position = [9.0, 0.0, 5.0]
velocity = [0.0, 2.0, 0.0]
)";

struct Made {
  scenes::Scene scene = scenes::parse_scene(ball_and_box, "x.toml");
  sim::World world = build_world(scene);

  render::Frame frame(const std::string& list) const {
    const render::Frame made =
        FrameBuilder(scene, world).build(world, {}, {}, parse_show("--show", list));
    EXPECT_NO_THROW(render::check_frame(made));
    return made;
  }
};

TEST(ColourField, IsThePressureOfTheGasLaw) {
  const Made made;
  double volume = 0.0;
  const sim::SoftBody& ball = made.world.soft[0];
  for (const auto& [a, b, c] : ball.mesh->topology.triangles()) {
    const Vec3 x = ball.positions[a], y = ball.positions[b], z = ball.positions[c];
    volume += x.dot(y.cross(z)) / 6.0;
  }
  const auto values = field_values(made.world, ColourField::pressure);
  EXPECT_NEAR(values[0][0], 1.5 * 8.314472 * 293.15 / volume, 1e-9 * values[0][0]);
  EXPECT_TRUE(values[1].empty()) << "a box has no gas";
}

TEST(ColourField, IsTheSpeedOfEachVertex) {
  const auto values = field_values(Made().world, ColourField::velocity);
  for (const double speed : values[0]) EXPECT_DOUBLE_EQ(speed, 5.0);
  for (const double speed : values[1]) EXPECT_DOUBLE_EQ(speed, 2.0);
}

TEST(ColourField, IsTheLargestStrainOfAVertexsSprings) {
  Made made;
  sim::SoftBody& ball = made.world.soft[0];
  const auto at_rest = field_values(made.world, ColourField::strain);
  for (const double strain : at_rest[0]) EXPECT_NEAR(strain, 0.0, 1e-12);
  const Vec3 centre = sim::mean(ball.positions);
  for (int v = 0; v < ball.positions.size(); ++v) {
    ball.positions[v] = centre + 1.25 * (Vec3(ball.positions[v]) - centre);
  }
  const auto blown_up = field_values(made.world, ColourField::strain);
  for (const double strain : blown_up[0]) EXPECT_NEAR(strain, 0.25, 1e-12);
}

TEST(ColourField, ColoursMeshesByTheLegend) {
  const render::Frame frame = Made().frame("velocity=10");
  ASSERT_TRUE(frame.legend);
  EXPECT_EQ(frame.legend->ticks.back().text, "10");
  EXPECT_EQ(frame.meshes[0].colours.at(0), viridis(0.5));
  EXPECT_EQ(frame.meshes[1].colours.at(0), viridis(0.2));
  // Without an end the picture's own: 5 m/s is a round number.
  EXPECT_EQ(Made().frame("velocity").legend->ticks.back().text, "5");
  const render::Frame pressure = Made().frame("pressure");
  EXPECT_EQ(pressure.meshes[1].colours.at(0), pressure.meshes[1].colours.at(7));
  EXPECT_FALSE(Made().frame("ghost").legend);
}

TEST(ColourField, LeavesSpringsAndValvesGrey) {
  const scenes::Scene scene = scenes::parse_scene(R"(
[[body]]
name = "left"
[[body]]
name = "right"
position = [9.0, 0.0, 0.0]
[[spring]]
from = "left"
to = "right"
[[valve]]
from = "left"
to = "right"
)",
                                                  "x.toml");
  const sim::World world = build_world(scene);
  for (const char* field : {"strain", "velocity", "pressure"}) {
    const render::Frame frame =
        FrameBuilder(scene, world).build(world, {}, {}, parse_show("--show", field));
    EXPECT_NO_THROW(render::check_frame(frame)) << field;
    ASSERT_EQ(frame.meshes.size(), 4) << field;
    const render::Colour ball = frame.meshes[0].colours.at(0);
    EXPECT_NE(ball.x(), ball.y()) << field;
    for (const std::size_t joint : {2u, 3u}) {
      const render::Mesh& mesh = frame.meshes[joint];
      ASSERT_EQ(mesh.colours.size(), mesh.positions.size()) << field;
      for (const render::Colour& grey : mesh.colours) EXPECT_EQ(grey.x(), grey.y()) << field;
    }
  }
}

TEST(FieldScale, OnlyGrowsAndIsThatOfTheRunSoFar) {
  const Pictures pictures = {.show = parse_show("--show", "velocity"), .overlay = std::nullopt};
  FieldScale whole(pictures), resumed(pictures);
  Made made;
  const auto tick = [&](const FieldScale& scale) {
    return FrameBuilder(made.scene, made.world)
        .build(made.world, {}, {}, scale.with_end(pictures.show))
        .legend.value();
  };
  whole.see(made.world);
  EXPECT_EQ(tick(whole).ticks.back().text, "5");
  EXPECT_EQ(tick(whole).title, "speed, m/s, run so far");
  for (const double factor : {3.0, 0.1}) {
    sim::VertexArray& velocities = made.world.soft[0].velocities;
    for (int v = 0; v < velocities.size(); ++v) velocities[v] = factor * Vec3(velocities[v]);
    resumed.go_on(whole.seen());
    whole.see(made.world);
    resumed.see(made.world);
    EXPECT_EQ(tick(whole).ticks.back().text, "20") << factor;
    EXPECT_EQ(tick(resumed).ticks.back().text, "20") << factor;
  }
  // An end of its own stays.
  const Show fixed = parse_show("--show", "velocity=7");
  EXPECT_EQ(FieldScale({.show = fixed, .overlay = std::nullopt}).with_end(fixed).field_end, 7.0);
}

TEST(Caption, SaysWhatMarksMean) {
  EXPECT_NE(Made().frame("particles").caption->text.find("\nparticles: "), std::string::npos);
  EXPECT_NE(Made().frame("contacts").caption->text.find("\ncontacts, "), std::string::npos);
  EXPECT_EQ(Made().frame("wireframe").caption->text.find("contacts"), std::string::npos);
}

TEST(RoundEnd, IsTheNextOfOneTwoFive) {
  for (const auto& [value, end] : {std::pair(0.0, 1.0),
                                   {2e-13, 1.0},  // rounding, which is no field
                                   {1.0, 1.0},
                                   {1.1, 2.0},
                                   {3.0, 5.0},
                                   {7.0, 10.0},
                                   {0.03, 0.05},
                                   {5000.0, 5000.0}}) {
    EXPECT_DOUBLE_EQ(round_end(value), end) << value;
  }
}

TEST(Viridis, GrowsLighterFromEndToEnd) {
  const auto lightness = [](double part) {
    return render::Vec3f(0.2126f, 0.7152f, 0.0722f).dot(viridis(part));
  };
  for (double part = 0.0; part < 0.99; part += 0.01) {
    EXPECT_LT(lightness(part), lightness(part + 0.01)) << part;
  }
  EXPECT_EQ(viridis(-1.0), viridis(0.0));
  EXPECT_EQ(viridis(2.0), viridis(1.0));
}

TEST(Ghost, FindsHowABodyWasTurnedAndMoved) {
  Made made;
  sim::SoftBody& ball = made.world.soft[0];
  const Eigen::AngleAxisd turn(2.1, Vec3(1.0, 2.0, -0.5).normalized());
  const Vec3 shift = {3.0, -4.0, 5.0};
  const Vec3 centre = sim::mean(ball.mesh->rest_positions);
  for (int v = 0; v < ball.positions.size(); ++v) {
    // Also blown up, which is no matter of its pose.
    const Vec3 rest = ball.mesh->rest_positions[v];
    ball.positions[v] = shift + turn * (centre + 1.5 * (rest - centre));
  }
  const Eigen::Isometry3d pose = pose_of(ball);
  EXPECT_LT((pose.linear() - turn.toRotationMatrix()).norm(), 1e-12);
  EXPECT_LT((pose * centre - (shift + turn * centre)).norm(), 1e-12);
}

TEST(Impulses, AreArrowsFromTheirContactsByTheScaleInTheCaption) {
  const Made made;
  std::vector<sim::Contact> contacts(2);
  for (sim::Contact& contact : contacts) contact.normal = Vec3::UnitZ();
  contacts[0].point = {1.0, 2.0, 0.5};
  contacts[0].impulse = {0.0, 0.0, 3.0};
  contacts[1].impulse = {0.0, 0.75, 0.0};
  render::Camera camera;
  camera.eye = {0.0f, -20.0f, 5.0f};
  const FrameBuilder builder(made.scene, made.world);
  const render::Frame frame =
      builder.build(made.world, camera, contacts, parse_show("--show", "impulses=1.5"));
  EXPECT_NO_THROW(render::check_frame(frame));
  EXPECT_EQ(frame.points.size(), 2u);
  ASSERT_EQ(frame.lines.size(), 6u) << "a shaft and two sides of a head each";
  EXPECT_LT((frame.lines[0].from - render::Vec3f(1.0f, 2.0f, 0.5f)).norm(), 1e-6f);
  EXPECT_LT((frame.lines[0].to - render::Vec3f(1.0f, 2.0f, 2.5f)).norm(), 1e-6f);
  EXPECT_LT((frame.lines[3].to - render::Vec3f(0.0f, 0.5f, 0.0f)).norm(), 1e-6f);
  for (const std::size_t side : {1u, 2u}) EXPECT_EQ(frame.lines[side].to, frame.lines[0].to);
  ASSERT_TRUE(frame.caption);
  EXPECT_NE(frame.caption->text.find("1 m is an impulse of 1.5 N s"), std::string::npos);
  // Without a scale the picture's own, a round one that keeps the longest within a fifth.
  const render::Frame own =
      builder.build(made.world, camera, contacts, parse_show("--show", "impulses"));
  const float longest = (own.lines[0].to - own.lines[0].from).norm();
  const float height =
      2.0f * std::tan(camera.field_of_view * 0.5f * 0.0174533f) * camera.eye.norm();
  EXPECT_LE(longest, 0.2f * height * 1.0001f);
  EXPECT_GE(longest, 0.2f * height / 2.5001f);
  EXPECT_TRUE(
      builder.build(made.world, camera, {}, parse_show("--show", "impulses")).lines.empty());
}

TEST(Ghost, IsDrawnAsTheEdgesOfTheRestShape) {
  const Made made;
  const render::Frame frame = made.frame("ghost");
  const auto& edges = made.world.soft[0].mesh->topology.edges();
  ASSERT_EQ(frame.lines.size(), edges.size());
  EXPECT_TRUE(frame.lines.front().always_visible);
  EXPECT_EQ(frame.lines.front().through, 0u) << "and no box before it";
  // At the start the body is its rest shape; single precision.
  const render::Vec3f from = Vec3(made.world.soft[0].positions[edges[0][0]]).cast<float>();
  EXPECT_LT((frame.lines.front().from - from).norm(), 1e-5f);
}

/// Over its top it would lie on what is stacked on it.
TEST(Labels, NameEveryBodyOnIt) {
  const render::Frame frame = Made().frame("labels,scale");
  ASSERT_EQ(frame.labels.size(), 2u);
  EXPECT_EQ(frame.labels[0].text, "ball");
  EXPECT_NEAR(frame.labels[0].position.z(), 5.0f, 1e-5f);
  EXPECT_EQ(frame.labels[1].text, "box");
  EXPECT_TRUE(frame.scale_bar);
}

}  // namespace
}  // namespace pneuma::app
