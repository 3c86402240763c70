// The six feature tests against the true distance, and the parts and points they report.
#include <gtest/gtest.h>

#include "sim/collision/feature_tests.h"
#include "tests/sim/collision/feature_samples.h"

namespace pneuma::sim {
namespace {

/// The corners of the part that is said to touch.
Points part_of(const Points& feature, FeaturePart part) {
  const auto i = at(part.index);
  switch (part.kind) {
    case FeatureKind::vertex:
      return {feature.at(i)};
    case FeatureKind::edge:
      return {feature.at(i), feature.at((i + 1) % feature.size())};
    case FeatureKind::triangle:
      break;
  }
  return feature;
}

struct Kinds {
  const char* name;
  std::size_t first;
  std::size_t second;
};

class FeatureDistance : public testing::TestWithParam<Kinds> {};

TEST_P(FeatureDistance, AgreesWithEnumerationOn100000Pairs) {
  FeatureSampler sampler(1);
  const auto [name, first, second] = GetParam();
  constexpr int pairs = 100'000;
  int hits = 0;
  int undecided = 0;
  for (int i = 0; i < pairs; ++i) {
    const FeaturePair pair = sampler.sample(first, second, i % FeatureSampler::relations);
    const double truth = reference_distance(pair.first, pair.second);
    const auto found = test_features(pair.first, pair.second, pair.reach);
    if (std::abs(truth - pair.reach) <= pair.tolerance) {
      ++undecided;
    } else {
      ASSERT_EQ(found.has_value(), truth < pair.reach)
          << "pair " << i << ", relation " << i % FeatureSampler::relations << ": true distance "
          << truth << ", reach " << pair.reach;
    }
    if (!found) continue;
    ++hits;
    ASSERT_NEAR(found->distance, truth, pair.tolerance)
        << "pair " << i << ", relation " << i % FeatureSampler::relations;
    ASSERT_NEAR((found->first_point - found->second_point).norm(), found->distance, pair.tolerance);
    // The points are on the parts named.
    const Points on_first = part_of(pair.first, found->first);
    const Points on_second = part_of(pair.second, found->second);
    ASSERT_LE(reference_distance(Points{found->first_point}, on_first), pair.tolerance);
    ASSERT_LE(reference_distance(Points{found->second_point}, on_second), pair.tolerance);
  }
  // Both answers are frequent, so that neither "always" nor "never" would pass.
  EXPECT_GT(hits, pairs / 5);
  EXPECT_GT(pairs - hits, pairs / 10);
  // The reach is drawn at random, so it is next to never within rounding of the distance.
  EXPECT_LT(undecided, 10);
}

// Lengths from underflow to the documented limit, and all that is exactly zero or equal.
TEST_P(FeatureDistance, IsFiniteForEveryFiniteInput) {
  constexpr std::array<double, 9> sizes{0.0, 1e-320, 1e-160, 1e-70, 1e-8, 1.0, 3.0, 1e8, 1e69};
  std::mt19937 random(5);
  std::uniform_int_distribution<std::size_t> pick(0, 2 * sizes.size() - 1);
  const auto coordinate = [&] {
    const std::size_t i = pick(random);
    return i < sizes.size() ? sizes[i] : -sizes[i - sizes.size()];
  };
  const auto points = [&](std::size_t count) {
    Points result(count);
    for (Vec3& p : result) p = Vec3{coordinate(), coordinate(), coordinate()};
    return result;
  };
  for (int i = 0; i < 20'000; ++i) {
    const double reach = std::abs(coordinate());
    const auto found = test_features(points(GetParam().first), points(GetParam().second), reach);
    if (!found) continue;
    ASSERT_TRUE(std::isfinite(found->distance) && found->first_point.allFinite() &&
                found->second_point.allFinite())
        << "pair " << i;
    ASSERT_LE(found->distance, reach) << "pair " << i;  // equal when the root rounds up
  }
}

// The paper says "closer than": exactly at the reach is not in contact.
TEST(FeatureTests, ReachIsExclusive) {
  const Vec3 vertex(0.25, 0.25, 1.0);
  const Corners triangle{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_FALSE(test_vertex_triangle(vertex, triangle, 1.0));
  EXPECT_TRUE(test_vertex_triangle(vertex, triangle, std::nextafter(1.0, 2.0)));
  EXPECT_FALSE(test_vertex_vertex(vertex, vertex, 0.0));
}

INSTANTIATE_TEST_SUITE_P(Pairs, FeatureDistance,
                         testing::Values(Kinds{"vertex_vertex", 1, 1}, Kinds{"vertex_edge", 1, 2},
                                         Kinds{"vertex_triangle", 1, 3}, Kinds{"edge_edge", 2, 2},
                                         Kinds{"edge_triangle", 2, 3},
                                         Kinds{"triangle_triangle", 3, 3}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pneuma::sim
