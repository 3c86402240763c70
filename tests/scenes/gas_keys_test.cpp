// How much gas: n, gauge_pressure or inflation, one of them.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

TEST(GasKeys, SetTheirMembersAndReadBack) {
  for (const char* body : {"gauge_pressure = -100.0\n", "inflation = 1.25\n"}) {
    const Scene scene = load_body(body, {"simulation.ambient_pressure=101325"});
    EXPECT_EQ(scene.bodies[0].gauge_pressure.value_or(-100.0), -100.0);
    EXPECT_EQ(scene.bodies[0].inflation.value_or(1.25), 1.25);
    EXPECT_NE(scene.bodies[0].gauge_pressure.has_value(), scene.bodies[0].inflation.has_value());
    const std::string text = print_scene(scene);
    EXPECT_EQ(text.find("\nn = "), std::string::npos) << text;
    Scene again = parse_scene(text, "x.toml");
    EXPECT_EQ(difference(again, scene), "");
  }
}

TEST(GasKeys, OneOfThemIsGiven) {
  expect_in(refusal_of_body("n = 1\ngauge_pressure = 5\n"),
            {"x.toml:2:1", "both n and gauge_pressure (line 3) are given; drop one"});
  expect_in(refusal_of_body("inflation = 1.5\nn = 1\n"),
            {"x.toml:3:1", "both n and inflation (line 2)"});
  expect_in(refusal_of_body("inflation = 1.5\ngauge_pressure = 5\n"),
            {"x.toml:2:13", "both inflation and gauge_pressure (line 3)"});
  expect_in(refusal_of_body("name = \"a\"\n", {"a.n=1", "a.inflation=2"}),
            {"--set a.n=1: both n and inflation (--set a.inflation=2)"});
  expect_in(refusal_of_body("kind = \"rigid\"\ninflation = 1.5\n"), {"soft bodies"});
  // An override takes the place of the file's n.
  EXPECT_EQ(load_body("n = 1\n", {"body.inflation=1.5"}).bodies[0].inflation, 1.5);
}

TEST(GasKeys, SayWhatIsAllowed) {
  expect_in(refusal_of_body("gauge_pressure = -5\n"),
            {"x.toml:2:18", "below a vacuum", "at least 0 Pa"});
  expect_in(refusal_of_body("inflation = 0.9\n"), {"inflation >= 1"});
  expect_in(refusal_of_body("inflation = 1.5\nrest = \"equilibrium\"\n"), {"rest = \"shape\""});
  expect_in(refusal_of_body("inflation = 1.5\ntemperature = 0\n"), {"x.toml:3:15", "above 0 K"});
  expect_in(refusal_of_body("gas_exponent = 0.9\n"), {"1 <= gas_exponent <= 10"});
  EXPECT_EQ(refusal_of_body("gas_exponent = 1.4\n", {"simulation.method=corrected"}), "");
  expect_in(refusal_of_body("", {"simulation.method=paper", "body.gas_exponent=1.4"}), {"method"});
}

}  // namespace
}  // namespace pneuma::scenes
