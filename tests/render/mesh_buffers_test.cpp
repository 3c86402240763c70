#include "render/passes/mesh_buffers.h"

#include <gtest/gtest.h>

#include "render/context/context.h"
#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

TEST(MeshBuffers, AShapeIsKeptOnceAndWhileItLives) {
  Context context;
  MeshBuffers buffers;
  std::vector<Mesh> meshes = {make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0})};
  meshes.push_back(meshes[0]);
  meshes.push_back(make_box({2, 0, 0}, {1, 1, 1}, {0, 1, 0}));
  buffers.upload(meshes);
  EXPECT_EQ(buffers.meshes().size(), 3u);
  EXPECT_EQ(buffers.shape_count(), 2u);
  buffers.upload(meshes);
  EXPECT_EQ(buffers.shape_count(), 2u);
  // Out of the picture for a while, but alive.
  buffers.upload({});
  EXPECT_EQ(buffers.shape_count(), 2u);
  meshes.pop_back();
  buffers.upload({});
  EXPECT_EQ(buffers.shape_count(), 1u);
  meshes.clear();
  buffers.upload({});
  EXPECT_EQ(buffers.shape_count(), 0u);
}

TEST(MeshBuffers, SaysHowEachMeshIsDrawn) {
  Context context;
  MeshBuffers buffers;
  buffers.upload(
      {make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0}), make_ball({0, 0, 0}, 1, {1, 0, 0}, 6)});
  ASSERT_EQ(buffers.meshes().size(), 2u);
  EXPECT_FALSE(buffers.meshes()[0].smooth);
  EXPECT_EQ(buffers.meshes()[0].index_count, 36);
  EXPECT_TRUE(buffers.meshes()[1].smooth);
  EXPECT_EQ(buffers.meshes()[1].index_count, 6 * 12 * 6);
}

TEST(MeshBuffers, ANewShapeInADeadOnesPlaceIsAnotherOne) {
  const auto box_frame = [](const Colour& colour) {
    Frame frame = empty_frame();
    frame.meshes = {make_box({0, 0, 0}, {2, 2, 2}, colour)};
    return frame;
  };
  Renderer renderer(small_picture());
  Image image;
  // Freed and allocated again without anything between: mostly at the same address.
  for (const Colour& colour : {Colour(0.9f, 0, 0), Colour(0, 0.9f, 0), Colour(0, 0, 0.9f)}) {
    const Frame frame = box_frame(colour);
    renderer.draw(frame, image);
    EXPECT_EQ(image.pixels, draw_once(frame, small_picture()).pixels);
  }
}

}  // namespace
}  // namespace pneuma::render
