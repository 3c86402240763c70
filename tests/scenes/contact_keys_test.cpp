// Keys that one of the two forms of contact has, and the other has no use for.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

using Overrides = std::vector<std::string>;

const std::vector<std::string> of_impulses = {"simulation.soft_search=\"exact\"",
                                              "simulation.relaxation_time=0.2",
                                              "simulation.contact_iterations=7"};

std::string scene_with(const std::string& setting, const std::string& contact) {
  return "simulation.contact = \"" + contact + "\"\n" + setting + "\n[[body]]\n";
}

TEST(ContactKeys, OfImpulsesAreRefusedBesideSweptContacts) {
  for (const std::string& setting : of_impulses) {
    const std::string message = refusal(scene_with(setting, "swept"));
    EXPECT_TRUE(message.starts_with("x.toml:2:")) << message;
    EXPECT_NE(message.find(" applies to contact = \"impulses\" only; this is a simulation with "
                           "contact = \"swept\""),
              std::string::npos)
        << message;
    EXPECT_EQ(refusal(scene_with(setting, "impulses")), "");
  }
}

TEST(ContactKeys, OfTheFileAreIdleWithAWarningUnderTheDefault) {
  const bool idle = sim::Settings{}.contact == sim::ContactMethod::swept;
  for (const std::string& setting : of_impulses) {
    const std::string text = setting + "\n[[body]]\n";
    const Scene scene = parse_scene(text, "x.toml");
    ASSERT_EQ(scene.warnings.size(), idle ? 1u : 0u) << setting;
    if (idle) {
      EXPECT_TRUE(scene.warnings[0].starts_with("x.toml:1:")) << scene.warnings[0];
      EXPECT_NE(scene.warnings[0].find("has no effect"), std::string::npos) << scene.warnings[0];
    }
    const Overrides impulses = {"simulation.contact=impulses"};
    const Scene chosen = parse_scene(text, "x.toml", impulses);
    EXPECT_TRUE(chosen.warnings.empty());
    EXPECT_EQ(difference(chosen, parse_scene(scene_with(setting, "impulses"), "x.toml")), "");
  }
}

TEST(ContactKeys, OfTheFileGiveWayToAnOverrideOfTheContact) {
  for (const std::string& setting : of_impulses) {
    const std::string impulses = scene_with(setting, "impulses");
    const Scene swept = parse_scene(impulses, "x.toml", Overrides{"simulation.contact=swept"});
    EXPECT_EQ(difference(swept, parse_scene(scene_with("", "swept"), "x.toml")), "") << setting;
  }
}

TEST(ContactKeys, OfAnOverrideAreRefusedBesideOneOfTheContact) {
  for (const std::string& setting : of_impulses) {
    const std::string message =
        refusal("[[body]]\n", Overrides{"simulation.contact=swept", setting});
    EXPECT_TRUE(message.starts_with("--set " + setting + ": ")) << message;
  }
}

TEST(ContactKeys, BesideThePapersMethodItIsWhatRefusesThem) {
  for (const std::string& setting : of_impulses) {
    const std::string message =
        refusal("simulation.method = \"paper\"\n" + setting + "\n[[body]]\n");
    EXPECT_NE(message.find("simulation.method = \"paper\" sets it"), std::string::npos) << message;
  }
}

TEST(ContactKeys, OfSweptContactsAreRefusedBesideImpulses) {
  const std::string setting = "simulation.sleep_speed=0.02";
  EXPECT_EQ(parse_scene(scene_with(setting, "swept"), "x.toml").settings.sleep_speed, 0.02);
  const std::string message = refusal(scene_with(setting, "impulses"));
  EXPECT_TRUE(message.starts_with("x.toml:2:")) << message;
  EXPECT_NE(message.find(" applies to contact = \"swept\" only"), std::string::npos) << message;
  EXPECT_NE(refusal("[[body]]\n", {"simulation.sleep_speed=-1"}), "");
}

const std::vector<std::string> of_potential = {"simulation.potential.distance=0.03",
                                               "simulation.potential.stiffness=500.0",
                                               "simulation.potential.regularisation_speed=0.1"};

TEST(ContactKeys, OfThePotentialAreRefusedBesideOtherForms) {
  for (const std::string& setting : of_potential) {
    EXPECT_EQ(refusal(scene_with(setting, "potential")), "");
    for (const char* contact : {"swept", "impulses"}) {
      const std::string message = refusal(scene_with(setting, contact));
      EXPECT_TRUE(message.starts_with("x.toml:2:")) << message;
      EXPECT_NE(message.find(" applies to contact = \"potential\" only"), std::string::npos)
          << message;
    }
  }
  const Scene scene = parse_scene(scene_with(of_potential[1], "potential"), "x.toml");
  EXPECT_EQ(scene.settings.potential.stiffness, 500.0);
  EXPECT_FALSE(parse_scene("[[body]]\n", "x.toml").settings.potential.stiffness);
  for (const char* bad : {"simulation.potential.distance=0", "simulation.potential.stiffness=-1",
                          "simulation.potential.regularisation_speed=0"}) {
    EXPECT_NE(refusal(scene_with(bad, "potential")), "") << bad;
  }
}

TEST(ContactKeys, OfOtherFormsAreRefusedBesideThePotential) {
  std::vector<std::string> others = of_impulses;
  others.push_back("simulation.sleep_speed=0.02");
  others.push_back("simulation.skin_thickness=0.02");
  for (const std::string& setting : others) {
    const std::string message = refusal(scene_with(setting, "potential"));
    EXPECT_TRUE(message.starts_with("x.toml:2:")) << message;
    EXPECT_NE(message.find("this is a simulation with contact = \"potential\""), std::string::npos)
        << message;
  }
}

TEST(ContactKeys, WhatThePotentialCannotStepIsRefusedWithWhatToDo) {
  const std::string start = "simulation.contact = \"potential\"\n[[body]]\n";
  EXPECT_EQ(refusal(start + "kind = \"rigid\"\n"), "");
  const std::string literal = refusal(start + "damping = \"literal\"\n");
  EXPECT_NE(literal.find("use damping = \"dashpot\""), std::string::npos) << literal;
  EXPECT_EQ(refusal(start + "kind = \"static\"\n"), "");
  EXPECT_EQ(refusal(start + "pinned = [[-9, -9, -9, 9, 9, 0]]\n"), "");
}

TEST(ContactKeys, AreNotPrintedWhereTheyDoNotApply) {
  const std::string swept = print_scene(parse_scene(scene_with("", "swept"), "x.toml"));
  for (const char* key : {"soft_search", "relaxation_time", "contact_iterations"}) {
    EXPECT_EQ(swept.find(key), std::string::npos) << key;
  }
  const std::string impulses = print_scene(parse_scene(scene_with("", "impulses"), "x.toml"));
  EXPECT_NE(swept.find("sleep_speed"), std::string::npos);
  EXPECT_EQ(impulses.find("sleep_speed"), std::string::npos);
  const std::string potential = print_scene(parse_scene(scene_with("", "potential"), "x.toml"));
  EXPECT_NE(potential.find("regularisation_speed"), std::string::npos);
  EXPECT_EQ(potential.find("skin_thickness"), std::string::npos);
  EXPECT_EQ(swept.find("regularisation_speed"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::scenes
