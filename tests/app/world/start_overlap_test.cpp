#include "app/world/start_overlap.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/host/clock.h"
#include "app/world/build_world.h"
#include "app/world/scene_warnings.h"
#include "app/world/touch.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/overlap.h"

namespace pneuma::app {
namespace {

std::string refusal_of(const std::string& text) {
  try {
    const scenes::Scene scene = scenes::parse_scene(text, "x.toml");
    refuse_start_overlap(scene, build_world(scene));
  } catch (const scenes::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(StartOverlap, IsRefusedOfBodiesThatStartInEachOtherOrInTheGround) {
  const std::string ball = "[[body]]\nname = \"ball\"\nposition = [0, 0, 4]\n";
  const std::string rod =
      "[[body]]\nname = \"rod\"\nkind = \"rigid\"\nsize = [20, 0.1, 0.1]\nposition = ";
  const std::string pea = "[[body]]\nname = \"pea\"\nradius = 0.1\nposition = [0, 0, 7]\n";
  const std::string box =
      "[[body]]\nname = \"box\"\nkind = \"rigid\"\nsize = [2, 2, 2]\nposition = ";
  struct Case {
    std::string scene;
    const char* says;
  };
  for (const Case& wrong :
       {Case{ball + rod + "[0, 0, 4]\n", "x.toml:8:12: body 'rod': starts "},
        Case{ball + pea, "x.toml:7:12: body 'pea': starts "},
        Case{box + "[0, 0, 0.9]\n", "body 'box': starts 0.1 m deep in the ground"},
        Case{ball + "[[body]]\nname = \"low\"\nposition = [9, 0, 2]\n",
             "body 'low': starts 1 m deep in the ground"}}) {
    const std::string message = refusal_of(wrong.scene);
    EXPECT_NE(message.find(wrong.says), std::string::npos) << message;
    EXPECT_NE(message.find("simulation.contact = \"impulses\""), std::string::npos) << message;
    EXPECT_EQ(refusal_of("simulation.contact = \"impulses\"\n" + wrong.scene), "");
  }
  EXPECT_NE(refusal_of(ball + rod + "[0, 0, 4]\n").find("in body 'ball'"), std::string::npos);
  // What touches does not overlap.
  EXPECT_EQ(refusal_of(box + "[0, 0, 1]\n" + "copies = [1, 1, 3]\nspacing = [0, 0, 2]\n"), "");
  EXPECT_EQ(refusal_of("[[body]]\nposition = [0, 0, 3]\n"), "");
}

TEST(StartOverlap, WithinAnotherIsNotPartedByImpulses) {
  const std::string pea = "[[body]]\nname = \"pea\"\nradius = 0.1\nposition = ";
  const std::string ball = "[[body]]\nname = \"ball\"\nposition = [0, 0, 4]\n";
  const std::string box = "[[body]]\nname = \"pea\"\nkind = \"rigid\"\nposition = [0, 0, 4]\n";
  for (const std::string& scene :
       {ball + pea + "[0, 0, 4]\n", pea + "[0, 0, 4]\n" + ball, ball + box}) {
    const std::string refusal = refusal_of(scene);
    EXPECT_NE(refusal.find("body 'pea': starts inside of body 'ball'"), std::string::npos)
        << refusal;
    EXPECT_EQ(refusal.find("impulses"), std::string::npos) << refusal;
  }
  const std::string through = refusal_of(ball + pea + "[0, 0, 7]\n");
  EXPECT_NE(through.find("deep in body"), std::string::npos) << through;
  EXPECT_NE(through.find("impulses"), std::string::npos) << through;
}

TEST(StartOverlap, OfBoxesMayBeWhatFourDigitsLeave) {
  const std::string ramp =
      "[[body]]\nkind = \"static\"\nshape = \"box\"\nsize = [4, 4, 0.2]\nrotation = [0, 30, 0]\n"
      "position = [0, 0, 4]\n[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nrotation = [0, 30, 0]\n";
  // 0.6 m from middle to middle, across the ramp.
  EXPECT_EQ(refusal_of(ramp + "position = [0.3, 0, 4.5196]\n"), "");
  EXPECT_EQ(refusal_of(ramp + "position = [0.29999, 0, 4.5196]\n"), "");
  EXPECT_NE(refusal_of(ramp + "position = [0.3, 0, 4.519]\n"), "");
}

TEST(StartOverlap, OfCopiesIsPartedByTheirSpacing) {
  const std::string copies = refusal_of(
      "[[body]]\nname = \"ball\"\nposition = [0, 0, 4]\ncopies = [2, 1, 1]\nspacing = [1, 0, 0]\n");
  EXPECT_NE(copies.find("they are copies: more spacing parts them all"), std::string::npos)
      << copies;
  const std::string tumbling = refusal_of(
      "[[body]]\nkind = \"rigid\"\nposition = [0, 0, 4]\ncopies = [2, 1, 1]\nspacing = [1, 0, 0]\n"
      "jitter = 0.1\ntumble = true\n");
  EXPECT_NE(tumbling.find("copies: more spacing or less jitter, enough for their diagonals as they "
                          "tumble, parts them all"),
            std::string::npos)
      << tumbling;
  const std::string others = refusal_of(
      "[[body]]\nposition = [0, 0, 4]\n[[body]]\nposition = [1, 0, 4]\ncopies = [1, 1, 1]\n");
  EXPECT_NE(others.find("deep in body"), std::string::npos) << others;
  EXPECT_EQ(others.find("copies"), std::string::npos) << others;
}

TEST(StartOverlap, EachIsNamedUpToTen) {
  const std::string boxes =
      "[[body]]\nname = \"box\"\nkind = \"rigid\"\nsize = [2, 2, 2]\nposition = ";
  const std::string two =
      refusal_of(boxes + "[0, 0, 0.9]\n[[body]]\nname = \"ball\"\nposition = [1, 0, 3]\n");
  EXPECT_NE(two.find("x.toml:5:12: body 'box': starts 0.1 m deep in the ground"), std::string::npos)
      << two;
  EXPECT_NE(two.find("in body 'ball'"), std::string::npos) << two;
  const std::string many = refusal_of(boxes + "[0, 0, 0.9]\ncopies = [13, 1, 1]\n");
  EXPECT_NE(many.find("body 'box.10': "), std::string::npos) << many;
  EXPECT_EQ(many.find("body 'box.11': "), std::string::npos) << many;
  EXPECT_NE(many.find("(and 3 more such pairs)"), std::string::npos) << many;
}

TEST(StartOverlap, ThePotentialNeedsADistanceButNotFromTheGround) {
  const std::string potential = "simulation.contact = \"potential\"\n";
  const std::string ball = "[[body]]\nposition = [0, 0, 3]\n";
  const std::string box = "[[body]]\nshape = \"box\"\nname = \"box\"\nposition = ";
  EXPECT_EQ(refusal_of(potential + ball), "");  // it touches z = 0
  EXPECT_NE(refusal_of(potential + "[[body]]\nposition = [0, 0, 2.9]\n"), "");
  EXPECT_EQ(refusal_of(potential + box +
                       "[0, 0, 1]\n[[body]]\nshape = \"box\"\nposition = [2.05, 0, 1]\n"),
            "");
  const std::string touching = refusal_of(potential + box +
                                          "[0, 0, 1]\n[[body]]\nname = \"other\"\nshape = \"box\"\n"
                                          "position = [2, 0, 1]\n");
  EXPECT_NE(touching.find("body 'other': starts 0 m from body 'box'"), std::string::npos)
      << touching;
  EXPECT_NE(touching.find(" m along +x"), std::string::npos) << touching;
  // The upper one is moved, wherever the scene has it, and what is free.
  const std::string below =
      "[0, 0, 3]\n[[body]]\nname = \"low\"\nshape = \"box\"\nposition = [0, 0, 1]\n";
  for (const std::string kind : {"", "kind = \"static\"\n"}) {
    const std::string message = refusal_of(potential + box + below + kind);
    EXPECT_NE(message.find("body 'box': starts 0 m from body 'low'"), std::string::npos) << message;
    EXPECT_NE(message.find(" m along +z"), std::string::npos) << message;
  }
  // What is in another by less than four digits tell would be through it.
  EXPECT_NE(refusal_of(potential + "[[body]]\nkind = \"rigid\"\nposition = [0, 0, 1]\n[[body]]\n"
                                   "kind = \"rigid\"\nposition = [1.99985, 0, 1]\n"),
            "");
}

TEST(SceneWarnings, SayThatThePotentialWouldThrowBodiesApart) {
  const auto warnings = [](const std::string& gap) {
    const scenes::Scene scene = scenes::parse_scene(
        "simulation.contact = \"potential\"\nsimulation.integrator = \"implicit_euler\"\n"
        "[[body]]\nname = \"brick\"\nkind = \"rigid\"\nsize = [2, 2, 1]\nposition = [0, 0, 0.6]\n"
        "copies = [1, 1, 3]\nspacing = [0, 0, 1." +
            gap + "]\n",
        "x.toml");
    return scene_warnings(scene, build_world(scene), {}, {});
  };
  ASSERT_EQ(warnings("001").size(), 1U);
  EXPECT_NE(warnings("001")[0].find("starts 0.001 m from body 'brick.1'"), std::string::npos);
  EXPECT_NE(warnings("001")[0].find("leave that much"), std::string::npos);
  EXPECT_EQ(warnings("2"), std::vector<std::string>());
}

TEST(SceneWarnings, SayWhichIntegratorsDampBouncesOrGainEnergy) {
  const auto warnings = [](const std::string& integrator, const std::string& restitution) {
    const scenes::Scene scene = scenes::parse_scene(
        "simulation.contact = \"potential\"\nsimulation.integrator = \"" + integrator +
            "\"\n[[body]]\nname = \"die\"\nkind = \"rigid\"\nposition = [0, 0, 4]\n"
            "restitution = " +
            restitution + "\n",
        "x.toml");
    return scene_warnings(scene, build_world(scene), {}, {});
  };
  ASSERT_EQ(warnings("implicit_euler", "0.9").size(), 1U);
  EXPECT_NE(warnings("implicit_euler", "0.9")[0].find("body 'die': restitution = 0.9"),
            std::string::npos);
  EXPECT_EQ(warnings("implicit_euler", "0.2"), std::vector<std::string>());
  EXPECT_EQ(warnings("sdirk2", "0.9"), std::vector<std::string>());
  EXPECT_EQ(warnings("velocity_verlet", "0.9"), std::vector<std::string>());
  ASSERT_EQ(warnings("symplectic_euler", "0.2").size(), 1U);
  EXPECT_NE(warnings("symplectic_euler", "0.2")[0].find("may gain energy"), std::string::npos);
}

TEST(SceneWarnings, SayThatImpulsesSeeOnlyTheEndsOfLongSteps) {
  const auto warnings = [](const std::string& contact, const std::string& integrator,
                           const std::string& bodies) {
    const scenes::Scene scene =
        scenes::parse_scene("simulation.contact = \"" + contact + "\"\nsimulation.integrator = \"" +
                                integrator + "\"\n" + bodies,
                            "x.toml");
    return scene_warnings(scene, build_world(scene), {}, {});
  };
  const std::string ball = "[[body]]\nposition = [0, 0, 4]\n",
                    two = ball + "[[body]]\nkind = \"rigid\"\nposition = [0, 0, 9]\n";
  for (const char* integrator : {"implicit_euler", "sdirk2"}) {
    const auto said = warnings("impulses", integrator, two);
    ASSERT_EQ(said.size(), 1U);
    EXPECT_NE(said[0].find("simulation.contact = \"impulses\" may let bodies"), std::string::npos);
    EXPECT_NE(said[0].find(integrator), std::string::npos);
    EXPECT_EQ(warnings("impulses", integrator, ball), std::vector<std::string>());
    EXPECT_EQ(warnings("swept", integrator, two), std::vector<std::string>());
  }
  EXPECT_EQ(warnings("impulses", "rk4", two), std::vector<std::string>());
}

TEST(StartOverlap, NamesAWayThatParts) {
  const std::string ball = "[[body]]\nposition = [0, 0, 4]\n[[body]]\nposition = ";
  const std::string message = refusal_of(ball + "[5, 0, 4]\n");
  EXPECT_NE(message.find("move it 1.01 m along +x"), std::string::npos) << message;
  EXPECT_EQ(refusal_of(ball + "[6.01, 0, 4]\n"), "");
  // Back into the hole of a ring, whose tube it has got into, and not all the way around.
  const std::string ring =
      "[[body]]\nshape = \"torus\"\ntube_radius = 1\nposition = [0, 0, 4]\n"
      "[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = ";
  const std::string back = refusal_of(ring + "[1.8, 0, 4]\n");
  EXPECT_NE(back.find("move it 0.514 m along -x"), std::string::npos) << back;
  EXPECT_EQ(refusal_of(ring + "[1.285, 0, 4]\n"), "");
}

/// What is said is a little more than the way: not even that leads into the ground.
TEST(StartOverlap, NamesAWayToAPlaceAboveTheGround) {
  const auto boxes = [](const char* position, const char* height) {
    return fmt::format(
        "[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = {}\n"
        "[[body]]\nkind = \"static\"\nsize = [1, 1, 1]\nposition = [0.2, 0, {}]\n",
        position, height);
  };
  const std::string message = refusal_of(boxes("[0, 0, 1]", "1.5"));
  EXPECT_NE(message.find("move it 0.801 m along -x"), std::string::npos) << message;
  EXPECT_EQ(refusal_of(boxes("[-0.801, 0, 1]", "1.5")), "");
  // Under a higher one it may go down.
  const std::string higher = refusal_of(boxes("[0, 0, 1]", "1.6"));
  EXPECT_NE(higher.find("move it 0.401 m along -z"), std::string::npos) << higher;
}

TEST(StartOverlap, NamesAWayToAPlaceWhereNothingElseIs) {
  const std::string box = "[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = ";
  const std::string held = "[[body]]\nkind = \"static\"\nsize = [1, 4, 4]\nposition = ";
  const std::string pair = held + "[0, 0, 4]\n" + box + "[0.8, 0, 4]\n";
  const std::string alone = refusal_of(pair);
  EXPECT_NE(alone.find("move it 0.201 m along +x"), std::string::npos) << alone;
  // It would be in this wall by 1 cm; the other side is further, but free.
  const std::string walled = refusal_of(pair + held + "[1.991, 0, 4]\n");
  EXPECT_NE(walled.find("move it 1.81 m along -x"), std::string::npos) << walled;
  // What it comes to touch does not matter.
  const std::string touched = refusal_of(pair + held + "[2.001, 0, 4]\n");
  EXPECT_NE(touched.find("move it 0.201 m along +x"), std::string::npos) << touched;
}

/// The search for a way looks at many places: none of them takes as long as how deep one ball is in
/// the other.
/// A far way to a free place is no use to what lacks a little room where it is.
TEST(StartOverlap, NamesAlsoAShortWayThatOthersBar) {
  const std::string wall = "kind = \"static\"\nsize = [2, 2, 0.5]\nposition = [0, 0, ";
  const std::string message = refusal_of(
      "[[body]]\nname = \"floor\"\n" + wall + "0.25]\n[[body]]\nname = \"lid\"\n" + wall +
      "1.248]\n[[body]]\nname = \"box\"\nkind = \"rigid\"\nsize = [0.5, 0.5, 0.5]\n"
      "position = [0, 0, 0.75]\n");
  EXPECT_NE(message.find("make room for it to move 0.002"), std::string::npos) << message;
  EXPECT_NE(message.find(" m along -z, or move it "), std::string::npos) << message;
}

TEST(StartOverlap, NamesTheWayOutOfABallSoon) {
  const std::string balls =
      "[[body]]\nname = \"outer\"\nshape = \"icosphere\"\nsubdivisions = 3\nradius = 2\n"
      "position = [0, 0, 4]\n"
      "[[body]]\nshape = \"icosphere\"\nsubdivisions = 3\nradius = 1.2\nposition = ";
  const std::string within = balls + "[0, 0, 4]\n";
  const sim::World world = build_world(scenes::parse_scene(within, "x.toml"));
  double before = thread_seconds();
  EXPECT_GT(sim::overlap_depth(world, 0, 1), 1.9);
  const double depth_time = thread_seconds() - before;
  before = thread_seconds();
  const std::string message = refusal_of(within);
  const double refusal_time = thread_seconds() - before;
  EXPECT_NE(message.find("inside of body 'outer'"), std::string::npos) << message;
  EXPECT_NE(message.find("move it 3.21 m along +x"), std::string::npos) << message;
  EXPECT_EQ(refusal_of(balls + "[3.21, 0, 4]\n"), "");
  EXPECT_LT(refusal_time, 4.0 * depth_time);
}

/// A ring that hangs on a bar is lifted off it, and not pulled down until it is below.
TEST(StartOverlap, NamesTheWayToWhereARingHangs) {
  const std::string hung =
      "[[body]]\nname = \"bar\"\nkind = \"static\"\nsize = [6, 0.4, 0.4]\nposition = [0, 0, 5]\n"
      "[[body]]\nshape = \"torus\"\nradius = 1.5\ntube_radius = 0.4\nrotation = [0, 90, 0]\n"
      "position = [0, 0, ";
  const std::string message = refusal_of(hung + "4.0]\n");
  const std::size_t move = message.find("; move it ");
  ASSERT_NE(move, std::string::npos) << message;
  const double way = std::stod(message.substr(move + 10));
  EXPECT_LT(way, 0.25) << message;  // it starts 0.17 m deep
  EXPECT_NE(message.find(" m along +z"), std::string::npos) << message;
  EXPECT_EQ(refusal_of(fmt::format("{}{}]\n", hung, 4.0 + way)), "");
}

TEST(StartOverlap, TellsATouchByWeightFromAnOverlap) {
  const std::string box = "[[body]]\nkind = \"rigid\"\nposition = [0, 0, ";
  const auto deep = [&](const char* height) {
    const std::string text = box + "1]\n" + box + height + "]\n";
    return is_beyond_touch(build_world(scenes::parse_scene(text, "x.toml")), 0, 1);
  };
  EXPECT_FALSE(deep("2.999"));  // 1 mm; g dt^2 is 2.7 mm
  EXPECT_TRUE(deep("2.99"));
}

}  // namespace
}  // namespace pneuma::app
