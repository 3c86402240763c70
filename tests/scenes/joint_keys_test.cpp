// Gas that comes and goes, valves, springs between bodies, and skins of a density and a stiffness.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

const std::string two_bodies = "[[body]]\nname = \"a\"\n[[body]]\nname = \"b\"\n";

void expect_round_trip(const Scene& scene) {
  const Scene again = parse_scene(print_scene(scene), scene.name + ".toml");
  EXPECT_EQ(difference(again, scene), "");
  EXPECT_EQ(scene_fingerprint(again), scene_fingerprint(scene));
}

TEST(JointKeys, OfGasSetTheirMembersAndReadBack) {
  const Scene scene = parse_scene(
      "[[body]]\nsupply.n = [[0, 1], [2.5, 3]]\nsupply.temperature = [[1, 280], [2, 300]]\n"
      "supply.smooth = false\nleak.area = 0.25\nleak.discharge = 0.8\n",
      "x.toml");
  const BodyScene& body = scene.bodies[0];
  EXPECT_EQ(body.supply_n, (std::vector<TimedValue>{{0.0, 1.0}, {2.5, 3.0}}));
  EXPECT_EQ(body.supply_temperature, (std::vector<TimedValue>{{1.0, 280.0}, {2.0, 300.0}}));
  EXPECT_FALSE(body.supply_smooth);
  EXPECT_EQ(body.leak.area, 0.25);
  EXPECT_EQ(body.leak.discharge, 0.8);
  EXPECT_TRUE(has_supply(body));
  expect_round_trip(scene);
}

TEST(JointKeys, OfValvesAndSpringsSetTheirMembersAndReadBack) {
  const Scene scene =
      parse_scene(two_bodies + "[[valve]]\nfrom = \"a\"\nto = \"b\"\narea = 0.5\ndischarge = 1\n" +
                      "[[spring]]\nfrom = \"a\"\nto = \"b\"\nfrom_point = [1, 2, 3]\n"
                      "to_region = [[0, 0, 0, 1, 1, 1]]\nk = 7\ndamping = 2\nrest_length = 0\n"
                      "[[spring]]\nfrom = \"b\"\nto = \"a\"\n",
                  "x.toml", std::vector<std::string>{"spring.2.k=9", "valve.area=0.25"});
  ASSERT_EQ(scene.valves.size(), 1u);
  EXPECT_EQ(scene.valves[0].from, "a");
  EXPECT_EQ(scene.valves[0].to, "b");
  EXPECT_EQ(scene.valves[0].orifice.area, 0.25);
  EXPECT_EQ(scene.valves[0].orifice.discharge, 1.0);
  ASSERT_EQ(scene.springs.size(), 2u);
  EXPECT_EQ(scene.springs[0].from_point, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(scene.springs[0].to_region.size(), 1u);
  EXPECT_EQ(scene.springs[0].k, 7.0);
  EXPECT_EQ(scene.springs[0].damping, 2.0);
  EXPECT_EQ(scene.springs[0].rest_length, 0.0);
  EXPECT_EQ(scene.springs[1].k, 9.0);
  EXPECT_FALSE(scene.springs[1].rest_length);
  expect_round_trip(scene);
}

TEST(JointKeys, OfGasSayWhatIsAllowed) {
  const auto body = [](const std::string& keys) { return refusal("[[body]]\n" + keys); };
  expect_in(body("supply.n = [[0, 1], [0, 2]]\n"), {"x.toml:2:21", "times must rise"});
  expect_in(body("supply.n = [[-1, 1]]\n"), {"x.toml:2:14", "before the start"});
  expect_in(body("supply.n = [[0, -1]]\n"),
            {"x.toml:2:17", "supply.n = -1 mol is", "allowed: supply.n >= 0 mol ("});
  expect_in(body("supply.temperature = [[0, -1]]\n"), {"supply.temperature = -1 K is"});
  expect_in(body("supply.n = [[inf, 1]]\n"), {"supply.n time = inf", "a finite number of s"});
  expect_in(body("supply.n = [[2e6, 1]]\n"), {"x.toml:2:14", "after the longest run", "1000000"});
  expect_in(body("supply.n = [[0, 1, 2]]\n"), {"a row [time, value]"});
  expect_in(body("supply.n = 5\n"), {"an array of rows [time, value]"});
  expect_in(body("supply.n = [[0, 1]]\nn = 1\n"),
            {"x.toml:3:1", "both n and supply.n (line 2) are given; drop one"});
  expect_in(body("supply.n = [[0, 1]]\ninflation = 2\n"),
            {"x.toml:2:12", "both supply.n and inflation (line 3)"});
  expect_in(body("supply.temperature = [[0, 1]]\ngas_exponent = 1.4\n"), {"gas_exponent = 1.4"});
  expect_in(body("supply.temperature = [[0, 1]]\ntemperature = 4\n"), {"x.toml:3:1"});
  expect_in(body("supply.smooth = true\n"), {"soft bodies with supply.n or supply.temperature"});
  expect_in(body("leak.discharge = 0.5\n"), {"soft bodies with leak.area"});
  expect_in(body("leak.area = -1\n"), {"0 <= leak.area"});
  expect_in(body("kind = \"rigid\"\nleak.area = 1\n"), {"soft bodies"});
  expect_in(refusal("simulation.ambient_pressure = 1e5\n[[body]]\nsupply.n = [[0, 1], [1, 0]]\n"),
            {"x.toml:3:12", "open membrane"});
  expect_in(refusal("simulation.method = \"paper\"\n[[body]]\nleak.area = 0.1\n"), {"x.toml:3:13"});
}

TEST(JointKeys, OfJointsSayWhatIsAllowed) {
  expect_in(refusal(two_bodies + "[[valve]]\nfrom = \"a\"\n"), {"x.toml:5:1", "write to"});
  expect_in(refusal(two_bodies + "[valve]\nfrom = \"a\"\n"), {"[[valve]], with two brackets"});
  expect_in(refusal(two_bodies + "[[spring]]\nfrom = \"a\"\nto = \"b\"\nstiff = 3\n"),
            {"x.toml:8:1", "unknown key", "[[spring]]"});
  expect_in(refusal(two_bodies + "[[spring]]\nfrom = \"a\"\nto = \"b\"\nk = -1\n"), {"k >= 0"});
  expect_in(refusal(two_bodies + "[[spring]]\nfrom = \"a\"\nto = \"b\"\nfrom_point = [0, 0, 0]\n"
                                 "from_region = [[0, 0, 0, 1, 1, 1]]\n"),
            {"from_point applies to ends without a region"});
  expect_in(refusal("simulation.method = \"paper\"\n" + two_bodies +
                    "[[spring]]\nfrom = \"a\"\nto = \"b\"\n"),
            {"springs between bodies"});
  expect_in(refusal("simulation.contact = \"potential\"\n" + two_bodies +
                    "[[spring]]\nfrom = \"a\"\nto = \"b\"\n"),
            {"x.toml:1:22", "springs between bodies", "\"swept\""});
  expect_in(refusal(two_bodies, {"spring.1.k=2"}), {"there is no spring number '1'"});
  expect_in(refusal("[[spring]]\nfrom = \"a\"\nto = \"b\"\n"), {"at least one [[body]]"});
  // What a body has too belongs to the body.
  expect_in(refusal("k = 3\n[[body]]\n"), {"it belongs in [[body]]"});
}

TEST(JointKeys, ASkinIsGivenPerVertexOrWhateverItsMesh) {
  const Scene scene =
      parse_scene("[[body]]\ndensity = 900\nthickness = 0.002\nstiffness = 300\n", "x.toml");
  EXPECT_EQ(scene.bodies[0].density, 900.0);
  EXPECT_EQ(scene.bodies[0].thickness, 0.002);
  EXPECT_EQ(scene.bodies[0].stiffness, 300.0);
  expect_round_trip(scene);
  const Scene heavy = parse_scene("[[body]]\nmass = 7\n", "x.toml");
  EXPECT_EQ(heavy.bodies[0].skin_mass, 7.0);
  expect_round_trip(heavy);
  const auto body = [](const std::string& keys) { return refusal("[[body]]\n" + keys); };
  expect_in(body("mass = 7\nvertex_mass = 1\n"),
            {"x.toml:3:1", "both vertex_mass and mass (line 2)"});
  expect_in(body("mass = 7\ndensity = 900\n"), {"x.toml:3:1", "both density and mass (line 2)"});
  expect_in(body("density = 900\nvertex_mass = 1\n"),
            {"x.toml:3:1", "both vertex_mass and density (line 2)"});
  expect_in(body("stiffness = 900\nk = 1\n"), {"x.toml:3:1", "both k and stiffness (line 2)"});
  expect_in(body("thickness = 0.1\n"), {"soft bodies with density"});
}

}  // namespace
}  // namespace pneuma::scenes
