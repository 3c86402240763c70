#include "app/world/fill_body.h"

#include <gtest/gtest.h>

#include "app/world/build_world.h"
#include "app/world/settled_volume.h"
#include "scenes/loader/load_scene.h"
#include "sim/soft/gas_law.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

sim::World world_of(const std::string& body) {
  return build_world(scenes::parse_scene(body, "test.toml"));
}

/// Volume over that of the start, once the body has come to rest under an explicit integrator.
double inflation_of_a_run(const sim::World& world) {
  sim::SoftBody body = world.soft.at(0);
  body.material.rho_g = 0.4;
  sim::World free = sim::make_free_world(body);
  free.settings.steps_per_second = 480;
  EXPECT_FALSE(sim::run(free, 10.0));
  return volume_of(free.soft[0]) / volume_of(body);
}

TEST(FillBody, ARunComesToTheInflationAskedFor) {
  const std::string air = "simulation.ambient_pressure = 1000\n";
  for (const std::string& scene : {
           std::string("[[body]]\nradius = 2\ninflation = 1.3\n"),
           std::string("[[body]]\nradius = 2\ninflation = 4\ngas_exponent = 1.4\n"),
           air + "[[body]]\nradius = 2\nshape = \"icosphere\"\ninflation = 1.1\n",
           air + "[[body]]\nradius = 2\ninflation = 1.2\ngas_exponent = 1.4\n",
           std::string("[[body]]\nradius = 3\nshape = \"torus\"\ninflation = 1.5\n"),
       }) {
    const sim::World world = world_of(scene);
    const double asked = std::stod(scene.substr(scene.find("inflation = ") + 12));
    EXPECT_NEAR(inflation_of_a_run(world) / asked, 1.0, 0.01) << scene;
  }
}

TEST(FillBody, ByItsPressureAtTheStart) {
  const sim::SoftBody body =
      world_of(
          "simulation.ambient_pressure = 101325\n[[body]]\ngauge_pressure = 50\n"
          "gas_exponent = 1.4\n")
          .soft.at(0);
  const sim::GasLaw law = sim::gas_law(body.material);
  EXPECT_NEAR(sim::gauge_pressure(law, volume_of(body)), 50.0, 1e-8);
  // P V = nRT at the start, by hand.
  EXPECT_NEAR(body.material.n * 8.314472 * 293.15 / volume_of(body), 101375.0, 1e-6);
}

TEST(FillBody, ASkinIsTheSameOnAFinerMesh) {
  const auto skin = [](int subdivisions) {
    return world_of(
               "[[body]]\nshape = \"icosphere\"\nradius = 1.5\nn = 0.15\ndensity = 950\n"
               "thickness = 0.0002\nstiffness = 120\nsubdivisions = " +
               std::to_string(subdivisions) + "\n")
        .soft.at(0);
  };
  const sim::SoftBody coarse = skin(2), fine = skin(4);
  const auto mass = [](const sim::SoftBody& body) {
    return body.material.vertex_mass * body.positions.size();
  };
  // The areas of the two differ by 3 %: the coarse one lies within the ball.
  EXPECT_NEAR(mass(fine), 950.0 * 0.0002 * 4.0 * 3.14159265 * 2.25, 0.005 * mass(fine));
  EXPECT_NEAR(mass(coarse) / mass(fine), 1.0, 0.04);
  EXPECT_EQ(coarse.material.k, fine.material.k);
  const double one = settled_volume(coarse).value_or(0.0) / volume_of(coarse);
  const double other = settled_volume(fine).value_or(0.0) / volume_of(fine);
  EXPECT_GT(one, 1.3);
  EXPECT_NEAR(one / other, 1.0, 0.03);
}

TEST(FillBody, AMassIsOfAllVertices) {
  const sim::SoftBody body = world_of("[[body]]\nn = 1\nmass = 7\n").soft.at(0);
  EXPECT_DOUBLE_EQ(body.material.vertex_mass * body.positions.size(), 7.0);
}

TEST(FillBody, AnInflationOfOneIsThePressureOutside) {
  EXPECT_EQ(world_of("[[body]]\ninflation = 1\n").soft.at(0).material.n, 0.0);
  const sim::SoftBody body =
      world_of("simulation.ambient_pressure = 80\n[[body]]\ninflation = 1\n").soft.at(0);
  EXPECT_NEAR(sim::gauge_pressure(sim::gas_law(body.material), volume_of(body)), 0.0, 1e-9);
}

}  // namespace
}  // namespace pneuma::app
