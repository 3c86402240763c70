// Shadows against the geometry of light rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

const Vec3f diagonal = {1, 0, -1};  // light that shifts a shadow by the height of its caster

/// Seen from straight above, 16 pixels to a metre on the ground.
Frame from_above(std::vector<Mesh> meshes) {
  Frame frame;
  frame.camera = {{0, 0, 20}, Vec3f::Zero(), 40.0f};
  frame.light.direction = diagonal;
  frame.light.softness = 0.01f;
  frame.meshes = std::move(meshes);
  return frame;
}

struct Pair {
  Image with;
  Image without;
  Camera camera;

  /// What a point's pixel has lost to shadow, 0..1 of its brightness.
  double darkness(const Vec3f& point) const {
    const double lit = pixel_of(without, camera, point)[1];
    return 1.0 - pixel_of(with, camera, point)[1] / lit;
  }
};

Pair draw_pair(Frame frame) {
  frame.light.shadows = true;
  frame.light.between_bodies = false;
  const Image with = draw_once(frame, small_picture());
  frame.light.shadows = false;
  return {with, draw_once(frame, small_picture()), frame.camera};
}

TEST(Shadow, OfASlabLiesWhereItsRaysEnd) {
  // x -3..-1, y -1..1, at a height of 3: its shadow is shifted by 3 to x 0..2. The slab's own
  // thickness of 0.1 adds 0.05 at either end.
  const Pair pair = draw_pair(from_above({make_box({-2, 0, 3}, {2, 2, 0.1f}, {0.8f, 0.8f, 0.8f})}));
  const double full = pair.darkness({1, 0, 0});
  EXPECT_GT(full, 0.2);
  // Two pixels (0.12 m) to either side of each edge: one for the edge's width, one for sampling.
  EXPECT_NEAR(pair.darkness({0.07f, 0, 0}), full, 0.1 * full);
  EXPECT_NEAR(pair.darkness({1.93f, 0, 0}), full, 0.1 * full);
  EXPECT_NEAR(pair.darkness({1, 0.88f, 0}), full, 0.1 * full);
  EXPECT_NEAR(pair.darkness({1, -0.88f, 0}), full, 0.1 * full);
  EXPECT_LT(pair.darkness({-0.17f, 0, 0}), 0.1 * full);
  EXPECT_LT(pair.darkness({2.17f, 0, 0}), 0.1 * full);
  EXPECT_LT(pair.darkness({1, 1.12f, 0}), 0.1 * full);
  EXPECT_LT(pair.darkness({1, -1.12f, 0}), 0.1 * full);
}

TEST(Shadow, DarkensAsMuchAsTheLightItTakes) {
  // The green channel of light/environment.h; a sky L(z) = h + (t - h) (2 z - z^2) sends a level
  // surface 2 times the integral of L z, h + (t - h) 5 / 6, here 0.45.
  Frame frame = from_above({make_box({-2, 0, 3}, {2, 2, 0.1f}, {0.8f, 0.8f, 0.8f})});
  const Pair pair = draw_pair(frame);
  const double cosine = std::sqrt(0.5);
  const double left = 0.45 / (0.45 + 0.90 * cosine);
  // The ground fades with distance from the picture's middle, and the shadow with it, by less than
  // a hundredth here; sRGB against a plain power of 2.2 is another hundredth.
  EXPECT_NEAR(1.0 - pair.darkness({1, 0, 0}), std::pow(left, 1.0 / 2.2), 0.02);
}

TEST(Shadow, BeginsAtTheFootOfWhatStandsOnTheGround) {
  const Pair pair = draw_pair(from_above({make_box({0, 0, 1}, {2, 2, 2}, {0.8f, 0.8f, 0.8f})}));
  const double full = pair.darkness({2, 0, 0});
  EXPECT_GT(full, 0.2);
  // The box's top hides the ground up to x = 1.11; a gap of light would be seen right beside.
  EXPECT_NEAR(pair.darkness({1.25f, 0, 0}), full, 0.1 * full);
  EXPECT_LT(pair.darkness({-1.25f, 0, 0}), 0.02);
}

TEST(Shadow, LeavesLitSidesAsTheyAre) {
  // A body alone shades nothing of itself that faces the light: any speckle would be acne.
  Frame frame = from_above({make_ball({0, 0, 3}, 2.5f, {0.8f, 0.5f, 0.3f}, 32)});
  for (const float softness : {0.0f, 0.03f, 0.2f}) {
    frame.light.softness = softness;
    const Pair pair = draw_pair(frame);
    int checked = 0;
    for (int i = 0; i < 2000; ++i) {
      // Evenly over the upper half of the ball.
      const float z = (static_cast<float>(i) + 0.5f) / 2000.0f;
      const float around = 2.399963f * static_cast<float>(i);
      const float across = std::sqrt(1.0f - z * z);
      const Vec3f normal = {across * std::cos(around), across * std::sin(around), z};
      const Vec3f point = Vec3f(0, 0, 3) + 2.5f * normal;
      if (normal.dot(-diagonal.normalized()) < 0.25f || normal.z() < 0.4f) continue;
      ++checked;
      EXPECT_EQ(pixel_of(pair.with, pair.camera, point), pixel_of(pair.without, pair.camera, point))
          << "softness " << softness << " normal " << normal.transpose();
    }
    EXPECT_GT(checked, 500);
  }
}

TEST(Shadow, OfAPlateThatLiesOnACoarseBodyIsThatOfAPlateHighAbove) {
  // Where facets lean away from the sun before the surface's normals do, light must not get in
  // between the two: nothing that the sun would light is seen of either.
  const Colour grey = {0.8f, 0.8f, 0.8f};
  const auto under_plate = [&](float height, float width) {
    Frame frame = from_above({make_ring({0, 0, 0.4f}, 2.0f, 0.4f, grey, grey, 24, 12),
                              make_box({0, 0, height + 0.15f}, {width, width, 0.3f}, grey)});
    frame.camera = {{0, -12, 0.6f}, {0, 0, 0.4f}, 30.0f};
    frame.light.softness = 0.03f;
    frame.light.between_bodies = false;
    return draw_once(frame, small_picture());
  };
  const Image low = under_plate(0.8f, 7.0f), high = under_plate(6.0f, 30.0f);
  for (int y = 108; y < 125; ++y) {
    for (int x = 120; x < 200; ++x) {  // within the ring
      EXPECT_LE(greatest_difference(pixel_at(low, x, y), pixel_at(high, x, y)), 1) << x << ' ' << y;
    }
  }
}

TEST(Shadow, LeavesFlatTopsAsTheyAre) {
  Frame frame = from_above({make_box({0, 0, 1}, {4, 4, 2}, {0.8f, 0.8f, 0.8f})});
  const Pair pair = draw_pair(frame);
  for (float x = -1.8f; x <= 1.8f; x += 0.1f) {
    for (float y = -1.8f; y <= 1.8f; y += 0.1f) {
      EXPECT_EQ(pair.darkness({x, y, 2}), 0.0) << x << ' ' << y;
    }
  }
}

/// By the samples a pixel: with one, creases and outlines are drawn once more.
class ShadowAt : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Samples, ShadowAt, testing::Values(1, 4));

TEST_P(ShadowAt, LeavesABoxAloneAsItIsUpToItsEdges) {
  Renderer renderer(small_picture(GetParam()));
  std::mt19937 random(5);
  const auto in = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  Frame frame = empty_frame();
  frame.light.between_bodies = false;
  Image with, without;
  for (int i = 0; i < 200; ++i) {
    frame.meshes = {make_box({0, 0, 0}, {in(1, 4), in(1, 4), in(0.3f, 4)}, {0.8f, 0.8f, 0.8f})};
    frame.camera.eye = {in(-9, 9), in(-9, -3), in(-9, 9)};
    frame.light.direction = {in(-1, 1), in(-1, 1), in(-1, 1)};
    frame.light.shadows = true;
    renderer.draw(frame, with);
    frame.light.shadows = false;
    renderer.draw(frame, without);
    for_each_difference(with, without, [&](int x, int y) {
      // Of the least light, which runs nearly along a face, a step of a byte may be lost.
      EXPECT_LE(greatest_difference(pixel_at(with, x, y), pixel_at(without, x, y)), 1)
          << i << ": light along " << frame.light.direction.transpose();
    });
  }
}

/// Of a body without gas that lies on the ground: its upper and its lower side, each within a
/// millimetre of the same height, and its vertices' normals, which turn with what folds.
Mesh collapsed_body(std::mt19937& random) {
  constexpr std::uint32_t side = 9;
  const auto in = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  auto shape = std::make_shared<MeshShape>();
  Mesh mesh;
  for (const float up : {1.0f, -1.0f}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i < side * side; ++i) {
      mesh.positions.emplace_back(0.75f * static_cast<float>(i % side) - 3.0f,
                                  0.75f * static_cast<float>(i / side) - 3.0f,
                                  0.003f + in(-0.001f, 0.001f));
      mesh.normals.push_back(Vec3f(in(-0.4f, 0.4f), in(-0.4f, 0.4f), up).normalized());
      if (i % side == side - 1 || i / side == side - 1) continue;
      const std::uint32_t a = first + i, b = a + 1, c = a + side, d = c + 1;
      if (up > 0.0f) shape->triangles.insert(shape->triangles.end(), {{a, b, d}, {a, d, c}});
      if (up < 0.0f) shape->triangles.insert(shape->triangles.end(), {{a, d, b}, {a, c, d}});
    }
  }
  shape->colours.assign(mesh.positions.size(), {0.8f, 0.8f, 0.8f});
  mesh.shape = shape;
  return mesh;
}

TEST(Shadow, LeavesTwoLayersThatLieInEachOtherAsTheyAre) {
  std::mt19937 random(3);
  Frame frame = from_above({collapsed_body(random)});
  for (const Vec3f& direction : {diagonal, Light().direction}) {
    frame.light.direction = direction;
    const Pair pair = draw_pair(frame);
    for (float x = -2.8f; x <= 2.8f; x += 0.05f) {
      for (float y = -2.8f; y <= 2.8f; y += 0.05f) {
        EXPECT_EQ(pair.darkness({x, y, 0}), 0.0) << x << ' ' << y;
      }
    }
  }
}

TEST(Shadow, FallsFromOneBodyOnAnother) {
  // A small ball at a height of 5 above a table whose top is at 2: shifted by 3.
  const Pair pair = draw_pair(from_above({make_box({0, 0, 1}, {8, 4, 2}, {0.8f, 0.8f, 0.8f}),
                                          make_ball({-2, 0, 5}, 0.5f, {1, 0, 0})}));
  EXPECT_GT(pair.darkness({1, 0, 2}), 0.2);
  EXPECT_GT(pair.darkness({1.3f, 0, 2}), 0.2);
  EXPECT_LT(pair.darkness({1, 0.7f, 2}), 0.01);
  EXPECT_LT(pair.darkness({1, -0.7f, 2}), 0.01);
  EXPECT_LT(pair.darkness({2, 0, 2}), 0.01);
  EXPECT_LT(pair.darkness({0, 0, 2}), 0.01);
}

TEST(Shadow, HasAWiderEdgeTheSofterTheLight) {
  const auto edge_width = [](float softness) {
    Frame frame = from_above({make_box({-4, 0, 4}, {4, 4, 0.1f}, {0.8f, 0.8f, 0.8f})});
    frame.light.softness = softness;
    const Pair pair = draw_pair(frame);
    const double full = pair.darkness({0, 0, 0});
    int between = 0;
    for (float y = 1.0f; y < 3.0f; y += 0.06f) {  // about a pixel
      const double darkness = pair.darkness({0, y, 0});
      if (darkness > 0.1 * full && darkness < 0.9 * full) ++between;
    }
    return between;
  };
  const int hard = edge_width(0.0f);
  const int soft = edge_width(0.05f);
  const int softest = edge_width(0.2f);
  EXPECT_LE(hard, 2);
  EXPECT_GT(soft, hard);
  EXPECT_GT(softest, 2 * soft);
}

TEST(Shadow, IsSofterTheHigherTheCaster) {
  const auto edge_width = [](float height) {
    // The tall post makes the scene, and with it the edges' scale, the same for both.
    Frame frame = from_above({make_box({-height, 0, height}, {2, 2, 0.1f}, {0.8f, 0.8f, 0.8f}),
                              make_box({-6, -5, 2.5f}, {0.2f, 0.2f, 5}, {0.8f, 0.8f, 0.8f})});
    frame.light.softness = 0.08f;
    const Pair pair = draw_pair(frame);
    const double full = pair.darkness({0.3f, 0, 0});
    int between = 0;
    for (float y = 0.3f; y < 2.0f; y += 0.06f) {
      const double darkness = pair.darkness({0.3f, y, 0});
      if (darkness > 0.1 * full && darkness < 0.9 * full) ++between;
    }
    return between;
  };
  EXPECT_GT(edge_width(4.0f), edge_width(0.06f));
}

TEST(Shadow, IsNotCastByLightFromBelowOrAlongTheGround) {
  for (const Vec3f& direction : {Vec3f(0, 0, 1), Vec3f(1, 0, 0), Vec3f(1, 0, 0.3f)}) {
    Frame frame = from_above({make_ball({0, 0, 2}, 1.0f, {1, 0, 0})});
    frame.light.direction = direction;
    const Pair pair = draw_pair(frame);
    EXPECT_EQ(pair.darkness({3, 0, 0}), 0.0);
    EXPECT_EQ(pair.darkness({-3, 0, 0}), 0.0);
    EXPECT_EQ(pair.darkness({0, 2.5f, 0}), 0.0);
  }
}

}  // namespace
}  // namespace pneuma::render
