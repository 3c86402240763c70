// Light from sky, ground and bodies against closed forms and quadrature.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "render/context/context.h"
#include "render/light/box_contacts.h"
#include "render/light/contact_shade.h"
#include "render/light/environment.h"
#include "render/light/gather.h"
#include "render/light/ground_light.h"
#include "render/light/indirect.h"
#include "render/passes/full_screen.h"
#include "render/passes/look.h"
#include "render/passes/target.h"
#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Of the sky over pi, by quadrature over directions.
Light3 irradiance_by_quadrature(const Environment& environment, const Vec3f& normal) {
  constexpr int rings = 200;
  constexpr int around = 400;
  Light3 sum = Light3::Zero();
  for (int i = 0; i < rings; ++i) {
    const float z = (static_cast<float>(i) + 0.5f) / rings;
    const float across = std::sqrt(1.0f - z * z);
    for (int j = 0; j < around; ++j) {
      const float angle = 2.0f * pi * (static_cast<float>(j) + 0.5f) / around;
      const Vec3f direction(across * std::cos(angle), across * std::sin(angle), z);
      sum += std::max(0.0f, direction.dot(normal)) * sky_radiance(environment, z);
    }
  }
  return sum * (2.0f / (rings * around));
}

TEST(SkyIrradiance, IsThatOfQuadratureWithinAHundredth) {
  const Environment environment;
  const auto c = sky_irradiance(environment);
  for (int degrees = 0; degrees <= 180; degrees += 10) {
    const float tilt = static_cast<float>(degrees) * pi / 180.0f;
    const Vec3f normal(std::sin(tilt), 0, std::cos(tilt));
    const float z = normal.z();
    const Light3 harmonics = c[0] + z * (c[1] + z * c[2]);
    const Light3 expected = irradiance_by_quadrature(environment, normal);
    // What the second order leaves out of a hemisphere's light is mostly its fourth, up to 2 %.
    EXPECT_LT((harmonics - expected).abs().maxCoeff(), 0.02f) << degrees << " degrees";
  }
}

Mesh fine_ball(const Vec3f& centre) { return make_ball(centre, 1.0f, {0.5f, 0.5f, 0.5f}, 16); }

BodyElements ball_elements(const Vec3f& centre) {
  const Mesh mesh = fine_ball(centre);
  const std::vector<Vec3f> albedo(mesh.positions.size(), Vec3f::Constant(0.2f));
  return elements_of(
      mesh, albedo, patches(mesh.shape->triangles, most_elements), Vec3f::UnitZ(),
      [](const Vec3f&) { return true; }, false);
}

TEST(Gather, TakesOfTheSkyWhatABallCovers) {
  // Of a level surface below its middle, a ball of radius r at a distance d takes (r / d)^2, also
  // nearer than its patches are wide.
  for (const float distance : {1.5f, 2.0f, 4.0f, 10.0f}) {
    const std::vector<BodyElements> bodies = {ball_elements({0, 0, distance})};
    Receivers receivers;
    receivers.begin(1);
    receivers.add(Vec3f::Zero(), Vec3f::UnitZ());
    gather(bodies, receivers);
    const float expected = 1.0f / (distance * distance);
    EXPECT_NEAR(receivers.above[0], expected, 0.1f * expected) << distance;
    EXPECT_EQ(receivers.below[0], 0.0f);
  }
}

TEST(Gather, TakesNothingOfAConvexBodyFromItself) {
  const Mesh ball = fine_ball(Vec3f::Zero());
  const std::vector<BodyElements> bodies = {ball_elements(Vec3f::Zero())};
  for (std::size_t v = 0; v < ball.positions.size(); v += 7) {
    Receivers receivers;
    receivers.begin(1);
    receivers.add(ball.positions[v], ball.normals[v]);
    gather(bodies, receivers);
    EXPECT_LT(receivers.above[0] + receivers.below[0], 0.02f);
  }
}

TEST(Gather, OfPointsTogetherIsThatOfEach) {
  // Below a coarse ball, also behind the middles of its patches, which are flat.
  const Mesh ball = make_ball({0, 0, 1.002f}, 1.0f, {0.5f, 0.5f, 0.5f}, 6);
  const std::vector<Vec3f> albedo(ball.positions.size(), Vec3f::Constant(0.2f));
  const std::vector<BodyElements> bodies = {elements_of(
      ball, albedo, patches(ball.shape->triangles, 16), Vec3f::UnitZ(),
      [](const Vec3f&) { return true; }, false)};
  const auto taken = [&](float x, std::size_t count) {
    Receivers receivers;
    receivers.begin(count);
    for (std::size_t i = 0; i < count; ++i) {
      receivers.add({x + 0.01f * static_cast<float>(i), 0.0f, 0.0f}, Vec3f::UnitZ());
    }
    gather(bodies, receivers);
    return receivers.above[0];
  };
  for (const float x : {0.0f, 0.1f, 0.2f, 0.3f, 0.5f, 0.8f}) {
    EXPECT_GT(taken(x, 1), 0.1f);
    EXPECT_NEAR(taken(x, 8), taken(x, 1), 0.01f) << x;
  }
}

TEST(IndirectLighting, TakesNoLightByWhatIsThin) {
  std::vector<Mesh> meshes = {fine_ball(Vec3f::Zero()), fine_ball({3, 0, 0})};
  meshes[1].takes_light = false;
  IndirectLighting lighting;
  lighting.take_bodies(
      meshes, Vec3f::UnitZ(), [](const Vec3f&) { return true; }, false);
  ASSERT_EQ(lighting.bodies().bodies().size(), 1U);
  EXPECT_LT(lighting.bodies().bodies()[0].whole.centre.x(), 1.0f);
}

/// A crowd of balls around an empty middle.
BodyTree crowd(int balls) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-60.0f, 60.0f);
  BodyTree tree;
  while (tree.bodies().size() < static_cast<std::size_t>(balls)) {
    const Vec3f centre(place(random), place(random), place(random));
    if (centre.norm() > 3.0f) tree.add(ball_elements(centre));
  }
  tree.build();
  return tree;
}

TEST(Gather, OfACrowdInGroupsIsThatOfAllItsBodies) {
  const BodyTree tree = crowd(400);
  ASSERT_FALSE(tree.groups().empty());
  const auto taken = [&](const auto& bodies) {
    Receivers receivers;
    receivers.begin(3);
    for (int axis = 0; axis < 3; ++axis) receivers.add(Vec3f::Unit(axis), Vec3f::Unit(axis));
    gather(bodies, receivers);
    return receivers;
  };
  const Receivers grouped = taken(tree), one_by_one = taken(tree.bodies());
  // Groups are off by the square of a quarter of their part of the light, at most, and on average
  // by far less.
  for (int i = 0; i < 3; ++i) {
    const float all = one_by_one.above[i] + one_by_one.below[i];
    EXPECT_GT(all, 0.03f);
    EXPECT_NEAR(grouped.above[i] + grouped.below[i], all, 0.02f * all);
    EXPECT_NEAR(grouped.green[i], one_by_one.green[i], 0.02f * one_by_one.green[i]);
  }
}

TEST(Gather, OfFewBodiesHasNoGroups) { EXPECT_TRUE(crowd(20).groups().empty()); }

TEST(LeftAt, IsAFractionHoweverManyBodiesAreNear) {
  std::vector<BodyElements> bodies;
  for (int count = 0; count < 30; ++count) {
    Receivers receivers;
    receivers.begin(1);
    receivers.add(Vec3f::Zero(), Vec3f::UnitX());
    gather(bodies, receivers);
    const IndirectLight left = left_at(receivers, 0);
    EXPECT_GE(left.open_to.minCoeff(), 0.0f);
    EXPECT_LE(left.open_to.maxCoeff(), 1.0f);
    float brightest = 0.0f;
    for (const BodyElements& body : bodies) {
      for (const Element& element : body.elements) {
        brightest = std::max(brightest, element.radiosity.maxCoeff());
      }
    }
    // No more than if all that is seen sent what the brightest element sends.
    EXPECT_LE(left.bounced.maxCoeff(), brightest);
    const float height = 0.3f * static_cast<float>(count % 7) - 0.9f;
    bodies.push_back(ball_elements({1.3f + 0.2f * static_cast<float>(count), 0, height}));
  }
}

TEST(LeftAt, OfTwoBodiesIsWhatOneLeavesOfWhatTheOtherLeaves) {
  const BodyElements one = ball_elements({0, 0, 3}), other = ball_elements({1, 2, 4});
  const auto left_by = [](const std::vector<BodyElements>& bodies) {
    Receivers receivers;
    receivers.begin(1);
    receivers.add(Vec3f::Zero(), Vec3f(1, 1, 1).normalized());
    gather(bodies, receivers);
    return left_at(receivers, 0).open_to.x();
  };
  EXPECT_LT(left_by({one}), 0.97f);
  EXPECT_NEAR(left_by({one, other}), left_by({one}) * left_by({other}), 1e-5f);
}

TEST(GroundLight, OfSkyAndSunIsAllThereIs) {
  const GroundLight light(Vec3f(0, 0.6f, 0.8f));
  const Light3 sun = 0.8f * Environment().sun;
  const Light3 sky = irradiance_by_quadrature(Environment(), Vec3f::UnitZ());
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(light.sun[c], sun[c] / (sun[c] + sky[c]), 0.01f);
    EXPECT_FLOAT_EQ(light.sun[c] + light.sky[c], 1.0f);
  }
}

TEST(GroundLight, TakesColourFromABodyThatTakesSkyFromIt) {
  const GroundLight light(Vec3f::UnitZ());
  const Eigen::Array4f dark = light.ambient({Vec3f::Zero(), {0.5f, 1.0f}});
  const Eigen::Array4f red = light.ambient({Vec3f(0.1f, 0, 0), {0.5f, 1.0f}});
  EXPECT_FLOAT_EQ(dark[1], 0.515f * light.sky[1]);
  EXPECT_FLOAT_EQ(red[0], dark[0] + 0.1f / light.of_sky[0] * light.sky[0]);
  EXPECT_FLOAT_EQ(red[1], dark[1]);
  const Eigen::Array4f bright = light.ambient({Vec3f::Constant(9.0f), {1.0f, 1.0f}});
  EXPECT_FLOAT_EQ(bright[2], light.sky[2]);
}

TEST(SeenGround, SendsHalfFromEitherSideOfItsMiddle) {
  for (int tilt = 0; tilt <= 100; tilt += 10) {  // degrees from straight down
    const float a = static_cast<float>(tilt) * pi / 180.0f;
    const SeenGround seen = seen_ground(-std::cos(a));
    const float middle = std::atan(seen.ahead);
    EXPECT_NEAR(seen.distance, 1.0f / std::cos(middle), 1e-3f * seen.distance) << tilt;
    constexpr int steps = 10000;
    float before = 0.0f, all = 0.0f;
    for (int i = 0; i < steps; ++i) {
      const float begin = a - pi / 2.0f;
      const float angle =
          begin + (pi / 2.0f - begin) * (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
      const float part = std::cos(angle - a);
      all += part;
      if (angle < middle) before += part;
    }
    EXPECT_NEAR(before / all, 0.5f, 0.002f) << tilt;
  }
}

TEST(Reflection, SendsNoMoreThanArrives) {
  // A white surface under light from everywhere: for each cosine of the eye (a column) and each
  // roughness (a row), the shader itself sums what it mirrors of a lamp in each direction, and what
  // is left for the colour.
  constexpr const char* sum_source = R"(
out vec4 colour;
void main() {
  float nv = gl_FragCoord.x / 32.0;
  float roughness = 0.1 + 0.9 * gl_FragCoord.y / 32.0;
  vec3 v = vec3(sqrt(1.0 - nv * nv), 0.0, nv);
  float sum = 0.0;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 128; ++j) {
      float nl = (float(i) + 0.5) / 64.0;
      float angle = 6.2831853 * (float(j) + 0.5) / 128.0;
      vec3 l = vec3(sqrt(1.0 - nl * nl) * vec2(cos(angle), sin(angle)), nl);
      vec3 h = normalize(l + v);
      sum += nl * (highlight(nl, nv, h.z, dot(v, h), roughness) +
                   entering * (1.0 - fresnel(nv, roughness)));
    }
  }
  colour = vec4(0.5 * sum * 2.0 / (64.0 * 128.0));  // half of it, so that more than 1 is seen
}
)";
  Context context;
  Target target(32, 32);
  const FullScreen sum("reflection", "", look_source() + sum_source);
  target.begin();
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  sum.program().use();
  sum.draw();
  Image image;
  target.read(image);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      // A hundredth for the quadrature, a byte for rounding.
      EXPECT_LE(pixel_at(image, x, y)[0], 128 + 2) << x << ' ' << y;
    }
  }
}

TEST(BetweenBodies, AWhiteBallTakesTheColourOfARedWall) {
  Frame frame = empty_frame();
  frame.light = {.direction = {-1, 0.3f, -1}};
  frame.meshes = {make_ball({0, 0, 0}, 1.0f, {0.9f, 0.9f, 0.9f}, 24),
                  make_box({-1.6f, 0, 0}, {0.2f, 4, 4}, {0.9f, 0.05f, 0.05f})};
  const Image image = draw_once(frame, small_picture());
  frame.light.between_bodies = false;
  const Image alone = draw_once(frame, small_picture());
  const Vec3f beside = Vec3f(-0.8f, -0.6f, 0);
  const Pixel near_wall = pixel_of(image, frame.camera, beside);
  const Pixel without = pixel_of(alone, frame.camera, beside);
  EXPECT_GT(near_wall[0] - near_wall[1], without[0] - without[1] + 8);
}

TEST(BetweenBodies, TheGroundDarkensAroundABallThatStandsOnIt) {
  Frame frame;
  frame.camera = {{0, -12, 8}, Vec3f::Zero(), 40.0f};
  frame.light.direction = {0, 0, -1};
  const auto darkness = [&](float brightness, const Vec3f& point) {
    frame.meshes = {make_ball({0, 0, 1}, 1.0f, Vec3f::Constant(brightness), 16)};
    frame.light.between_bodies = true;
    const Image image = draw_once(frame, small_picture());
    frame.light.between_bodies = false;
    const Image alone = draw_once(frame, small_picture());
    return pixel_of(alone, frame.camera, point)[1] - pixel_of(image, frame.camera, point)[1];
  };
  EXPECT_GT(darkness(0.2f, {1.25f, 0, 0}), darkness(0.2f, {1.7f, 0, 0}));
  EXPECT_GT(darkness(0.2f, {1.25f, 0, 0}), 3);
  EXPECT_EQ(darkness(0.2f, {6, 0, 0}), 0);
  // A bright ball sends to the ground much of what it takes.
  EXPECT_LT(darkness(0.9f, {1.25f, 0, 0}), darkness(0.2f, {1.25f, 0, 0}) - 1);
}

/// Seen from above: what a pixel of the ground has lost must be close to what its neighbours have.
TEST(BetweenBodies, TheGroundsDarknessAroundACrowdHasNoEdge) {
  for (const int rows : {4, 12, 24}) {
    const float half = 1.5f * static_cast<float>(rows);
    Frame frame;
    frame.camera = {{0, 0, 12.0f * half}, Vec3f::Zero(), 40.0f};
    frame.ground->grid_spacing = 1e4f;
    frame.light.direction = {0, 0, -1};
    for (int i = 0; i < rows * rows; ++i) {
      const Vec3f corner(3.0f * static_cast<float>(i % rows), 3.0f * static_cast<float>(i / rows),
                         0.0f);
      frame.meshes.push_back(make_box(corner + Vec3f(1.5f - half, 1.5f - half, 0.5f * half),
                                      {2.0f, 2.0f, half}, {0.8f, 0.5f, 0.3f}));
    }
    const Image image = draw_once(frame, small_picture());
    frame.light.between_bodies = false;
    const Image alone = draw_once(frame, small_picture());
    const auto lost = [&](int x, int y) {
      return pixel_at(alone, x, y)[1] - pixel_at(image, x, y)[1];
    };
    int most_lost = 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 1; x < image.width; ++x) {
        const double scale = 12.0 * half * std::tan(pi / 9.0) / (0.5 * image.height);
        const double right = scale * (x - 0.5 * image.width);
        const double up = scale * (y - 0.5 * image.height);
        if (std::max(std::abs(right), std::abs(up)) < 1.3 * half) continue;  // beside the boxes
        most_lost = std::max(most_lost, lost(x, y));
        EXPECT_NEAR(lost(x, y), lost(x - 1, y), 2) << rows << " rows, at " << x << ' ' << y;
      }
    }
    EXPECT_GT(most_lost, 4) << rows;
  }
}

/// A viewer believes that a box stands where its sides meet a dark line, which is gone when it
/// floats.
TEST(BetweenBodies, TheGroundIsDarkestWhereABoxStands) {
  const auto darkness = [](float height, float away) {
    Frame frame;
    frame.camera = {{0, -0.1f, 12}, Vec3f::Zero(), 40.0f};
    frame.light.direction = {0.3f, 0, -1};  // the nearest 0.12 m are in the shade
    frame.meshes = {make_box({0, 0, 0.2f + height}, {2, 2, 0.4f}, {0.8f, 0.8f, 0.8f})};
    const Vec3f point = {1 + away, 0, 0};
    const int lit = pixel_of(draw_once(frame, small_picture()), frame.camera, point)[1];
    frame.light.between_bodies = false;
    return pixel_of(draw_once(frame, small_picture()), frame.camera, point)[1] - lit;
  };
  const int at_side = darkness(0.0f, 0.07f);
  EXPECT_GT(at_side, 6);
  EXPECT_GT(at_side, darkness(0.0f, 0.5f) + 4);
  EXPECT_GT(at_side, darkness(0.6f, 0.07f) + 4);
}

TEST(GroundShadow, IsNotOfWhatIsBelowTheGround) {
  const auto pixel = [](float x, bool has_box) {
    Frame frame;
    frame.camera = {{0, -0.1f, 12}, Vec3f::Zero(), 40.0f};
    frame.light.direction = {-0.5f, 0, -1};
    frame.light.between_bodies = false;
    if (has_box) frame.meshes = {make_box({0, 0, -0.5f}, {2, 2, 2}, {0.8f, 0.8f, 0.8f})};
    return pixel_of(draw_once(frame, small_picture()), frame.camera, {x, 0, 0})[1];
  };
  EXPECT_NEAR(pixel(1.4f, true), pixel(1.4f, false), 1);      // towards the light
  EXPECT_LT(pixel(-1.12f, true), pixel(-1.12f, false) - 20);  // half a metre casts a shadow
}

TEST(Elements, SendLessOverGroundInShadow) {
  const Mesh box = make_box({0, 0, 2}, {1, 1, 1}, {0.5f, 0.5f, 0.5f});
  const std::vector<Vec3f> albedo(box.positions.size(), Vec3f::Constant(0.2f));
  // The sun shines on the box and nowhere on the ground.
  const auto sent = [&](bool on_ground) {
    return elements_of(
               box, albedo, patches(box.shape->triangles, most_elements), Vec3f::UnitZ(),
               [](const Vec3f& point) { return point.z() > 0.5f; }, on_ground)
        .elements;
  };
  const std::vector<Element> open = sent(false), dark = sent(true);
  for (std::size_t i = 0; i < open.size(); ++i) {
    const float left = (dark[i].radiosity / open[i].radiosity).maxCoeff();
    const float z = open[i].normal.z();
    if (z > 0.5f) {
      EXPECT_FLOAT_EQ(left, 1.0f);
    } else if (z > -0.5f) {
      EXPECT_LT(left, 0.8f);
    } else {
      EXPECT_NEAR(left, 0.3f, 0.01f);
    }
  }
}

TEST(GroundLight, OfClosedGroundIsNone) {
  const GroundLight light(Vec3f(0.0f, 0.6f, 0.8f));
  EXPECT_EQ(light.ambient({Vec3f::Zero(), {0.0f, 1.0f}})[0], 0.0f);
  EXPECT_EQ(light.ambient({Vec3f::Zero(), {0.98f, 1.0f}})[0], light.sky[0]);
}

Mesh tumbled(Mesh mesh, const Vec3f& to) {
  const Eigen::AngleAxisf turn(0.7f, Vec3f(1, 2, 3).normalized());
  for (Vec3f& position : mesh.positions) position = turn * position + to;
  return mesh;
}

TEST(OrientedBox, IsFoundInItsMeshAlone) {
  const Vec3f size(1.0f, 2.0f, 3.5f);
  const Mesh upright = make_box(Vec3f::Zero(), size, {0.5f, 0.5f, 0.5f});
  const Mesh mesh = tumbled(upright, {4, 5, 6});
  const std::optional<OrientedBox> box = box_of(mesh);
  ASSERT_TRUE(box);
  EXPECT_LT((box->centre - Vec3f(4, 5, 6)).norm(), 1e-5f);
  EXPECT_NEAR(box->half.prod(), size.prod() / 8.0f, 1e-4f);
  Mesh sheared = mesh;
  for (Vec3f& position : sheared.positions) position.x() += 0.01f * position.z();
  EXPECT_FALSE(box_of(sheared));
  EXPECT_FALSE(box_of(make_ball(Vec3f::Zero(), 1.0f, {0.5f, 0.5f, 0.5f}, 4)));
}

TEST(OrientedBox, HasTheDistanceOfItsNearestPoint) {
  const Vec3f half(0.5f, 1.0f, 1.75f);
  const OrientedBox box = {Vec3f(1, 0, 0), Eigen::Matrix3f::Identity(), half};
  EXPECT_FLOAT_EQ(box.distance_to({1, 0, 0}), -0.5f);
  EXPECT_FLOAT_EQ(box.distance_to({1.7f, 0.4f, -1.0f}), 0.2f);
  EXPECT_FLOAT_EQ(box.distance_to({1.8f, 1.4f, 0}), 0.5f);
}

/// A slab lit by the sky alone, with a cube on it; and how bright its top is so far from the cube.
int brightness_beside_cube(float away) {
  Frame frame;
  frame.ground.reset();
  frame.light.direction = {0.0f, 0.0f, 1.0f};
  frame.camera = {{0.0f, -16.0f, 8.0f}, Vec3f::Zero(), 40.0f};
  frame.meshes = {make_box({0, 0, -1}, {12, 12, 2}, {0.6f, 0.6f, 0.6f}),
                  make_box({0, 0, 1.01f}, {2, 2, 2}, {0.6f, 0.6f, 0.6f})};
  const Image image = draw_once(frame, {.width = 640, .height = 480});
  return pixel_of(image, frame.camera, {0.0f, -1.0f - away, 0.0f})[1];
}

TEST(BoxContacts, CreasesAreDarkAndTheRestIsAsItWas) {
  const int far = brightness_beside_cube(2.5f);
  EXPECT_LT(brightness_beside_cube(0.05f), 0.8f * static_cast<float>(far));
  EXPECT_NEAR(brightness_beside_cube(0.5f), far, 4);
}

}  // namespace
}  // namespace pneuma::render
