#include "app/study/error/flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/host/errors.h"
#include "sim/mesh/measure.h"
#include "tests/app/study/error/small_study.h"

namespace pneuma::app {
namespace {

FlightOptions options(double seconds, bool free_flight = false, const std::string& body = "") {
  return {.body = body, .free_flight = free_flight, .seconds = seconds};
}

const std::string low = "[[body]]\nname = \"low\"\nposition = [30, 0, 3.5]\n";
const std::string box =
    "[[body]]\nname = \"box\"\nkind = \"rigid\"\nposition = [-30, 0, 30]\nsize = [1, 1, 1]\n";

TEST(Flight, IsFreeWhereNothingTouches) {
  const Flight flight = prepare_flight(small_scene(box), options(0.5));
  EXPECT_FALSE(flight.contacts);
  EXPECT_EQ(flight.world.soft.size(), 1u);
  EXPECT_TRUE(flight.world.rigid.empty());
}

TEST(Flight, IsRefusedWhereBodiesStartInEachOther) {
  const std::string inside = "[[body]]\nposition = [0, 0, 10]\n[[body]]\nposition = [1, 0, 10]\n";
  EXPECT_THROW(prepare_flight(scenes::parse_scene(inside, "inside.toml"), options(0.5)),
               scenes::SceneError);
}

TEST(Flight, HasContactsWhereSomethingTouches) {
  const Flight flight = prepare_flight(small_scene(low + box), options(0.5));
  EXPECT_TRUE(flight.contacts);
  EXPECT_TRUE(flight.world.settings.ground);
  EXPECT_EQ(flight.world.soft.size(), 2u);
  EXPECT_EQ(flight.world.rigid.size(), 1u);
}

TEST(Flight, IsFreeWhereItIsAskedFor) {
  const Flight flight = prepare_flight(small_scene(low + box), options(0.5, true));
  EXPECT_FALSE(flight.contacts);
  EXPECT_FALSE(flight.world.settings.ground);
  EXPECT_EQ(flight.world.soft.size(), 2u);
  EXPECT_TRUE(flight.world.rigid.empty());
}

TEST(Flight, CanBeOfOneBody) {
  const Flight flight = prepare_flight(small_scene(low + box), options(0.5, false, "ball"));
  EXPECT_FALSE(flight.contacts);
  ASSERT_EQ(flight.world.soft.size(), 1u);
  EXPECT_EQ(flight.world.soft[0].name, "ball");
}

TEST(Flight, CanTumble) {
  FlightOptions tumbling = options(0.5, true);
  tumbling.tumbling = true;
  const sim::World still = prepare_flight(small_scene(), options(0.5, true)).world;
  const sim::World world = prepare_flight(small_scene(), tumbling).world;
  const sim::SoftBody& body = world.soft[0];
  const sim::Vec3 centre = sim::mean(body.positions);
  EXPECT_LT((centre - sim::mean(still.soft[0].positions)).norm(), 1e-12);
  EXPECT_LT(sim::mean(body.velocities).norm(), 1e-12);
  const sim::Vec3 spin(std::sqrt(3.0), std::sqrt(3.0), std::sqrt(3.0));
  for (int v = 0; v < body.positions.size(); ++v) {
    const sim::Vec3 arm = body.positions[v] - centre;
    const sim::Vec3 sheared = spin.cross(arm) + sim::Vec3(2.0 * arm.z(), 0.0, 0.0);
    EXPECT_LT((body.velocities[v] - sheared).norm(), 1e-12);
  }
  const auto& edges = body.mesh->topology.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double length = (body.positions[edges[e][1]] - body.positions[edges[e][0]]).norm();
    EXPECT_NEAR(length, 0.9 * body.mesh->rest_lengths[e], 1e-12);
  }
}

TEST(Flight, LastsWholeSamplesAndNoLongerThanTheScene) {
  EXPECT_DOUBLE_EQ(prepare_flight(small_scene(), options(0.5)).seconds, 7.0 / 15.0);
  EXPECT_DOUBLE_EQ(prepare_flight(small_scene(), options(0.4)).seconds, 6.0 / 15.0);
  EXPECT_DOUBLE_EQ(prepare_flight(small_scene(), options(5.0)).seconds, 1.0);
  EXPECT_DOUBLE_EQ(prepare_flight(small_scene(), options(0.01)).seconds, 1.0 / 15.0);
}

const std::string dish = "[[body]]\nname = \"dish\"\nkind = \"static\"\nshape = \"torus\"\n";

std::string refusal(const std::string& more, const FlightOptions& options) {
  try {
    prepare_flight(small_scene(more), options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Flight, WithAnObstacleOfTrianglesSaysSoAndNamesOnlyWhatTheCommandHas) {
  const std::string of_others = refusal(dish, options(0.5));
  EXPECT_NE(of_others.find("dish is an obstacle of triangles"), of_others.npos) << of_others;
  EXPECT_NE(of_others.find("`pneuma study error --free-flight`"), of_others.npos) << of_others;
  FlightOptions with_options = options(0.5);
  with_options.are_options = true;
  const std::string own = refusal(dish, with_options);
  EXPECT_NE(own.find("name a soft body with --body, or add --free-flight"), own.npos) << own;
  const std::string pinned = refusal("pinned = [[-99, -99, 0, 99, 99, 50]]\n", options(0.5));
  EXPECT_NE(pinned.find("ball is pinned"), pinned.npos) << pinned;
  EXPECT_NE(pinned.find("`pneuma study error --body NAME`"), pinned.npos) << pinned;
}

TEST(Flight, ThatIsFreeHasNoObstacles) {
  const Flight flight = prepare_flight(small_scene(dish), options(0.5, true));
  ASSERT_EQ(flight.world.soft.size(), 1u);
  EXPECT_EQ(flight.world.soft[0].name, "ball");
}

TEST(Flight, RefusesWhatCannotBeStudied) {
  EXPECT_THROW(prepare_flight(small_scene(), options(0.5, false, "bal")), UsageError);
  EXPECT_THROW(prepare_flight(small_scene(box), options(0.5, true, "box")), UsageError);
  EXPECT_THROW(prepare_flight(small_scene("damping = \"literal\"\n"), options(0.5)), UsageError);
  EXPECT_THROW(
      prepare_flight(small_scene("pinned = [[-99, -99, -99, 99, 99, 99]]\n"), options(0.5)),
      UsageError);
}

}  // namespace
}  // namespace pneuma::app
