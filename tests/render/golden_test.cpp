// One line adds one picture: a name and the frame it shows. Each is drawn at 320 x 240.
#include "tests/render/golden.h"

#include <gtest/gtest.h>

#include "render/frame/camera.h"
#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

const Colour red = {0.9f, 0.15f, 0.1f};
const Colour olive = {0.4f, 0.5f, 0.1f};
const Colour green = {0.15f, 0.75f, 0.2f};
const Colour yellow = {1.0f, 0.85f, 0.2f};

Frame seen_from(Frame frame, float azimuth, float elevation) {
  Box box;
  for (const Mesh& mesh : frame.meshes) {
    for (const Vec3f& position : mesh.positions) box.grow(position);
  }
  frame.camera = look_at_bounds(box, {azimuth, elevation}, 35.0f, 4.0f / 3.0f, 0.25f);
  return frame;
}

Frame balls() {
  Frame frame;
  frame.meshes = {make_ball({0, 0, 1}, 1.0f, red), make_ball({0.4f, 0.2f, 2.9f}, 1.0f, olive)};
  return seen_from(frame, 20.0f, 20.0f);
}

Frame balls_with_particles_and_caption() {
  Frame frame = balls();
  for (int i = 0; i < 9; ++i) {
    const float x = 0.2f * static_cast<float>(i - 4);
    frame.points.push_back({{x, -0.9f, 1.9f}, i % 2 == 0 ? yellow : red, 6.0f, true});
    frame.points.push_back({{x, 0.9f, 1.9f}, yellow, 6.0f, i % 2 == 0});
  }
  frame.caption = Caption{"two balls\nt = 1.25 s"};
  return frame;
}

Frame ring() {
  Frame frame;
  frame.meshes = {make_ring({0, 0, 0.6f}, 1.5f, 0.6f, green, olive)};
  return seen_from(frame, -15.0f, 30.0f);
}

Frame ring_as_wireframe() {
  Frame frame = ring();
  frame.wireframe = true;
  return frame;
}

Frame boxes() {
  Frame frame;
  for (int i = 0; i < 12; ++i) {
    const auto number = static_cast<float>(i);
    frame.meshes.push_back(make_painted_box(
        {std::cos(2.4f * number) * 1.5f, std::sin(2.4f * number) * 1.5f, 0.5f + 0.25f * number},
        0.6f, number));
  }
  return seen_from(frame, 40.0f, 15.0f);
}

Frame boxes_without_shadows() {
  Frame frame = boxes();
  frame.light.shadows = false;
  return frame;
}

Frame axes_without_ground() {
  Frame frame = seen_from(ring(), 30.0f, 35.0f);
  frame.ground.reset();
  frame.lines = {{Vec3f::Zero(), {2.5f, 0, 0}, red, 3.0f},
                 {Vec3f::Zero(), {0, 2.5f, 0}, green, 3.0f},
                 {Vec3f::Zero(), {0, 0, 2.5f}, {0.2f, 0.3f, 0.9f}, 3.0f}};
  return frame;
}

Frame ground_to_the_horizon() {
  Frame frame;
  frame.camera = {{0.0f, -6.0f, 1.2f}, {0.0f, 0.0f, 1.0f}, 50.0f};
  return frame;
}

struct GoldenCase {
  const char* name;
  Frame (*frame)();
};

void PrintTo(const GoldenCase& golden, std::ostream* out) { *out << golden.name; }

class Golden : public testing::TestWithParam<GoldenCase> {};

TEST_P(Golden, LooksAsItDid) {
  expect_golden(GetParam().name, draw_once(GetParam().frame(), small_picture()));
}

INSTANTIATE_TEST_SUITE_P(
    Render, Golden,
    testing::Values(GoldenCase{"balls", balls},
                    GoldenCase{"balls_with_particles_and_caption",
                               balls_with_particles_and_caption},
                    GoldenCase{"ring", ring}, GoldenCase{"ring_as_wireframe", ring_as_wireframe},
                    GoldenCase{"boxes", boxes},
                    GoldenCase{"boxes_without_shadows", boxes_without_shadows},
                    GoldenCase{"axes_without_ground", axes_without_ground},
                    GoldenCase{"ground_to_the_horizon", ground_to_the_horizon}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace pneuma::render
