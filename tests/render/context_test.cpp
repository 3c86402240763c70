#include "render/context/context.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "render/context/shared_library.h"
#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

template <typename Action>
GlFailure failure_of(Action action) {
  try {
    action();
  } catch (const GlError& error) {
    EXPECT_GT(std::string(error.what()).size(), 40u) << "says what to do";
    return error.failure();
  }
  ADD_FAILURE() << "no GlError";
  return GlFailure::shader_refused;
}

ContextReport good_report() { return {"3.3 (Core Profile) Mesa", "llvmpipe", 3, 3, probe_colour}; }

TEST(Context, SaysWhatRuns) {
  const Context context;
  EXPECT_GE(10 * context.report().major + context.report().minor, 33);
  EXPECT_EQ(context.report().pixel, probe_colour);
  Renderer renderer(small_picture());
  EXPECT_NE(renderer.description().find(context.report().version), std::string::npos);
  EXPECT_NE(renderer.description().find(context.report().renderer), std::string::npos);
  EXPECT_EQ(renderer.description().find('\n'), std::string::npos);
}

TEST(Context, AnImpossibleVersionIsRefused) {
  EXPECT_EQ(failure_of([] { Context context({9, 9}); }), GlFailure::context_refused);
}

TEST(Context, CanBeSwitchedOff) {
  setenv("PNEUMA_GL", "none", 1);
  EXPECT_EQ(failure_of([] { Renderer renderer(small_picture()); }), GlFailure::switched_off);
  unsetenv("PNEUMA_GL");
  EXPECT_NO_THROW(draw_once(Frame{}, small_picture()));
}

TEST(Context, OfAnotherBackendThanTheFirstIsRefused) {
  const Context context({.backend = Backend::egl});
  EXPECT_EQ(context.backend(), Backend::egl);
  EXPECT_EQ(context.report().pixel, probe_colour);
  EXPECT_EQ(Context().backend(), Backend::egl) << "whichever, if none is asked for";
  EXPECT_EQ(failure_of([] { Context other({.backend = Backend::osmesa}); }),
            GlFailure::context_refused);
}

TEST(Context, OfEglAndAnImpossibleVersionIsRefused) {
  EXPECT_EQ(failure_of([] { Context context({9, 9, Backend::egl}); }), GlFailure::context_refused);
}

TEST(SharedLibrary, ThatIsMissingIsAnErrorThatNamesThePackage) {
  try {
    const SharedLibrary library("libnowhere.so.1", "libnowhere1");
    ADD_FAILURE() << "found";
  } catch (const GlError& error) {
    EXPECT_EQ(error.failure(), GlFailure::library_missing);
    const std::string message = error.what();
    EXPECT_NE(message.find("libnowhere.so.1: cannot open"), std::string::npos) << message;
    EXPECT_NE(message.find("apt-get install libnowhere1`"), std::string::npos) << message;
  }
}

TEST(Context, AVersionThatIsTooOldIsRefused) {
  ContextReport report = good_report();
  EXPECT_NO_THROW(check_report(report, {3, 3}));
  EXPECT_EQ(failure_of([&] { check_report(report, {3, 4}); }), GlFailure::version_too_old);
  EXPECT_EQ(failure_of([&] { check_report(report, {4, 0}); }), GlFailure::version_too_old);
  report.major = 4;
  report.minor = 0;
  EXPECT_NO_THROW(check_report(report, {3, 3}));
}

TEST(Context, BlackPixelsAreRefused) {
  ContextReport report = good_report();
  report.pixel = {0, 0, 0, 0};
  EXPECT_EQ(failure_of([&] { check_report(report, {}); }), GlFailure::pixels_wrong);
}

TEST(Context, OnlyOsmesaIsLoaded) {
  // libGL ahead of libOSMesa gives black frames without an error.
  const Context context({.backend = Backend::osmesa});
  std::ifstream maps("/proc/self/maps");
  bool osmesa = false;
  for (std::string line; std::getline(maps, line);) {
    osmesa = osmesa || line.find("libOSMesa") != std::string::npos;
    EXPECT_EQ(line.find("libGL.so"), std::string::npos) << line;
    EXPECT_EQ(line.find("libGLX"), std::string::npos) << line;
    EXPECT_EQ(line.find("libGLEW"), std::string::npos) << line;
  }
  EXPECT_TRUE(osmesa);
}

Frame ball_frame() {
  Frame frame;
  frame.meshes = {make_ball({0, 0, 1}, 1.0f, {0.8f, 0.3f, 0.1f})};
  return frame;
}

TEST(Renderer, TwoTakeTurnsOnOneThread) {
  const Frame frame = ball_frame();
  const Image alone = draw_once(frame, small_picture());
  Renderer first(small_picture());
  Image image;
  {
    RenderOptions large = small_picture();
    large.width = 400;
    Renderer second(large);
    Image other;
    second.draw(frame, other);
    EXPECT_EQ(other.width, 400);
    first.draw(frame, image);
    EXPECT_EQ(image.pixels, alone.pixels);
    second.draw(frame, other);
  }
  first.draw(frame, image);
  EXPECT_EQ(image.pixels, alone.pixels) << "after the other one is gone";
}

TEST(Renderer, TwoRunOnTwoThreads) {
  const Frame frame = ball_frame();
  const Image expected = draw_once(frame, small_picture());
  Image a;
  Image b;
  std::thread one([&] { a = draw_once(frame, small_picture()); });
  std::thread two([&] { b = draw_once(frame, small_picture()); });
  one.join();
  two.join();
  EXPECT_EQ(a.pixels, expected.pixels);
  EXPECT_EQ(b.pixels, expected.pixels);
}

TEST(Renderer, RefusesOptionsOutOfRange) {
  const auto with = [](int width, int height, int samples, int shadow_size) {
    Renderer renderer({width, height, samples, shadow_size});
  };
  EXPECT_THROW(with(15, 240, 4, 1024), std::invalid_argument);
  EXPECT_THROW(with(320, 16385, 4, 1024), std::invalid_argument);
  EXPECT_THROW(with(320, 240, 3, 1024), std::invalid_argument);
  EXPECT_THROW(with(320, 240, 4, 100), std::invalid_argument);
}

TEST(Renderer, TakesEachNumberOfSamplesAndOddSizes) {
  for (const int samples : {1, 2, 4}) {
    const Image image = draw_once(ball_frame(), {331, 173, samples, 256});
    EXPECT_EQ(image.width, 331);
    EXPECT_EQ(image.height, 173);
    EXPECT_EQ(image.pixels.size(), 331u * 173u * 3u);
  }
}

}  // namespace
}  // namespace pneuma::render
