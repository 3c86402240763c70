#include "sim/collision/particles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "sim/mesh/measure.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

SurfaceView surface(const SoftBody& body) { return {body.mesh->topology, body.positions}; }

constexpr double min_distance = 0.05;  // a tenth of the skin thickness

/// Two of the paper's spheres, `distance` apart from centre to centre along a slanting line.
const Vec3 line = Vec3(2.0, 1.0, -0.5).normalized();
struct Spheres {
  SoftBody first, second;
  explicit Spheres(double distance)
      : first(make_body(make_sphere(3.0, 8, 8))),
        second(make_body(make_sphere(3.0, 8, 8), distance * line)) {}

  ParticlePair particles(std::uint64_t seed, int number_of_second = 1) const {
    return make_particles(0, first.mesh->topology, number_of_second, second.mesh->topology, {},
                          seed);
  }
  int settle(ParticlePair& pair, const ParticleSettings& settings) const {
    ParticleScratch scratch;
    return settle_particles(surface(first), surface(second), settings, min_distance, pair, scratch);
  }
};

TEST(Particles, AreAnEighthOfTheVerticesAndAtLeastOne) {
  EXPECT_EQ(particle_count(256, 1.0 / 8.0), 32);  // the paper's torus
  EXPECT_EQ(particle_count(58, 1.0 / 8.0), 7);    // its sphere: 7.25
  EXPECT_EQ(particle_count(8, 1.0 / 8.0), 1);
  EXPECT_EQ(particle_count(4, 1.0 / 8.0), 1);
  EXPECT_EQ(particle_count(58, 0.0), 1);
  EXPECT_EQ(particle_count(58, 1.0), 58);
  const SoftBody torus = make_body(make_torus(6.0, 2.0, 16, 16));
  const SoftBody sphere = make_body(make_sphere(3.0, 8, 8));
  const ParticlePair pair =
      make_particles(2, torus.mesh->topology, 5, sphere.mesh->topology, {}, 1);
  EXPECT_EQ(pair.first, 2);
  EXPECT_EQ(pair.second, 5);
  EXPECT_EQ(pair.first_features.size(), 32U);
  EXPECT_EQ(pair.second_features.size(), 7U);
}

TEST(Particles, StartOnFeaturesThatTheSeedAndThePairDecide) {
  const Spheres spheres(6.0);
  const ParticlePair pair = spheres.particles(1);
  EXPECT_EQ(spheres.particles(1).first_features, pair.first_features);
  EXPECT_EQ(spheres.particles(1).second_features, pair.second_features);
  EXPECT_NE(spheres.particles(2).first_features, pair.first_features);
  EXPECT_NE(spheres.particles(1, 2).first_features, pair.first_features) << "another pair";
  EXPECT_NE(pair.second_features, pair.first_features);
}

TEST(Particles, StartAllOverTheBody) {
  // 1000 seeds with 7 particles each hit every one of 338 features: each is missed with the chance
  // (1 - 1/338)^7000 = 1e-9.
  const Spheres spheres(6.0);
  std::set<int> hit;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    for (const int feature : spheres.particles(seed).first_features) hit.insert(feature);
  }
  EXPECT_EQ(hit.size(), 338U);
  EXPECT_EQ(*hit.begin(), 0);
  EXPECT_EQ(*hit.rbegin(), 337);
}

/// The middle of a feature, from the bare mesh.
Vec3 middle(const SoftBody& body, int feature) {
  const MeshTopology& mesh = body.mesh->topology;
  if (feature < mesh.vertex_count()) return body.positions[feature];
  feature -= mesh.vertex_count();
  if (feature < mesh.edge_count()) {
    const auto [a, b] = mesh.edges()[at(feature)];
    return 0.5 * (body.positions[a] + body.positions[b]);
  }
  const auto [a, b, c] = mesh.triangles()[at(feature - mesh.edge_count())];
  return (body.positions[a] + body.positions[b] + body.positions[c]) / 3.0;
}

struct Cost {
  double value = 0.0;
  double rounding = 0.0;  // of the same in single precision
};

/// The cost as section 5.2.1 describes it, with the attraction at twice the repulsion. Places in
/// single precision, reckoned from a place on `body`, are wrong by half a unit in the last place of
/// their distance from there, along each axis.
Cost cost(const SoftBody& body, const std::vector<int>& own, std::size_t particle, int feature,
          const SoftBody& other_body, const std::vector<int>& others) {
  constexpr double unit = std::numeric_limits<float>::epsilon();
  const Vec3 here = middle(body, feature);
  const double extent = bounds(body.positions).size().norm();
  Cost sum;
  const auto add = [&](double weight, const Vec3& there) {
    const double distance = (there - here).norm();
    const double bounded = std::max(distance, min_distance);
    const double term = weight / (bounded * bounded);
    const double wrong_place = 2.0 * unit * (distance + 2.0 * extent);
    sum.value += term;
    sum.rounding += std::abs(term) * (2.0 * wrong_place / bounded + 10.0 * unit);
  };
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (i != particle) add(1.0, middle(body, own[i]));
  }
  for (const int other : others) add(-2.0, middle(other_body, other));
  return sum;
}

/// Follows one body's half of a sweep particle by particle: each must have gone to the cheapest of
/// its feature and the incident ones, but for rounding. Returns how many moved.
int expect_cheapest(const SoftBody& body, std::vector<int> before, const std::vector<int>& after,
                    const SoftBody& other_body, const std::vector<int>& others) {
  int moved = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const auto cost_at = [&](int feature) {
      return cost(body, before, p, feature, other_body, others);
    };
    const auto expect_no_more = [](const Cost& a, const Cost& b) {
      EXPECT_LE(a.value, b.value + a.rounding + b.rounding);
    };
    const Cost there = cost_at(after[p]);
    expect_no_more(there, cost_at(before[p]));
    for (const int neighbour : body.mesh->topology.feature_neighbours(before[p])) {
      expect_no_more(there, cost_at(neighbour));
    }
    if (after[p] != before[p]) ++moved;
    before[p] = after[p];
  }
  return moved;
}

TEST(Particles, EachWalksToTheCheapestFeatureAroundIt) {
  ParticleSettings one_sweep;
  one_sweep.max_sweeps = 1;
  for (const double distance : {5.0, 6.0, 6.9}) {
    const Spheres spheres(distance);
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      ParticlePair pair = spheres.particles(seed);
      for (int sweep = 0; sweep < 10; ++sweep) {
        const ParticlePair before = pair;
        EXPECT_EQ(spheres.settle(pair, one_sweep), 1);
        expect_cheapest(spheres.first, before.first_features, pair.first_features, spheres.second,
                        before.second_features);
        expect_cheapest(spheres.second, before.second_features, pair.second_features, spheres.first,
                        pair.first_features);
      }
    }
  }
}

TEST(Particles, TheWalkEndsWhenFewerThanFourMoveOrAfterTenSweeps) {
  ParticleSettings one_sweep;
  one_sweep.max_sweeps = 1;
  std::set<int> counts;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Spheres spheres(6.2);
    ParticlePair pair = spheres.particles(seed), step_by_step = pair;
    const int sweeps = spheres.settle(pair, {});
    counts.insert(sweeps);
    ASSERT_LE(sweeps, 10);
    for (int sweep = 1; sweep <= sweeps; ++sweep) {
      const ParticlePair before = step_by_step;
      spheres.settle(step_by_step, one_sweep);
      int moved = 0;
      for (std::size_t i = 0; i < before.first_features.size(); ++i) {
        moved += step_by_step.first_features[i] != before.first_features[i] ? 1 : 0;
        moved += step_by_step.second_features[i] != before.second_features[i] ? 1 : 0;
      }
      const bool is_last = sweep == sweeps;
      if (is_last && sweeps == 10) continue;
      ASSERT_EQ(moved < 4, is_last) << moved;
    }
    ASSERT_EQ(step_by_step.first_features, pair.first_features);
    ASSERT_EQ(step_by_step.second_features, pair.second_features);
  }
  EXPECT_GT(counts.size(), 2U);
  EXPECT_EQ(ParticleSettings{}.max_sweeps, 10);
  EXPECT_EQ(ParticleSettings{}.settled_below, 4);
}

/// The cosine between the mean direction from a body's centre to its particles and `towards`.
double facing(const SoftBody& body, const std::vector<int>& features, const Vec3& towards) {
  Vec3 sum = Vec3::Zero();
  for (const int feature : features) sum += middle(body, feature) - mean(body.positions);
  return sum.normalized().dot(towards);
}

/// Where a walk from `seed` leads.
ParticlePair walked(const SoftBody& first, const SoftBody& second, double least,
                    std::uint64_t seed) {
  ParticleScratch scratch;
  ParticlePair pair = make_particles(0, first.mesh->topology, 1, second.mesh->topology, {}, seed);
  settle_particles(surface(first), surface(second), {}, least, pair, scratch);
  return pair;
}

TEST(Particles, WalkAlikeOnBodiesOfAnySize) {
  // Powers of two, which change no digit.
  for (const double scale : {0x1p-14, 0x1p-5, 0x1p10, 0x1p17}) {
    const Spheres spheres(6.0);
    const double radius = 3.0 * scale;
    const SoftBody first = make_body(make_sphere(radius, 8, 8));
    const SoftBody second = make_body(make_sphere(radius, 8, 8), 6.0 * scale * line);
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const ParticlePair expected = walked(spheres.first, spheres.second, min_distance, seed);
      const ParticlePair pair = walked(first, second, min_distance * scale, seed);
      EXPECT_EQ(pair.first_features, expected.first_features) << scale << " " << seed;
      EXPECT_EQ(pair.second_features, expected.second_features) << scale << " " << seed;
    }
  }
}

TEST(Particles, OfASmallBodyFindTheCheapestFeaturesBesideAHugeOne) {
  const SoftBody ball = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 1.05});
  const SoftBody slab = make_body(make_box({1e5, 1e5, 2e4}, 3), {3.0, 2.0, -1e4});
  ParticleSettings one_sweep;
  one_sweep.max_sweeps = 1;
  ParticleScratch scratch;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    ParticlePair pair = make_particles(0, slab.mesh->topology, 1, ball.mesh->topology, {}, seed);
    const ParticlePair before = pair;
    settle_particles(surface(slab), surface(ball), one_sweep, min_distance, pair, scratch);
    expect_cheapest(ball, before.second_features, pair.second_features, slab, pair.first_features);
    ParticlePair other_way{0, 1, before.second_features, before.first_features, false};
    settle_particles(surface(ball), surface(slab), one_sweep, min_distance, other_way, scratch);
    expect_cheapest(ball, before.second_features, other_way.first_features, slab,
                    before.first_features);
  }
}

TEST(Particles, GatherWhereTheBodiesFaceEachOther) {
  double worst = 1.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Spheres spheres(6.3);
    ParticlePair pair = spheres.particles(seed);
    for (int step = 0; step < 5; ++step) spheres.settle(pair, {});
    for (const double cosine : {facing(spheres.first, pair.first_features, line),
                                facing(spheres.second, pair.second_features, -line)}) {
      worst = std::min(worst, cosine);
    }
  }
  EXPECT_GT(worst, 0.8);  // measured: 0.955 at worst, 0.995 on average
}

TEST(Particles, WithoutTheOtherBodysPullTheySpreadOut) {
  ParticleSettings repelled;
  repelled.attraction = 0.0;
  const Spheres spheres(6.3);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ParticlePair pair = spheres.particles(seed);
    for (int step = 0; step < 5; ++step) spheres.settle(pair, repelled);
    Vec3 sum = Vec3::Zero();
    for (const int feature : pair.first_features) sum += middle(spheres.first, feature);
    // Seven points evenly over a sphere of radius 3 have their mean in the centre, but for the
    // coarseness of the features.
    EXPECT_LT((sum / 7.0).norm(), 0.75) << seed;
  }
}

TEST(Particles, OnOneFeatureCostAFiniteAmount) {
  const Spheres spheres(6.0);
  ParticlePair pair = spheres.particles(1);
  for (int& feature : pair.first_features) feature = 5;
  const ParticlePair before = pair;
  ParticleSettings one_sweep;
  one_sweep.max_sweeps = 1;
  spheres.settle(pair, one_sweep);
  expect_cheapest(spheres.first, before.first_features, pair.first_features, spheres.second,
                  before.second_features);
  EXPECT_NE(pair.first_features, before.first_features) << "they push each other off";
}

World two_spheres(double distance) {
  World world = by_impulses(make_free_world(make_body(make_sphere(3.0, 8, 8))));
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {distance, 0.0, 0.0}));
  return world;
}

TEST(Particles, AreMadeWhenAPairMeetsAndStay) {
  World world = two_spheres(9.0);
  for (int v = 0; v < world.soft[1].velocities.size(); ++v) {
    world.soft[1].velocities[v] = Vec3(-6.0, 0.0, 0.0);
  }
  Stepper stepper(world);
  ASSERT_FALSE(stepper.step(world));
  EXPECT_TRUE(world.particles.empty()) << "2 m between them";
  while (world.particles.empty() && time(world) < 1.0) ASSERT_FALSE(stepper.step(world));
  ASSERT_EQ(world.particles.size(), 1U);
  EXPECT_TRUE(world.particles[0].near);
  ASSERT_FALSE(run(world, 30.0));
  ASSERT_GT(world.soft[1].positions[0].x() - world.soft[0].positions[0].x(), 8.0) << "apart again";
  ASSERT_EQ(world.particles.size(), 1U);
  EXPECT_FALSE(world.particles[0].near);
  const ParticlePair before = world.particles[0];
  ASSERT_FALSE(run(world, 0.1));
  EXPECT_EQ(world.particles[0].first_features, before.first_features) << "nobody walks far away";
}

TEST(Particles, DoNotDependOnWhenAPairMeets) {
  // Three bodies: that another pair met earlier must not change what this pair starts from.
  World world = two_spheres(6.5);
  const auto& mesh = world.soft[0].mesh->topology;
  const ParticlePair expected = make_particles(0, mesh, 1, mesh, {}, world.settings.seed);
  world.settings.particles.max_sweeps = 0;
  World crowded = world;
  crowded.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 6.5, 0.0}));
  ASSERT_FALSE(run(world, 0.1));
  ASSERT_FALSE(run(crowded, 0.1));
  EXPECT_EQ(world.particles[0].first_features, expected.first_features);
  EXPECT_EQ(crowded.particles[0].first_features, expected.first_features);
  EXPECT_EQ(crowded.particles[0].second_features, expected.second_features);
  EXPECT_EQ(crowded.particles[1].second, 2);
}

}  // namespace
}  // namespace pneuma::sim
