#include "app/study/error/reference.h"

#include <gtest/gtest.h>

#include "app/host/errors.h"
#include "app/study/error/error_meter.h"
#include "app/study/error/solver.h"
#include "tests/app/study/error/small_study.h"

namespace pneuma::app {
namespace {

Flight flight_of(const scenes::Scene& scene, double seconds) {
  FlightOptions options;
  options.seconds = seconds;
  return prepare_flight(scene, options);
}

TEST(MakeReference, KnowsASmoothMotionToTheEnd) {
  const Reference reference = make_reference(flight_of(small_scene(), 0.6), 960);
  EXPECT_EQ(reference.trajectory.size(), 9u);
  EXPECT_DOUBLE_EQ(reference.seconds, 0.6);
  EXPECT_LE(reference.uncertainty, 1e-9);
  EXPECT_GT(reference.uncertainty, 0.0);
  EXPECT_EQ(reference.limit, "");
}

/// The torus of one_torus.toml with so much gas that it buckles.
scenes::Scene buckling_torus() {
  return scenes::parse_scene(
      "duration = 2.0\n[ground]\npresent = false\n[[body]]\nshape = \"torus\"\nradius = 6.0\n"
      "tube_radius = 2.0\nstacks = 16\nslices = 16\nk = 400.0\nn = 100.0\nk_max = 1000.0\n",
      "buckling.toml");
}

TEST(MakeReference, SaysUntilWhenABucklingMotionIsKnown) {
  const Flight flight = flight_of(buckling_torus(), 0.8);
  const Reference reference = make_reference(flight, 960);
  EXPECT_NE(reference.limit, "");
  EXPECT_LE(reference.uncertainty, 1e-9);
  ASSERT_LT(reference.trajectory.size(), 12u);

  // rk4 at a short step is still there at that time, and not at the end.
  sim::World world = flight.world;
  world.settings.integrator = sim::Integrator::rk4;
  world.settings.steps_per_second = 7680;
  const auto ours = make_stepper_solver(world, false);
  const auto other = make_reference_solver(flight.world, 1e-12);
  std::vector<double> differences;
  for (std::size_t i = 0; i < 12; ++i) {
    ASSERT_TRUE(ours->advance(i) && other->advance(i));
    differences.push_back(ErrorMeter(world, {other->sample()}).errors(0, ours->sample()).position);
  }
  EXPECT_LT(differences[reference.trajectory.size() - 1], 1e-7);
  EXPECT_GT(differences.back(), 1e-5);
}

TEST(MakeReference, IsOurOwnFinestRunWithContacts) {
  Flight flight =
      flight_of(small_scene("[[body]]\nname = \"low\"\nposition = [30, 0, 3.5]\n"), 0.4);
  ASSERT_TRUE(flight.contacts);
  const Reference reference = make_reference(flight, 960);
  flight.world.settings.integrator = sim::Integrator::rk4;
  flight.world.settings.steps_per_second = 1920;
  const auto finest = make_stepper_solver(flight.world, true);
  for (std::size_t i = 0; i < reference.trajectory.size(); ++i) {
    ASSERT_TRUE(finest->advance(i));
    EXPECT_EQ(finest->sample().soft[1].positions.rows(),
              reference.trajectory[i].soft[1].positions.rows());
  }
  EXPECT_LE(reference.uncertainty, 1e-3);
}

TEST(MakeReference, FailsWhereNothingIsKnown) {
  // Springs so stiff that the finest run, too, is unstable.
  Flight flight =
      flight_of(small_scene("[[body]]\nname = \"low\"\nposition = [30, 0, 3.5]\n"), 0.4);
  flight.world.soft[1].material.k = 1e12;
  ASSERT_TRUE(flight.contacts);
  EXPECT_THROW(make_reference(flight, 60), DivergenceError);
}

}  // namespace
}  // namespace pneuma::app
