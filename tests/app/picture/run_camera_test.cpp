#include "app/picture/run_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "tests/app/picture/widest_view.h"

namespace pneuma::app {
namespace {

using render::Camera;
using render::Vec3f;

constexpr std::int64_t frames_ahead = 60;  // 2 s of 30 frames

constexpr const char* falling_ball = R"(
duration = 2.0
[[body]]
radius = 1.0
position = [0.0, 0.0, 6.0]
velocity = [4.0, 0.0, 0.0]
)";

/// Two balls without weight: one is blown up, most at first, and the other flies away without end.
constexpr const char* apart = R"(
duration = 8.0
simulation = {gravity = [0, 0, 0]}
[[body]]
name = "left"
n = 2.0
radius = 1.0
position = [0.0, 0.0, 4.0]
[[body]]
name = "right"
n = 0.1
rho_g = 0.0
radius = 1.0
position = [3.0, 0.0, 4.0]
velocity = [1.5, -0.5, 0.0]
)";

scenes::Scene scene_of(const char* text, const std::vector<std::string>& overrides = {}) {
  return scenes::parse_scene(text, "test.toml", overrides);
}

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.field_of_view == b.field_of_view;
}

/// Calls for every frame of the run up to the last one.
template <class Visit>
void for_each_frame(const scenes::Scene& scene, std::int64_t last, const Visit& visit) {
  Simulation simulation(scene, build_world(scene), 1);
  for (;;) {
    visit(simulation.world(), simulation.frame());
    if (simulation.frame() == last) return;
    simulation.advance_frame();
  }
}

/// The cameras of all frames asked for one after the other.
std::vector<Camera> cameras_of(const scenes::Scene& scene, int threads = 1) {
  RunCamera camera(scene, build_world(scene), threads);
  std::vector<Camera> cameras;
  for_each_frame(scene, scenes::frame_count(scene), [&](const sim::World& world, std::int64_t) {
    cameras.push_back(camera.at(world));
    camera.prepare_next();
  });
  return cameras;
}

TEST(RunCamera, OfARunNotLongerThanItLooksAheadShowsTheWholeOfItAndStays) {
  for (const char* size : {"picture.width=1280", "picture.width=300"}) {  // wide, and upright
    const scenes::Scene scene = scene_of(falling_ball, {size});
    const sim::World start = build_world(scene);
    RunCamera whole(scene, start, 1);
    whole.look_to_the_end(start);
    RunCamera camera(scene, start, 1);
    float most = 0.0f;
    for_each_frame(scene, frames_ahead, [&](const sim::World& world, std::int64_t frame) {
      EXPECT_TRUE(same(camera.at(world), whole.at(world))) << frame;
      most = std::max(most, widest_view(scene, world, camera.at(world)));
    });
    EXPECT_LE(most, 1.0f) << size;
    EXPECT_GE(most, 0.5f) << size;  // nor lost in the distance
  }
}

TEST(RunCamera, LooksNoFurtherAheadThanItSays) {
  const scenes::Scene scene = scene_of(apart);
  const sim::World start = build_world(scene);
  std::int64_t simulated = 0;
  CameraEvents events;
  events.looked_ahead = [&](const sim::World& ahead, double until) {
    ++simulated;
    EXPECT_LE(sim::time(ahead), until);
    EXPECT_EQ(until, RunCamera::look_ahead);
  };
  RunCamera camera(scene, start, 1, OnDivergence::automatic, events);
  camera.at(start);
  EXPECT_EQ(simulated, frames_ahead);
}

TEST(RunCamera, HasAllBodiesInViewInEveryFrame) {
  for (const char* orbit : {"camera.orbit=0", "camera.orbit=40"}) {
    const scenes::Scene scene = scene_of(apart, {orbit});
    RunCamera camera(scene, build_world(scene), 1);
    Camera first, last;
    for_each_frame(scene, 240, [&](const sim::World& world, std::int64_t frame) {
      last = camera.at(world);
      if (frame == 0) first = last;
      EXPECT_LE(widest_view(scene, world, last), 1.0f) << orbit << ", frame " << frame;
    });
    EXPECT_GT((last.eye - last.target).norm(), (first.eye - first.target).norm() + 3.0f) << orbit;
  }
}

/// By the fastest of the nearest cameras that see all up to a frame, from the look-ahead on.
TEST(RunCamera, StartsAndStopsToMoveWithoutJerks) {
  const scenes::Scene scene = scene_of(apart);
  ViewOfBodies view(scene, build_world(scene));
  Vec3f nearest = Vec3f::Zero();
  float fastest = 0.0f;
  for_each_frame(scene, 240, [&](const sim::World& world, std::int64_t frame) {
    view.add(world);
    const Vec3f eye = view.camera().eye;
    if (frame > frames_ahead) fastest = std::max(fastest, (eye - nearest).norm());
    nearest = eye;
  });
  ASSERT_GT(fastest, 0.02f) << "m in a frame: it moves";

  const std::vector<Camera> cameras = cameras_of(scene);
  for (std::size_t i = 2; i < cameras.size(); ++i) {
    const Vec3f before = cameras[i - 1].eye - cameras[i - 2].eye;
    const Vec3f step = cameras[i].eye - cameras[i - 1].eye;
    // 1e-5 m for the rounding of tens of metres to single precision.
    EXPECT_LE((step - before).norm(), 2.0f / (frames_ahead + 1) * fastest + 1e-5f) << i;
  }
}

TEST(RunCamera, IsTheSameForAPartOfTheRunAfterAResumeAndForAnyThreads) {
  for (const char* orbit : {"camera.orbit=0", "camera.orbit=40"}) {
    const scenes::Scene scene = scene_of(apart, {orbit});
    const std::vector<Camera> cameras = cameras_of(scene);
    const std::vector<Camera> by_two = cameras_of(scene, 2);
    const sim::World start = build_world(scene);
    RunCamera of_part(scene, start, 1), so_far(scene, start, 1), resumed(scene, start, 1);
    for_each_frame(scene, 240, [&](const sim::World& world, std::int64_t frame) {
      const Camera& expected = cameras.at(static_cast<std::size_t>(frame));
      EXPECT_TRUE(same(by_two.at(static_cast<std::size_t>(frame)), expected)) << frame;
      // As --frames 100- and one lost picture have it.
      if (frame < 100 || frame % 7 != 0) {
        of_part.see(world);
      } else {
        EXPECT_TRUE(same(of_part.at(world), expected)) << frame;
      }
      // Interrupted after frame 30, before the first bodies have gone beyond.
      if (frame <= 30) so_far.at(world);
      if (frame == 30) resumed.go_on(*so_far.seen());
      if (frame > 30) {
        EXPECT_TRUE(same(resumed.at(world), expected)) << frame;
      }
    });
  }
}

// A run takes each frame that the camera has simulated, and goes on by itself from the last.
TEST(RunCamera, KeepsTheFramesThatItHasSimulated) {
  const scenes::Scene scene = scene_of(apart, {"simulation.integrator=rk4"});
  const sim::World start = build_world(scene);
  Simulation whole(scene, start, 1), taking(scene, start, 1);
  RunCamera alone(scene, start, 1), camera(scene, start, 1);
  alone.at(start);
  EXPECT_FALSE(alone.take_frame(1)) << "nobody has asked for it";
  camera.keep_frames();
  camera.at(start);
  while (whole.frame() < frames_ahead + 5) {
    whole.advance_frame();
    if (auto frame = camera.take_frame(whole.frame())) {
      EXPECT_LE(whole.frame(), frames_ahead);
      taking.adopt(std::move(*frame));
    } else {
      EXPECT_GT(whole.frame(), frames_ahead);
      taking.advance_frame();
    }
    EXPECT_EQ(sim::state_hash(taking.world()), sim::state_hash(whole.world()));
    ASSERT_EQ(taking.contacts().size(), whole.contacts().size());
    EXPECT_EQ(taking.step_parts(), whole.step_parts());
    EXPECT_EQ(taking.driven_work(), whole.driven_work());
    EXPECT_GT(taking.stage_times().front(), 0.0);
  }
}

TEST(RunCamera, ForgetsFramesBeforeTheOneThatIsTaken) {
  const scenes::Scene scene = scene_of(apart);
  const sim::World start = build_world(scene);
  RunCamera camera(scene, start, 1);
  camera.keep_frames();
  camera.at(start);
  const auto tenth = camera.take_frame(10);
  ASSERT_TRUE(tenth);
  EXPECT_EQ(tenth->world.steps, 10 * scenes::steps_per_frame(scene));
  EXPECT_FALSE(camera.take_frame(9));
  EXPECT_TRUE(camera.take_frame(11));
}

TEST(RunCamera, KeepsNoMoreThanItMay) {
  const scenes::Scene scene = scene_of(apart);
  const sim::World start = build_world(scene);
  const auto keeps = [&](std::size_t most_bytes) {
    RunCamera camera(scene, start, 1);
    camera.keep_frames(most_bytes);
    camera.at(start);
    return camera.take_frame(frames_ahead).has_value();
  };
  std::size_t least = 0;  // of each vertex in each frame its position and velocity
  for (const sim::SoftBody& body : start.soft) {
    least += static_cast<std::size_t>(frames_ahead * 2 * body.positions.rows().size()) * 8;
  }
  EXPECT_FALSE(keeps(least));
  EXPECT_TRUE(keeps(2 * least)) << "all else is less";
}

TEST(RunCamera, BetweenFramesIsThatOfTheFrameBefore) {
  const scenes::Scene scene = scene_of(apart);
  const std::vector<Camera> cameras = cameras_of(scene);
  Simulation simulation(scene, build_world(scene), 1);
  RunCamera camera(scene, simulation.world(), 1);
  while (simulation.frame() < 150) {
    simulation.advance_step();
    if (simulation.world().steps == scenes::steps_per_frame(scene) * 140 + 1) {
      EXPECT_TRUE(same(camera.at(simulation.world()), cameras[140]));
    }
    camera.see(simulation.world());
  }
  EXPECT_TRUE(same(camera.at(simulation.world()), cameras[150]));
}

TEST(RunCamera, SaysOnceWhatFallsForEverAndDoesNotFollowIt) {
  const scenes::Scene scene =
      scene_of(falling_ball, {"ground.present=false", "duration=10", "body.n=0.1"});
  std::vector<std::string> said;
  CameraEvents events;
  events.notice = [&](const std::string& text) { said.push_back(text); };
  RunCamera camera(scene, build_world(scene), 1, OnDivergence::automatic, events);
  Camera last;
  for_each_frame(scene, 300, [&](const sim::World& world, std::int64_t frame) {
    last = camera.at(world);
    if (frame == 0) {
      EXPECT_LE(widest_view(scene, world, last), 1.0f);
    }
  });
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(said[0].starts_with("body 'body1' goes beyond the automatic camera's view at t = "))
      << said[0];
  EXPECT_LT((last.eye - Vec3f(0, 0, 6)).norm(), 100.0f) << "of 400 m that it falls";
}

TEST(RunCamera, SaysNothingOfBodiesThatStayNear) {
  const scenes::Scene scene = scene_of(falling_ball);
  CameraEvents events;
  events.notice = [](const std::string& text) { ADD_FAILURE() << text; };
  RunCamera camera(scene, build_world(scene), 1, OnDivergence::automatic, events);
  for_each_frame(scene, 100, [&](const sim::World& world, std::int64_t) { camera.at(world); });
}

TEST(RunCamera, LeavesDivergenceToTheRun) {
  const scenes::Scene scene = scene_of(falling_ball, {"body.k=1e9"});
  RunCamera camera(scene, build_world(scene), 1);
  EXPECT_NO_THROW(camera.at(build_world(scene)));
}

TEST(RunCamera, CanBeStopped) {
  struct Stop {};
  const scenes::Scene scene = scene_of(falling_ball);
  CameraEvents events;
  events.looked_ahead = [](const sim::World&, double) { throw Stop(); };
  RunCamera camera(scene, build_world(scene), 1, OnDivergence::automatic, events);
  EXPECT_THROW(camera.at(build_world(scene)), Stop);
}

TEST(RunCamera, StandsWhereTheSceneSays) {
  const scenes::Scene scene = scene_of(falling_ball, {"camera.azimuth=0", "camera.elevation=45"});
  const sim::World start = build_world(scene);
  const Camera camera = RunCamera(scene, start, 1).at(start);
  const Vec3f backward = (camera.eye - camera.target).normalized();
  // From +x, half way up. Single precision over a distance of tens of metres.
  EXPECT_LT((backward - Vec3f(std::sqrt(0.5f), 0.0f, std::sqrt(0.5f))).norm(), 1e-5f);
}

TEST(RunCamera, OfTheScenesOwnIsThereWithoutSimulating) {
  for (const char* camera : {"{eye = [0, -9, 6], target = [0, 0, 6]}", "{follow = \"body1\"}",
                             "{path = [[0, 0, -9, 6, 0, 0, 6], [1, 9, 0, 6, 0, 0, 6]]}"}) {
    const scenes::Scene scene =
        scene_of(("camera = " + std::string(camera) + falling_ball).c_str());
    const sim::World start = build_world(scene);
    CameraEvents events;
    events.looked_ahead = [](const sim::World&, double) { ADD_FAILURE() << "simulated"; };
    RunCamera run(scene, start, 1, OnDivergence::automatic, events);
    EXPECT_FALSE(run.seen());
    EXPECT_LT((run.at(start).target - Vec3f(0, 0, 6)).norm(), 0.1f) << camera;
  }
}

}  // namespace
}  // namespace pneuma::app
