#include "assets/weld.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace pneuma::assets {
namespace {

TEST(Weld, JoinsWhatIsNearAndKeepsTheFirst) {
  const Weld welded = weld({{0, 0, 0}, {1, 0, 0}, {0, 0, 0.09}, {1, 0.11, 0}, {1, 0, 0}}, 0.1);
  EXPECT_EQ(welded.new_index, (std::vector<int>{0, 1, 0, 2, 1}));
  ASSERT_EQ(welded.vertices.size(), 3u);
  EXPECT_EQ(welded.vertices[0], Vec3(0, 0, 0));
  EXPECT_EQ(welded.vertices[2], Vec3(1, 0.11, 0));
}

TEST(Weld, OfNothingIsNothing) { EXPECT_TRUE(weld({}, 1.0).vertices.empty()); }

/// Each vertex against all that were kept before it: what the definition says.
std::vector<int> by_definition(const std::vector<Vec3>& vertices, double distance) {
  std::vector<Vec3> kept;
  std::vector<int> result;
  for (const Vec3& v : vertices) {
    std::size_t i = 0;
    while (i < kept.size() && (kept[i] - v).norm() > distance) ++i;
    if (i == kept.size()) kept.push_back(v);
    result.push_back(static_cast<int>(i));
  }
  return result;
}

// Coordinates are quarters and the distance is no multiple of them, so that no rounding decides;
// negative ones, because cells must not be mirrored at zero.
RC_GTEST_PROP(Weld, IsWhatItsDefinitionSays, ()) {
  const auto coordinate = rc::gen::map(rc::gen::inRange(-8, 9), [](int i) { return 0.25 * i; });
  const auto vertices = *rc::gen::container<std::vector<Vec3>>(
      rc::gen::apply([](double x, double y, double z) { return Vec3(x, y, z); }, coordinate,
                     coordinate, coordinate));
  const double distance = *rc::gen::element(0.1, 0.3, 0.6, 1.3);
  RC_ASSERT(weld(vertices, distance).new_index == by_definition(vertices, distance));
}

}  // namespace
}  // namespace pneuma::assets
