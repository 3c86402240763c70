// Points, lines, wireframe and caption.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

const Colour magenta = {1, 0, 1};

TEST(Points, AreDiscsAtTheirProjectionWithADarkRim) {
  Frame frame = empty_frame();
  frame.camera = {{2, -9, 4}, {0.3f, 0, 0.5f}, 40.0f};
  const Image empty = draw_once(frame, small_picture());
  const Vec3f position = {-0.7f, 0.4f, 1.1f};
  frame.points = {{position, magenta, 40.0f, false}};  // 20 pixels at 240 lines
  const Image image = draw_once(frame, small_picture());

  const Eigen::Vector2d expected = seen_at(frame.camera, position, 320, 240);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0;
  for_each_difference(image, empty, [&](int x, int y) {
    sum += Eigen::Vector2d(x + 0.5, y + 0.5);
    ++count;
    // The disc's radius, half a pixel of soft edge, and half a pixel's diagonal.
    EXPECT_LT((Eigen::Vector2d(x + 0.5, y + 0.5) - expected).norm(), 10.0 + 0.5 + 0.75);
  });
  EXPECT_LT((sum / count - expected).norm(), 0.2) << "pixels";
  // The soft edge touches pixels up to half a pixel further out.
  EXPECT_GT(count, std::numbers::pi * 10.0 * 10.0);
  EXPECT_LT(count, std::numbers::pi * 10.8 * 10.8);
  EXPECT_EQ(pixel_of(image, frame.camera, position), (Pixel{255, 0, 255}));
  const Pixel rim =
      pixel_at(image, static_cast<int>(expected.x() + 8.5), static_cast<int>(expected.y()));
  EXPECT_LT(*std::max_element(rim.begin(), rim.end()), 60);
}

TEST(Points, BehindABodyShineThroughFaintlyOrNotAtAll) {
  Frame frame = empty_frame();
  frame.meshes = {make_ball({0, 0, 0}, 1.0f, {0.2f, 0.6f, 0.2f})};
  const Image ball = draw_once(frame, small_picture());
  const Vec3f behind = {0, 3, 0};
  frame.points = {{behind, magenta, 12.0f, false}};
  EXPECT_EQ(draw_once(frame, small_picture()).pixels, ball.pixels) << "hidden";
  frame.points[0].always_visible = true;
  const Image faint = draw_once(frame, small_picture());
  const Pixel bare = pixel_of(ball, frame.camera, behind);
  const Pixel seen = pixel_of(faint, frame.camera, behind);
  EXPECT_GT(seen[0], bare[0] + 20) << "shines through";
  EXPECT_LT(seen[0], 200) << "faintly";
  frame.points[0].position = {0, -3, 0};
  EXPECT_EQ(pixel_of(draw_once(frame, small_picture()), frame.camera, {0, -3, 0}),
            (Pixel{255, 0, 255}))
      << "in front";
}

TEST(Points, OnASurfaceAreNotLostInIt) {
  Frame frame = empty_frame();
  frame.meshes = {make_ball({0, 0, 0}, 1.0f, {0.2f, 0.6f, 0.2f}, 48)};
  // Two pixels' radius is a ball of 0.055 m there: it looks out when its centre is 0.02 m below.
  frame.points = {{{0, -0.98f, 0}, magenta, 8.0f, false}};
  EXPECT_EQ(pixel_of(draw_once(frame, small_picture()), frame.camera, {0, -0.98f, 0}),
            (Pixel{255, 0, 255}));
}

/// How many pixels of a column are covered by black, each counted by its share.
double black_in_column(const Image& image, const Image& empty, int x) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    const double ground = pixel_at(empty, x, y)[0];
    sum += (ground - pixel_at(image, x, y)[0]) / ground;
  }
  return sum;
}

TEST(Lines, AreAsWideAsAsked) {
  Frame frame = empty_frame();
  for (const int samples : {1, 4}) {
    frame.lines.clear();
    const Image empty = draw_once(frame, small_picture(samples));
    for (const float width : {1.0f, 3.0f, 9.0f}) {
      frame.lines = {{{-3, 0, 0.31f}, {3, 0, 0.31f}, {0, 0, 0}, width}};
      const Image image = draw_once(frame, small_picture(samples));
      // 240 lines halve the width; bytes round by 0.004 in each of a few pixels.
      for (const int x : {100, 160, 220}) {
        EXPECT_NEAR(black_in_column(image, empty, x), 0.5 * width, 0.05) << width;
      }
    }
  }
}

TEST(Lines, GoFromEndToEnd) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, small_picture());
  frame.lines = {{{-1, 0, -1}, {1.5f, 0, 0.5f}, magenta, 3.0f}};
  const Image image = draw_once(frame, small_picture());
  int left = 320;
  int right = 0;
  for_each_difference(image, empty, [&](int x, int) {
    left = std::min(left, x);
    right = std::max(right, x);
  });
  // Square ends and soft edges reach a pixel or so further.
  EXPECT_NEAR(left, seen_at(frame.camera, {-1, 0, -1}, 320, 240).x(), 2.0);
  EXPECT_NEAR(right, seen_at(frame.camera, {1.5f, 0, 0.5f}, 320, 240).x(), 2.0);
}

TEST(Lines, ThatShineThroughOneMeshAreHiddenByOthers) {
  Frame frame = empty_frame();
  // The box stands before the right half of the ball.
  frame.meshes = {make_ball({0, 0, 0}, 1.0f, {0.2f, 0.6f, 0.2f}),
                  make_box({0.5f, -3, 0}, {1, 1, 1}, {0.2f, 0.2f, 0.6f})};
  const Line line = {{-2, 3, 0}, {0.8f, 3, 0}, magenta, 6.0f, true};
  const Vec3f beside = {-1.8f, 3, 0}, behind_ball = {-0.4f, 3, 0}, behind_both = {0.4f, 3, 0};
  for (const int samples : {1, 4}) {
    frame.lines.clear();
    const Image bare = draw_once(frame, small_picture(samples));
    const auto is_changed = [&](const Vec3f& point) {
      const Image image = draw_once(frame, small_picture(samples));
      return pixel_of(image, frame.camera, point) != pixel_of(bare, frame.camera, point);
    };
    frame.lines = {line};
    for (const Vec3f& point : {beside, behind_ball, behind_both}) EXPECT_TRUE(is_changed(point));
    frame.lines[0].through = 0;
    EXPECT_TRUE(is_changed(beside));
    EXPECT_TRUE(is_changed(behind_ball));
    EXPECT_FALSE(is_changed(behind_both));
    frame.lines[0].through = 1;
    EXPECT_FALSE(is_changed(behind_ball));
    EXPECT_TRUE(is_changed(behind_both));
  }
}

TEST(Lines, ThatShineThroughOneMeshShineThroughTheGround) {
  Frame frame;
  frame.light.shadows = false;
  frame.meshes = {make_ball({0, 0, 5}, 1.0f, {0.2f, 0.6f, 0.2f})};
  const Image bare = draw_once(frame, small_picture());
  frame.lines = {{{-1, 0, -1}, {1, 0, -1}, magenta, 6.0f, true, 0}};
  const Image image = draw_once(frame, small_picture());
  EXPECT_NE(pixel_of(image, frame.camera, {0, 0, -1}), pixel_of(bare, frame.camera, {0, 0, -1}));
}

TEST(Lines, FromBehindTheEyeAreCutOff) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, small_picture());
  const Vec3f ahead = {0.4f, 5, 1};
  const Vec3f behind = {0.4f, -30, 1};
  const Vec3f beside = {0.4f, -10, 1};  // neither before nor behind
  for (const Line& line :
       {Line{ahead, behind, magenta, 8.0f}, Line{behind, ahead, magenta, 8.0f},
        Line{ahead, beside, magenta, 8.0f}, Line{beside, ahead, magenta, 8.0f}}) {
    frame.lines = {line};
    const Image image = draw_once(frame, small_picture());
    EXPECT_EQ(pixel_of(image, frame.camera, {0.4f, 0, 1})[1], 0) << "seen in front of the eye";
    // It is above and to the right of the eye all along.
    for_each_difference(image, empty, [](int x, int y) {
      ASSERT_LT(y, 122);  // but for half its width
      ASSERT_GT(x, 157);
    });
  }
  frame.lines = {{{0, -30, 1}, {0, -20, -1}, magenta, 3.0f}};
  EXPECT_EQ(draw_once(frame, small_picture()).pixels, empty.pixels) << "all of it behind";
}

TEST(Wireframe, ShowsTheEdgesThatFaceTheEye) {
  Frame frame = empty_frame();
  frame.camera.eye = {4, -9, 5};
  frame.meshes = {make_box({0, 0, 0}, {3, 3, 3}, {0.8f, 0.8f, 0.8f})};
  const Image plain = draw_once(frame, small_picture());
  frame.wireframe = true;
  const Image wired = draw_once(frame, small_picture());
  const auto change_at = [&](const Vec3f& point) {
    return pixel_of(plain, frame.camera, point)[1] - pixel_of(wired, frame.camera, point)[1];
  };
  int visible = 0;
  for (const auto& [a, b] : frame.meshes[0].shape->edges) {
    const Vec3f from = frame.meshes[0].positions[a];
    const Vec3f to = frame.meshes[0].positions[b];
    // The hidden edges are those at the corner that is furthest from the eye.
    const Vec3f furthest = {-1.5f, 1.5f, -1.5f};
    const bool hidden = from == furthest || to == furthest;
    if (hidden) {
      EXPECT_EQ(change_at(0.6f * from + 0.4f * to), 0);
    } else {
      ++visible;
      EXPECT_GT(change_at(0.6f * from + 0.4f * to), 12);
    }
  }
  EXPECT_EQ(visible, 9);
  EXPECT_EQ(change_at({0, -1.5f, 0.3f}), 0) << "faces stay as they are";
}

struct Extent {
  int left = 1 << 20;
  int top = 1 << 20;
  int right = 0;
  int bottom = 0;
  int height() const { return bottom - top + 1; }
};

Extent caption_extent(const std::string& text, const RenderOptions& options) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, options);
  frame.caption = Caption{text};
  const Image image = draw_once(frame, options);
  Extent extent;
  for_each_difference(image, empty, [&extent](int x, int y) {
    extent.left = std::min(extent.left, x);
    extent.right = std::max(extent.right, x);
    extent.top = std::min(extent.top, y);
    extent.bottom = std::max(extent.bottom, y);
  });
  return extent;
}

TEST(CaptionText, StandsInTheLowerLeftCorner) {
  const Extent one = caption_extent("t = 1.25 s", small_picture());
  EXPECT_LT(one.left, 10);
  EXPECT_LT(one.right, 160);
  EXPECT_GT(one.top, 200);
  EXPECT_GT(one.bottom, 225);
  EXPECT_LT(one.bottom, 240);
  const Extent two = caption_extent("t = 1.25 s\nstep 75", small_picture());
  EXPECT_EQ(two.bottom, one.bottom);
  EXPECT_GT(two.height(), one.height() + 6);
}

TEST(CaptionText, IsWrappedAndNeverCut) {
  RenderOptions small = small_picture();
  small.width = 160;
  small.height = 120;
  const std::string title = "Soft torus, three soft spheres and four rigid cubes";
  for (const std::string& text : {title, title + "\nt = 3.33 s   step 200", std::string(60, 'W')}) {
    const Extent extent = caption_extent(text, small);
    EXPECT_LT(extent.right, 160 - 4);
    EXPECT_GT(extent.top, 0);
    EXPECT_GT(extent.height(), caption_extent("t", small).height() + 6) << "more lines than one";
  }
  // What fits stays on its line.
  EXPECT_EQ(caption_extent("Soft cat", small).height(), caption_extent("t", small).height());
}

TEST(CaptionText, GrowsWithThePictureAndStaysReadable) {
  const auto height_at = [](int lines) {
    RenderOptions options = small_picture();
    options.width = 4 * lines / 3;
    options.height = lines;
    return caption_extent("t", options).height();
  };
  EXPECT_EQ(height_at(120), height_at(240)) << "below, letters would be lost";
  // An em is a whole number of pixels: of 27 and 14 the half differs by 4 %, and sides are rounded.
  EXPECT_NEAR(height_at(960), 2.0 * height_at(480), 0.08 * height_at(960));
}

TEST(CaptionText, IsLightOnDark) {
  Frame frame = empty_frame();
  frame.caption = Caption{"MMMM"};
  const Image image = draw_once(frame, small_picture());
  int light = 0;
  int dark = 0;
  for (int y = 215; y < 240; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int green = pixel_at(image, x, y)[1];
      if (green > 200) ++light;  // strokes are about a pixel wide
      if (green < 120) ++dark;
    }
  }
  EXPECT_GT(light, 40);
  EXPECT_GT(dark, 40);
}

TEST(CaptionText, WithoutTextIsNothing) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, small_picture());
  const auto with = [&frame](const std::string& text) {
    frame.caption = Caption{text};
    return draw_once(frame, small_picture()).pixels;
  };
  EXPECT_EQ(with(""), empty.pixels);
  EXPECT_NE(with("a"), with("b"));
  EXPECT_NE(with("\xc3\xa9"), with("e")) << "letters beyond ASCII have their own shapes";
  EXPECT_NO_THROW(with(std::string(500, '@')));
}

}  // namespace
}  // namespace pneuma::render
