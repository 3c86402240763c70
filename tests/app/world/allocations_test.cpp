// A step of a paper scene asks for no memory once it has had what its contacts need. Linked by
// itself: it counts the allocations of the whole program.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/files/find_scene.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/step/stepper.h"
#include "tests/support/count_allocations.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> paper_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(find_scene("one_sphere").parent_path())) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

class AllocationsTest : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, AllocationsTest, testing::ValuesIn(paper_scenes()),
                         [](const auto& scene) { return scene.param; });

/// All steps of the paper's scenes but the cat's, which takes many small ones: it has met the
/// sphere by then.
std::int64_t counted_steps(const scenes::Scene& scene) {
  const std::int64_t all = scenes::frame_count(scene) * scene.settings.steps_per_second /
                           scene.picture.frames_per_second;
  return std::min<std::int64_t>(all, 720);
}

// The same steps twice with one stepper: in the second run the numbers of contacts have peaked.
// Particles are made when two bodies meet, and belong to the world, not to the stepper: they are
// made again, copied in the next step (to be given back should it fail), and counted is what comes
// after.
void expect_none_after_the_peak(const scenes::Scene& scene) {
  const sim::World start = build_world(scene);
  sim::World world = start;
  sim::Stepper stepper(world);
  const std::int64_t end = counted_steps(scene);
  std::int64_t last_meeting = 0;
  while (world.steps < end) {
    const std::size_t pairs = world.particles.size();
    const long before = allocation_count();
    ASSERT_FALSE(stepper.step(world));
    if (world.steps == 1) {
      ASSERT_GT(allocation_count(), before) << "the count must work";
    }
    if (world.particles.size() > pairs) last_meeting = world.steps;
  }
  ASSERT_LT(last_meeting, end / 2) << "too few steps are left to count";

  world = start;
  while (world.steps < last_meeting + 1) ASSERT_FALSE(stepper.step(world));
  const long before = allocation_count();
  while (world.steps < end) ASSERT_FALSE(stepper.step(world));
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST_P(AllocationsTest, NoneOnceTheContactsHavePeaked) {
  expect_none_after_the_peak(scenes::load_scene(find_scene(GetParam())));
}

TEST(PaperMethodAllocations, NoneOnceTheContactsHavePeaked) {
  const std::vector<std::string> by_paper = {"simulation.method=paper"};
  for (const char* name : {"two_spheres_contact", "torus_three_spheres_four_cubes"}) {
    SCOPED_TRACE(name);
    expect_none_after_the_peak(scenes::load_scene(find_scene(name), by_paper));
  }
}

}  // namespace
}  // namespace pneuma::app
