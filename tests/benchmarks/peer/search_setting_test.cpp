#include "benchmarks/peer/search_setting.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/worlds.h"

namespace pneuma::benchmarks {
namespace {

/// A sphere that its gas has blown up to twice its volume, in free flight.
sim::World blown_up() {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_sphere(3.0, 8, 8)));
  world.soft[0].material.n = 1.0;
  world.soft[0].material.rho_g = 0.2;  // at rest within two seconds
  return world;
}

const SearchGrid small = {.efforts = {{1, 1}, {1, 2}},
                          .stiffnesses = {0.4, 0.1},
                          .margins = {0.25},
                          .drags = {0.05},
                          .voxel_sizes = {1.0}};

TEST(SearchSetting, FindsWhatSimulatesASphereAsOursTheCheapestFirst) {
  const SettingSearch search = search_setting("sphere", blown_up(), 2.0, small);
  EXPECT_GT(search.ours.quality.inflation, 1.5);
  ASSERT_FALSE(search.reaching.empty());
  for (const Candidate& one : search.reaching) {
    EXPECT_TRUE(reaches(one.trial.quality, search.ours.quality));
    EXPECT_GT(one.trial.frame_seconds, 0.0);
  }
  EXPECT_TRUE(std::ranges::is_sorted(search.reaching, {},
                                     [](const Candidate& one) { return one.trial.frame_seconds; }));
  EXPECT_GT(search.tried, static_cast<int>(search.reaching.size()));
}

TEST(SearchSetting, FoundSettingsReachTheSameAgain) {
  const sim::World world = blown_up();
  const SettingSearch search = search_setting("sphere", world, 2.0, small);
  ASSERT_FALSE(search.reaching.empty());
  const Candidate& found = search.reaching.front();
  BulletOptions options = found.options;
  const auto again = simulate_by_bullet(world, options);
  EXPECT_EQ(try_out(*again, 2.0).quality.inflation, found.trial.quality.inflation);
  for (const double factor : {0.97, 1.03}) {  // nor is it chance
    options.gas_fraction = factor * found.options.gas_fraction;
    const auto other = simulate_by_bullet(world, options);
    EXPECT_TRUE(reaches(try_out(*other, 2.0).quality, search.ours.quality));
  }
}

TEST(SearchSetting, SaysWhatIsNearestWhereNothingReaches) {
  SearchGrid hard = small;
  hard.stiffnesses = {1.0};
  sim::World world = blown_up();
  world.rigid.emplace_back().position = {100.0, 0.0, 0.0};
  world.rigid[0].velocity = {10.0, 0.0, 0.0};  // for ever, as Bullet's boxes know no drag
  world.rigid[0].rho_g = 0.5;
  const SettingSearch search = search_setting("sphere and box", world, 2.0, hard);
  EXPECT_TRUE(search.reaching.empty());
  ASSERT_FALSE(search.nearest.empty());
  const Quality& ours = search.ours.quality;
  EXPECT_FALSE(rests_like(search.nearest.front().trial.quality, ours));
  EXPECT_LE(shortfall(search.nearest.front().trial.quality, ours),
            shortfall(search.nearest.back().trial.quality, ours));
}

TEST(SearchSetting, BoxesHaveSmallerVoxelsAndACoarserGrid) {
  sim::World world = blown_up();
  const SearchGrid without = search_grid(world);
  world.rigid.emplace_back();
  EXPECT_LT(search_grid(world).voxel_sizes.front(), without.voxel_sizes.front());
  EXPECT_LT(search_grid(world).stiffnesses.size(), without.stiffnesses.size());  // runs are long
}

}  // namespace
}  // namespace pneuma::benchmarks
