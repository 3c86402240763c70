// Random impacts: their scenes can be run, they hold, and what does not hold is seen.
#include <gtest/gtest.h>

#include "app/study/impact/impact_run.h"
#include "app/world/build_world.h"
#include "app/world/start_overlap.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

TEST(RandomImpact, IsTheSameOfTheSameSeedAndNumber) {
  EXPECT_EQ(random_impact(1, 7).scene, random_impact(1, 7).scene);
  EXPECT_NE(random_impact(1, 7).scene, random_impact(1, 8).scene);
  EXPECT_NE(random_impact(1, 7).scene, random_impact(2, 7).scene);
}

TEST(RandomImpact, IsASceneWhoseBodiesStartApart) {
  for (int number = 0; number < 50; ++number) {
    const scenes::Scene scene = scenes::parse_scene(random_impact(3, number).scene, "impact.toml");
    const sim::World world = build_world(scene);
    EXPECT_EQ(world.soft.size() + world.rigid.size(), 2u);
    EXPECT_NO_THROW(refuse_start_overlap(scene, world)) << number;
  }
}

TEST(ImpactRun, HoldsAndContactsAddNoEnergy) {
  for (const int number : {144, 176, 230}) {  // of those that touch, the shortest to run
    const ImpactResult result = run_impact(random_impact(1, number));
    EXPECT_EQ(result.outcome, ImpactOutcome::held) << number << ": " << result.message;
    EXPECT_LE(result.most_work, 1e-9) << number;
  }
}

/// A plate edge that passes an edge of a sphere, whose nearest points at the start were others: it
/// must be held all the same. And two boxes that turn so far in a step that impulses at its ends
/// add energy: without a vibration it comes from their motion against each other.
TEST(ImpactRun, HoldsWhatTurnsOnItsWay) {
  for (const int number : {28, 38}) {
    const ImpactResult result = run_impact(random_impact(3, number));
    EXPECT_EQ(result.outcome, ImpactOutcome::held) << number << ": " << result.message;
    EXPECT_LE(result.most_work, 1e-9) << number;
  }
}

/// A needle sticks in a soft box that presses on it harder in every step. Where there is no motion
/// left to take from what that adds, the run may end, but not go on with more energy.
TEST(ImpactRun, DoesNotGoOnWithEnergyThatContactsAdd) {
  const ImpactResult result = run_impact(random_impact(20261122, 662));
  EXPECT_NE(result.outcome, ImpactOutcome::crossed);
  EXPECT_LE(result.most_work, 1e-9) << result.message;
}

/// The paper's contacts are found at the ends of steps: between them bodies pass each other.
TEST(ImpactRun, SeesBodiesThatPassThroughEachOtherWithinAStep) {
  RandomImpact impact;
  impact.seconds = 0.5;
  impact.scene =
      "duration = 1\n[simulation]\ncontact = \"impulses\"\ngravity = [0, 0, 0]\n"
      "[ground]\npresent = false\n[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\n"
      "[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = [-12.5, 0.3, 0.2]\n"
      "velocity = [300, 0, 0]\n";
  EXPECT_EQ(run_impact(impact).outcome, ImpactOutcome::crossed);
}

}  // namespace
}  // namespace pneuma::app
