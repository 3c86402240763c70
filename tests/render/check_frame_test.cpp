#include "render/frame/check_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

Frame good_frame() {
  Frame frame;
  frame.meshes = {make_ball({0, 0, 1}, 1.0f, {1, 0, 0}), make_box({2, 0, 1}, {1, 1, 1}, {0, 1, 0})};
  frame.points = {{{0, 0, 2}, {1, 1, 1}}};
  frame.lines = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}}};
  return frame;
}

/// A shape of the frame's mesh that may be changed.
MeshShape& own_shape(Frame& frame, std::size_t mesh) {
  auto shape = std::make_shared<MeshShape>(*frame.meshes[mesh].shape);
  frame.meshes[mesh].shape = shape;
  return *shape;
}

/// Each corner's its own.
std::vector<std::array<std::uint32_t, 3>>& give_corners_normals(MeshShape& shape) {
  shape.corner_normals.clear();
  for (std::uint32_t t = 0; t < shape.triangles.size(); ++t) {
    shape.corner_normals.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return shape.corner_normals;
}

struct BadCase {
  const char* name;
  const char* message;  // a part of it
  std::function<void(Frame&)> spoil;
};

const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();

const std::vector<BadCase> bad_cases = {
    {"nan_position", "mesh 1: position 3",
     [](Frame& f) { f.meshes[1].positions[3].y() = not_a_number; }},
    {"infinite_position", "mesh 0: position 5",
     [](Frame& f) { f.meshes[0].positions[5].x() = infinity; }},
    {"overflowing_position", "mesh 0: position 5",
     [](Frame& f) { f.meshes[0].positions[5].x() = 1e30f; }},
    {"nan_normal", "mesh 0: normal 2", [](Frame& f) { f.meshes[0].normals[2].z() = not_a_number; }},
    {"no_shape", "mesh 1 has no shape", [](Frame& f) { f.meshes[1].shape = nullptr; }},
    {"colours_missing", "colours", [](Frame& f) { own_shape(f, 1).colours.pop_back(); }},
    {"normals_missing", "normals", [](Frame& f) { f.meshes[0].normals.pop_back(); }},
    {"triangle_index", "mesh 1: triangle 2 names vertex 8",
     [](Frame& f) { own_shape(f, 1).triangles[2][1] = 8; }},
    {"corner_normals_missing", "mesh 1 has 12 triangles and normals of the corners of 11",
     [](Frame& f) { own_shape(f, 1).corner_normals.resize(11); }},
    {"corner_normal", "mesh 1: triangle 3 has a corner with normal 36",
     [](Frame& f) { give_corners_normals(own_shape(f, 1))[3][2] = 36; }},
    {"corner_normal_of_two_vertices", "mesh 1: normal 0 is of vertices ",
     [](Frame& f) { give_corners_normals(own_shape(f, 1))[0][1] = 0; }},
    {"edge_index", "mesh 1: edge 0 names vertex 99",
     [](Frame& f) { own_shape(f, 1).edges[0][1] = 99; }},
    {"camera_in_its_target", "camera", [](Frame& f) { f.camera.eye = f.camera.target; }},
    {"camera_nan", "camera", [](Frame& f) { f.camera.eye.x() = not_a_number; }},
    {"field_of_view", "field of view is 121", [](Frame& f) { f.camera.field_of_view = 121.0f; }},
    {"dark_light", "light", [](Frame& f) { f.light.direction.setZero(); }},
    {"softness", "softness", [](Frame& f) { f.light.softness = -0.1f; }},
    {"grid", "grid spacing", [](Frame& f) { f.ground->grid_spacing = 0.0f; }},
    {"point", "point 0", [](Frame& f) { f.points[0].position.z() = not_a_number; }},
    {"point_size", "diameter", [](Frame& f) { f.points[0].diameter = not_a_number; }},
    {"line", "line 0", [](Frame& f) { f.lines[0].to.z() = infinity; }},
    {"line_width", "width", [](Frame& f) { f.lines[0].width = 0.0f; }},
    {"line_through", "shines through mesh 9", [](Frame& f) { f.lines[0].through = 9; }},
};

void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.name; }

class BadFrame : public testing::TestWithParam<BadCase> {};

TEST_P(BadFrame, IsRefusedByName) {
  Frame frame = good_frame();
  ASSERT_NO_THROW(check_frame(frame));
  GetParam().spoil(frame);
  try {
    check_frame(frame);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Each, BadFrame, testing::ValuesIn(bad_cases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(CheckFrame, ARefusedFrameLeavesImageAndRendererAsTheyWere) {
  Renderer renderer(small_picture());
  Image image;
  renderer.draw(good_frame(), image);
  const Image before = image;
  Frame bad = good_frame();
  bad.meshes[1].positions[0].z() = not_a_number;
  EXPECT_THROW(renderer.draw(bad, image), std::invalid_argument);
  EXPECT_EQ(image.pixels, before.pixels);
  renderer.draw(good_frame(), image);
  EXPECT_EQ(image.pixels, before.pixels);
}

}  // namespace
}  // namespace pneuma::render
