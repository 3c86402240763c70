// Time of a step in which a ball touches an obstacle, by the number of its triangles. Not a test:
// run it by hand, see README.md.

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>

#include "sim/soft/pins.h"
#include "tests/support/worlds.h"

namespace pneuma::benchmarks {
namespace {

using namespace sim;

constexpr int repetitions = 5;
constexpr int steps_per_second = 240;

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

SoftBody make_obstacle(const TriangleMesh& mesh, bool is_moved = false,
                       const GivenMotion& motion = {}) {
  SoftBody body = make_body(mesh);
  body.name = "obstacle";
  body.material.n = 0.0;
  body.material.surface = {0.0, 0.5};
  const auto count = at(body.positions.size());
  body.pins = make_pins(body.positions, std::vector<std::uint8_t>(count, 1),
                        std::vector<std::uint8_t>(count, is_moved ? 1 : 0), motion);
  return body;
}

/// 8 stacks: as the paper's, of a third of its size.
SoftBody make_ball(int stacks, const Vec3& position, const Vec3& velocity) {
  SoftBody ball = make_body(make_sphere(1.0, stacks, stacks), position);
  ball.material.n = 0.1;
  ball.material.k = 60.0;
  ball.material.vertex_mass = 1.2 / ball.positions.size();
  ball.material.surface = {0.3, 0.5};
  for (int v = 0; v < ball.positions.size(); ++v) ball.velocities[v] = velocity;
  return ball;
}

/// Its poles, where triangles are slivers, lie at the sides.
TriangleMesh make_lying_sphere(double radius, int stacks, int slices) {
  TriangleMesh mesh = make_sphere(radius, stacks, slices);
  for (Vec3& vertex : mesh.vertices) vertex = {vertex.z(), vertex.x(), vertex.y()};
  return mesh;
}

/// A sphere whose upper half is turned inwards.
TriangleMesh make_bowl(double radius, double thickness, int stacks, int slices) {
  TriangleMesh mesh = make_lying_sphere(radius, stacks, slices);
  for (Vec3& vertex : mesh.vertices) {
    if (vertex.z() < 1e-9) continue;
    vertex.z() = -vertex.z();
    vertex *= 1.0 - thickness / radius;
  }
  return mesh;
}

World on_sphere(int stacks, int slices, int ball_stacks) {
  World world;
  world.settings.ground.reset();
  world.settings.steps_per_second = steps_per_second;
  world.soft = {make_obstacle(make_lying_sphere(4.0, stacks, slices)),
                make_ball(ball_stacks, {0.3, 0.2, 5.3}, {0.5, 0.2, -6.0})};
  return world;
}

/// It rises and sinks, and turns.
World on_moved_sphere(int stacks, int slices, int ball_stacks) {
  World world = on_sphere(stacks, slices, ball_stacks);
  GivenMotion motion;
  motion.keys.path = {{0.0, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0, 0.4}, {1.0, 0.0, 0.0, 0.0}};
  motion.keys.rotation = {{0.0, 0.0, 0.0, 0.0}, {1.0, 10.0, 20.0, 30.0}};
  world.soft[0] = make_obstacle(make_lying_sphere(4.0, stacks, slices), true, motion);
  return world;
}

/// A box in place of the ball.
World with_box(World world) {
  world.soft.resize(1);
  RigidBox box = make_rigid({1.5, 1.5, 1.0}, {0.3, 0.2, 4.8});
  box.velocity = {0.5, 0.2, -3.0};
  box.surface = {0.3, 0.5};
  world.rigid = {box};
  return world;
}

World in_bowl(int stacks, int slices, int ball_stacks) {
  World world;
  world.settings.ground.reset();
  world.settings.steps_per_second = steps_per_second;
  world.soft = {make_obstacle(make_bowl(6.0, 0.4, stacks, slices)),
                make_ball(ball_stacks, {-2.0, 0.3, -3.0}, {0.0, 1.0, 0.0})};
  return world;
}

struct StepCost {
  double time = std::numeric_limits<double>::infinity();  // us of the processor, at least
  std::size_t contacts = 0;
};

/// The least of some runs, which are the same to the last bit.
void measure(const World& scene, bool leaves_obstacles, std::vector<StepCost>& steps) {
  World world = scene;
  Stepper stepper(world, {.plan = {}, .may_leave_obstacles = leaves_obstacles});
  for (StepCost& step : steps) {
    const double before = processor_time();
    if (const auto divergence = stepper.step(world)) {
      std::printf("%s: %s\n", divergence->body.c_str(), divergence->what.c_str());
      return;
    }
    step.time = std::min(step.time, processor_time() - before);
    step.contacts = stepper.contacts().size();
  }
}

struct Phase {
  const char* name;
  int first, end;  // steps
};

void compare(const char* name, const std::function<World(int, int)>& make,
             const std::vector<Phase>& phases, bool leaves_obstacles = false) {
  const std::array<std::array<int, 2>, 2> sizes{{{11, 10}, {101, 100}}};  // 200, 20,000 triangles
  std::array<std::vector<StepCost>, 2> steps;
  for (auto& of_size : steps) of_size.resize(at(phases.back().end));
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < 2; ++i) {
      measure(make(sizes[i][0], sizes[i][1]), leaves_obstacles, steps[i]);
    }
  }
  for (const Phase& phase : phases) {
    std::array<double, 2> time{}, most{};
    std::array<double, 2> contacts{};
    for (std::size_t i = 0; i < 2; ++i) {
      double count = 0.0;
      for (int s = phase.first; s < phase.end; ++s) {
        const StepCost& step = steps[i][at(s)];
        if (step.contacts == 0) continue;
        ++count;
        time[i] += step.time;
        most[i] = std::max(most[i], step.time);
        contacts[i] += static_cast<double>(step.contacts);
      }
      time[i] /= count;
      contacts[i] /= count;
    }
    std::printf("%-22s %-8s %8.1f %8.1f us  ratio %.2f   most %8.1f %8.1f   contacts %.1f %.1f\n",
                name, phase.name, time[0], time[1], time[1] / time[0], most[0], most[1],
                contacts[0], contacts[1]);
  }
}

}  // namespace
}  // namespace pneuma::benchmarks

int main() {
  using namespace pneuma::benchmarks;
  for (const int stacks : {8, 16}) {
    std::printf("a ball of %d stacks\n", stacks);
    compare("falls on a sphere", [&](int a, int b) { return on_sphere(a, b, stacks); },
            {{"impact", 0, 60}, {"rolls", 60, 200}});
    for (const bool leaves_obstacles : {false, true}) {
      compare(
          leaves_obstacles ? "moved, left behind" : "on a moved sphere",
          [&](int a, int b) { return on_moved_sphere(a, b, stacks); },
          {{"impact", 0, 60}, {"rolls", 60, 200}}, leaves_obstacles);
    }
    compare("rolls in a bowl", [&](int a, int b) { return in_bowl(a, b, stacks); },
            {{"rolls", 60, 480}, {"slows", 480, 720}});
  }
  std::printf("a box\n");
  compare("falls on a sphere", [](int a, int b) { return with_box(on_sphere(a, b, 8)); },
          {{"impact", 0, 60}, {"slides", 60, 200}});
  compare(
      "moved, left behind", [](int a, int b) { return with_box(on_moved_sphere(a, b, 8)); },
      {{"impact", 0, 60}, {"slides", 60, 200}}, true);
}
