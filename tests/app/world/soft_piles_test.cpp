// Soft bodies that lie on one another come to rest: what the integrator takes from the vibrations
// of what is pressed, contacts do not give back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/files/find_scene.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

/// What is left of the motion of soft bodies.
struct Motion {
  double energy = 0.0;   // J, on average over the last half second
  double fastest = 0.0;  // m/s, of a vertex, likewise
};

void add_motion(const sim::SoftBody& body, double share, Motion& motion) {
  for (int v = 0; v < body.velocities.size(); ++v) {
    const double square = sim::Vec3(body.velocities[v]).squaredNorm();
    motion.energy += share * 0.5 * body.material.vertex_mass * square;
    motion.fastest = std::max(motion.fastest, std::sqrt(square));
  }
}

Motion motion_after(const scenes::Scene& scene, double time) {
  sim::World world = build_world(scene);
  sim::Stepper stepper(world);
  Motion motion;
  const double share = 2.0 / world.settings.steps_per_second;
  while (sim::time(world) < time) {
    const auto divergence = stepper.step(world);
    EXPECT_FALSE(divergence) << divergence->what;
    if (divergence) break;
    if (sim::time(world) <= time - 0.5) continue;
    for (const sim::SoftBody& body : world.soft) add_motion(body, share, motion);
  }
  return motion;
}

TEST(SoftPiles, SpheresOnOneAnotherComeToRest) {
  for (const char* name : {"two_spheres_contact", "three_spheres_contact", "sphere_in_torus"}) {
    const scenes::Scene scene = scenes::load_scene(find_scene(name));
    EXPECT_LT(motion_after(scene, 10.0).fastest, 0.05) << name;
  }
}

/// A dozen balls of a kilogram.
TEST(SoftPiles, AHeapInAPenDoesNotTremble) {
  const std::string text = R"(duration = 12
[simulation]
steps_per_second = 120
[[body]]
kind = "static"
size = [0.5, 6, 6]
position = [-2.6, 0, 3]
copies = [2, 1, 1]
spacing = [5.2, 0, 0]
[[body]]
kind = "static"
size = [6, 0.5, 6]
position = [0, -2.6, 3]
copies = [1, 2, 1]
spacing = [0, 5.2, 0]
[[body]]
radius = 1
inflation = 1.2
mass = 1
position = [-1.1, -1.1, 1.3]
copies = [2, 2, 3]
spacing = [2.2, 2.2, 2.4]
jitter = 0.1
)";
  EXPECT_LT(motion_after(scenes::parse_scene(text, "heap.toml"), 12.0).energy, 5e-4);
}

}  // namespace
}  // namespace pneuma::app
