// What a run that diverges says of the step.
#include "app/world/simulation.h"

#include <gtest/gtest.h>

#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using sim::ContactMethod;
using sim::Stage;

std::string message(ContactMethod contact, Stage stage) {
  sim::World world;
  world.settings.contact = contact;
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 3.0}));
  world.soft[0].name = "ball";
  return divergence_error("scene", {stage, 7, "ball", "it broke"}, world).what();
}

TEST(DivergenceError, NamesAStableStepUnlessShorterOnesHaveFailed) {
  for (const ContactMethod contact : {ContactMethod::impulses, ContactMethod::swept}) {
    for (const Stage stage : {Stage::integrate_soft, Stage::resolve_contacts}) {
      const std::string text = message(contact, stage);
      EXPECT_NE(text.find("body ball: it broke"), std::string::npos) << text;
      const bool halved = contact == ContactMethod::swept && stage == Stage::resolve_contacts;
      EXPECT_EQ(text.find("Use a step of ") == std::string::npos, halved) << text;
    }
  }
}

}  // namespace
}  // namespace pneuma::app
