// simulation.method = "paper" sets keys, and refuses them beside it.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "scenes/loader/sections.h"
#include "sim/world/paper_method.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

const std::string plain =
    "[simulation]\nmethod = \"paper\"\n[[body]]\n[[body]]\nkind = \"rigid\"\n";
const std::string with_choices = R"(
[simulation]
integrator = "velocity_verlet"
skin_thickness = 0.03
particles.per_vertex = 0.5
[[body]]
damping = "dashpot"
)";

Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "x.toml", overrides);
}

void expect_the_papers(const Scene& scene) {
  EXPECT_EQ(scene.settings.method, sim::Method::paper);
  EXPECT_EQ(scene.settings.integrator, sim::Integrator::martin);
  EXPECT_EQ(scene.settings.contact, sim::ContactMethod::impulses);
  EXPECT_EQ(scene.settings.skin_thickness, 0.5);
  EXPECT_EQ(scene.settings.soft_search, sim::SoftSearch::particles);
  EXPECT_EQ(scene.settings.particles.per_vertex, 0.125);
  EXPECT_EQ(scene.settings.relaxation_time, 0.0);
  EXPECT_EQ(scene.settings.contact_iterations, 1);
  EXPECT_EQ(scene.settings.sleep_speed, 0.0);
  EXPECT_EQ(scene.bodies[0].material.pressure_weighting, sim::PressureWeighting::valence);
  EXPECT_EQ(scene.bodies[0].material.damping, sim::Damping::literal);
}

TEST(Method, OfTheFileOrOfAnOverrideSetsThePapersChoices) {
  expect_the_papers(parse(plain));
  expect_the_papers(parse("[[body]]\n", {"simulation.method=paper"}));
  EXPECT_EQ(parse("[[body]]\n").settings.method, sim::Method::corrected);
}

TEST(Method, OfAnOverrideTakesTheFilesKeysBack) {
  expect_the_papers(parse(with_choices, {"simulation.method=paper"}));
}

TEST(Method, RefusesAnOverrideOfWhatItSets) {
  for (const char* key : {"simulation.integrator=rk4", "simulation.particles.per_vertex=0.5",
                          "body.damping=literal", "body.1.damping=dashpot"}) {
    for (const auto& overrides : {std::vector<std::string>{"simulation.method=paper", key},
                                  std::vector<std::string>{key, "simulation.method=paper"}}) {
      const std::string message = refusal("[[body]]\n", overrides);
      EXPECT_EQ(message.rfind(std::string("--set ") + key + ": ", 0), 0u) << message;
      EXPECT_NE(message.find("simulation.method = \"paper\" sets it"), std::string::npos)
          << message;
    }
    EXPECT_FALSE(refusal(plain, {key}).empty()) << key;
  }
}

TEST(Method, ReportsEachRefusedKeyAtItsPlace) {
  const std::string message = refusal(
      "[simulation]\nmethod = \"paper\"\nskin_thickness = 0.5\n"
      "contact_iterations = 9\n[[body]]\n");
  EXPECT_NE(message.find("x.toml:3:18: skin_thickness = 0.5"), std::string::npos) << message;
  EXPECT_NE(message.find("x.toml:4:22: contact_iterations = 9"), std::string::npos) << message;
  EXPECT_NE(message.find("to 1;"), std::string::npos) << message;
}

TEST(Method, AWrongValueIsReportedOnce) {
  const std::string message =
      refusal("[simulation]\nmethod = \"paper\"\nintegrator = \"euler\"\n[[body]]\n");
  EXPECT_EQ(message.find("sets it"), std::string::npos) << message;
}

TEST(Method, OfAnOverrideCanBeCorrectedInAPaperScene) {
  const Scene scene = parse(plain, {"simulation.method=corrected", "simulation.integrator=rk4"});
  EXPECT_EQ(difference(scene, parse("[[body]]\n[[body]]\nkind = \"rigid\"\n")), "");
}

TEST(Method, PrintsWhatItSetsAsComments) {
  const Scene scene = parse(with_choices, {"simulation.method=paper"});
  const std::string text = print_scene(scene);
  EXPECT_NE(text.find("\nmethod = \"paper\""), std::string::npos) << text;
  EXPECT_NE(text.find("\n# by method: integrator = \"martin\""), std::string::npos) << text;
  EXPECT_NE(text.find("\n# by method: damping = \"literal\""), std::string::npos) << text;
  EXPECT_EQ(difference(parse(text), scene), "");
}

/// Every key whose value the method changes is one that it refuses.
TEST(Method, SetsNoKeyThatItDoesNotRefuse) {
  Scene scene = parse("simulation.contact = \"impulses\"\n[[body]]\n");
  Scene set = scene;
  set.settings.relaxation_time = 3.0;
  sim::use_paper_method(set.settings);
  sim::use_paper_method(set.bodies[0].material);
  std::vector<Section> before = fixed_sections(scene), after = fixed_sections(set);
  before.push_back(body_section(scene.bodies[0]));
  after.push_back(body_section(set.bodies[0]));
  int changed = 0;
  for (std::size_t s = 0; s < before.size(); ++s) {
    for (std::size_t k = 0; k < before[s].keys.size(); ++k) {
      const Key& key = before[s].keys[k];
      if (value_text(key.slot) == value_text(after[s].keys[k].slot)) continue;
      ++changed;
      EXPECT_TRUE(key.of_method || key.name == "method") << key.name;
    }
  }
  EXPECT_EQ(changed, 7);  // method, integrator, relaxation, iterations, sleep, weighting, damping
}

}  // namespace
}  // namespace pneuma::scenes
