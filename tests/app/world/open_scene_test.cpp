// A model where a scene is expected: it falls, and rests looking like itself.
#include "app/world/open_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/check/run_statistics.h"
#include "app/files/find_model.h"
#include "app/host/errors.h"
#include "app/record/shape_deviation.h"
#include "app/world/build_world.h"
#include "app/world/model_scene.h"
#include "app/world/settled_volume.h"
#include "assets/model.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

class OpenScene : public testing::Test {
 protected:
  scenes::Scene open(const sim::TriangleMesh& mesh,
                     const std::vector<std::string>& overrides = {}) {
    write_text(file(), assets::obj_text(mesh));
    return open_scene(file().string(), overrides);
  }
  std::filesystem::path file() const { return folder_ / "it.obj"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(OpenScene, AModelFallsAndRestsAtThePredictedVolume) {
  for (const sim::TriangleMesh& mesh :
       {sim::make_torus(50.0, 20.0, 10, 12), sim::make_box({0.1, 0.2, 0.3}, 4)}) {
    const scenes::Scene scene = open(mesh);
    sim::World world = build_world(scene);
    const double predicted = settled_volume(world.soft.at(0)).value();
    EXPECT_NEAR(predicted / volume_of(world.soft[0]), 1.0, 0.15);
    EXPECT_NEAR(sim::bounds(world).size().maxCoeff(), 6.0, 1e-4);
    EXPECT_NEAR(sim::bounds(world).low.z(), 1.0, 1e-4);
    const auto divergence = sim::run(world, 3.0);
    ASSERT_FALSE(divergence) << divergence->what;
    EXPECT_NEAR(volume_of(world.soft[0]) / predicted, 1.0, 0.1);
    EXPECT_LT(sim::bounds(world).low.z(), 0.2);  // it may still bounce
  }
}

double fastest_vertex(const sim::SoftBody& body) {
  return std::sqrt(body.velocities.rows().colwise().squaredNorm().maxCoeff());
}

/// A ball that lands on its pole stands there until something tips it.
TEST_F(OpenScene, AModelFallsAsInAirAndARoundOneComesToRest) {
  const scenes::Scene scene = open(sim::make_sphere(1.0, 10, 9));
  sim::World world = build_world(scene);
  ASSERT_FALSE(sim::run(world, 0.4));
  EXPECT_LT(sim::mean(world.soft[0].velocities).z(), -0.7 * 9.81 * 0.4);
  ASSERT_FALSE(sim::run(world, scene.duration - 0.4));
  EXPECT_LT(fastest_vertex(world.soft[0]), rest_speed);
}

/// A sheet without hinges folds up until its gas is far stiffer than in its shape.
TEST_F(OpenScene, AThinCoarseModelGetsShorterSteps) {
  for (const char* turn : {"[1, 0.7, 0]", "[2, 1, 0]", "[2, 3, 0]", "[3, 2, 0]", "[30, 20, 0]"}) {
    sim::World world = build_world(
        open(sim::make_box({6.0, 6.0, 0.0027}, 1), {std::string("body.angular_velocity=") + turn}));
    const auto divergence = sim::run(world, 1.0);
    EXPECT_FALSE(divergence) << turn << ": " << divergence->what;
  }
}

TEST_F(OpenScene, BendingStiffnessHoldsFlatFaces) {
  const auto deviation = [&](const std::vector<std::string>& overrides) {
    sim::World world = build_world(open(sim::make_box({6.0, 6.0, 0.6}, 6), overrides));
    EXPECT_FALSE(sim::run(world, 3.0));
    return shape_deviation(world.soft.at(0));
  };
  // Gas bends the two large faces outwards by twice this together, unless something holds them.
  EXPECT_GT(deviation({"body.bending=0"}), 0.04);
  EXPECT_LT(deviation({}), 0.02);
}

/// Faces of many triangles crumple like paper without it.
TEST_F(OpenScene, AFineModelHasBendingStiffnessToo) {
  EXPECT_GT(open(sim::make_box({1.0, 1.0, 1.0}, 60)).bodies.at(0).material.bending, 0.01);
}

TEST_F(OpenScene, ItsTextIsAFileToKeep) {
  const scenes::Scene scene = open(assets::cube(), {"body.k=900"});
  EXPECT_EQ(scene.bodies[0].material.k, 900.0);
  EXPECT_EQ(scene.name, "it");
  const scenes::Scene plain = scenes::parse_scene(model_scene_text(file()), "it.toml");
  EXPECT_EQ(plain.bodies[0].material.k, 4000.0);
  const scenes::Scene again = scenes::parse_scene(scenes::print_scene(scene), "it.toml");
  EXPECT_EQ(scenes::scene_fingerprint(again), scenes::scene_fingerprint(scene));
}

TEST_F(OpenScene, ABodyIsCalledAsItsFile) {
  const std::string ball = assets::ply_text(sim::make_icosphere(1.0, 1));
  for (const auto& [stem, name] :
       {std::pair{"duck-2", "duck-2"}, std::pair{"my duck (2)", "my_duck__2_"},
        std::pair{"2", "model_2"}, std::pair{"camera", "model_camera"}}) {
    const std::filesystem::path path = file().parent_path() / (std::string(stem) + ".ply");
    write_text(path, ball);
    const scenes::Scene scene = open_scene(path.string(), {});
    EXPECT_EQ(scene.bodies.at(0).name, name);
    EXPECT_EQ(scene.title, std::string(name) + " falls");
  }
}

TEST_F(OpenScene, ADaeStandsAsItSays) {
  const std::string dae = assets::dae_text(sim::make_box({3.0, 6.0, 1.0}, 2));
  const std::string z_up = "<up_axis>Z_UP</up_axis>";
  const std::filesystem::path path = file().parent_path() / "slab.dae";
  for (const auto& [up, height] :
       {std::pair{"<up_axis> X_UP </up_axis>", 3.0}, std::pair{"<up_axis>Y_UP</up_axis>", 6.0},
        std::pair{z_up.c_str(), 1.0}, std::pair{"", 6.0}}) {
    std::string text = dae;
    write_text(path, text.replace(text.find(z_up), z_up.size(), up));
    const sim::World world = build_world(open_scene(path.string(), {}));
    EXPECT_NEAR(sim::bounds(world).size().z(), height, 1e-6) << up;
  }
}

TEST_F(OpenScene, AModelThatDoesNotSayItsUpwardAxisGetsANote) {
  const sim::TriangleMesh slab = sim::make_box({3.0, 6.0, 1.0}, 2);
  const scenes::Scene plain = open(slab);
  ASSERT_EQ(plain.warnings.size(), 1u);
  EXPECT_NE(plain.warnings[0].find("it.obj: z is taken to point upwards; --up y"),
            std::string::npos)
      << plain.warnings[0];
  EXPECT_TRUE(open(slab, {"body.model.rotation=[90, 0, 0]"}).warnings.empty());
  EXPECT_TRUE(open_scene(file().string(), {}, {.rotation = rotation_of_up("z")}).warnings.empty());
}

TEST_F(OpenScene, AModelThatIsTurnedStandsAboveTheGround) {
  const auto lowest = [&](const scenes::Scene& scene) {
    const auto size = sim::bounds(build_world(scene).soft.at(0).positions);
    return std::pair(size.low.z(), size.size().z());
  };
  const sim::TriangleMesh slab = sim::make_box({3.0, 6.0, 1.0}, 2);
  EXPECT_NEAR(lowest(open(slab)).second, 1.0, 1e-9);
  for (const auto& [up, height] : {std::pair{"x", 3.0}, std::pair{"y", 6.0}, std::pair{"z", 1.0}}) {
    const auto [low, size] =
        lowest(open_scene(file().string(), {}, {.rotation = rotation_of_up(up)}));
    EXPECT_NEAR(size, height, 1e-9) << up;
    EXPECT_NEAR(low, 1.0, 1e-9) << up;  // the drop
  }
  for (const char* override : {"body.model.rotation=[90, 0, 0]", "it.model.rotation = [90,0,0]"}) {
    const auto [low, size] = lowest(open(slab, {override}));
    EXPECT_NEAR(size, 6.0, 1e-9) << override;
    EXPECT_NEAR(low, 1.0, 1e-9) << override;
  }
}

TEST_F(OpenScene, RepairsAModelAndSaysSoInItsText) {
  sim::TriangleMesh box = sim::make_box({1.0, 1.0, 1.0}, 3);
  const double volume = 1.0;
  box.triangles.pop_back();
  EXPECT_THROW(open(box), assets::ModelError);
  const std::string text = model_scene_text(file(), {.repair = true});
  EXPECT_NE(text.find("\n# Repaired: 1 hole filled by 1 triangle: vertex "), std::string::npos);
  const scenes::Scene scene = scenes::parse_scene(text, "kept.toml");
  EXPECT_TRUE(scene.bodies.at(0).model.repair);
  const sim::World world = build_world(scene);
  EXPECT_NEAR(volume_of(world.soft.at(0)), 6.0 * 6.0 * 6.0 * volume, 1e-3);
}

/// More vertices than most_chosen_vertices.
sim::TriangleMesh fine_ball() { return sim::make_icosphere(1.0, 5); }

int vertices_of(const scenes::Scene& scene) {
  return build_world(scene).soft.at(0).mesh->topology.vertex_count();
}

// The text that is kept has the key, and makes the same body as the run has.
TEST_F(OpenScene, SimplifiesALargeModelAndSaysSo) {
  const scenes::Scene scene = open(fine_ball());
  EXPECT_EQ(scene.bodies.at(0).model.vertices, most_chosen_vertices);
  EXPECT_NE(scene.warnings.back().find(
                fmt::format("simplified to {} vertices; --vertices", most_chosen_vertices)),
            std::string::npos)
      << scene.warnings.back();
  const sim::World world = build_world(scene);
  EXPECT_EQ(world.soft.at(0).mesh->topology.vertex_count(), most_chosen_vertices);
  const scenes::Scene again = scenes::parse_scene(scenes::print_scene(scene), "it.toml");
  EXPECT_EQ(model_fingerprints(again, build_world(again)), model_fingerprints(scene, world));
  EXPECT_EQ(scenes::scene_fingerprint(again), scenes::scene_fingerprint(scene));
}

// Steps and masses are of the mesh that there is.
TEST_F(OpenScene, AModelHasAsManyVerticesAsAskedFor) {
  const scenes::Scene coarse = open(sim::make_icosphere(1.0, 3), {"body.model.vertices=300"});
  EXPECT_EQ(vertices_of(coarse), 300);
  EXPECT_NEAR(300 * coarse.bodies.at(0).material.vertex_mass, 5.0, 1e-9);
  const scenes::Scene by_option = open_scene(file().string(), {}, {.vertices = 300});
  EXPECT_EQ(scenes::scene_fingerprint(by_option), scenes::scene_fingerprint(coarse));
  const scenes::Scene whole = open(sim::make_icosphere(1.0, 3));
  EXPECT_FALSE(whole.bodies.at(0).model.vertices);
  EXPECT_EQ(vertices_of(whole), 642);
}

/// Of what is left, and also where there is no scene yet.
TEST_F(OpenScene, ALimitHoldsOnceAModelIsSimplified) {
  const sim::TriangleMesh fine = sim::make_icosphere(1.0, 4);  // 2562 vertices
  const std::vector<std::string> few = {"limits.vertices_per_body=1000"};
  const auto refused = [&](const std::vector<std::string>& overrides) {
    try {
      open(fine, overrides);
    } catch (const assets::ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused(few).find("2562 vertices are more than the limit of 1000; simplify the model"),
            std::string::npos)
      << refused(few);
  const scenes::Scene scene = open_scene(file().string(), few, {.vertices = 300});
  EXPECT_LE(build_world(scene).soft[0].positions.size(), 300);
  EXPECT_NE(refused({"limits.model_file_mib=0.01"}).find("raise model_file_mib in [limits]"),
            std::string::npos);
}

TEST_F(OpenScene, TakesOneComponentOfSeveral) {
  const sim::TriangleMesh two = assets::both(
      assets::cube(), assets::moved(sim::make_box({2.0, 1.0, 1.0}, 2), {9.0, 0.0, 0.0}));
  EXPECT_THROW(open(two), assets::ModelError);
  for (const auto& [component, volume] : {std::pair{"1", 216.0}, std::pair{"2", 54.0}}) {
    const scenes::Scene scene = open_scene(file().string(), {}, {.component = component});
    EXPECT_EQ(scene.bodies.at(0).model.component, component);
    EXPECT_NEAR(volume_of(build_world(scene).soft.at(0)), volume, 1e-3);
  }
}

TEST(OpenAScene, ThatIsNoModelRefusesAModelsOptions) {
  EXPECT_THROW(open_scene("one_sphere", {}, {.repair = true}), UsageError);
  EXPECT_THROW(open_scene("one_sphere", {}, {.component = "1"}), UsageError);
  EXPECT_THROW(open_scene("one_sphere", {}, {.rotation = rotation_of_up("y")}), UsageError);
  EXPECT_THROW(open_scene("one_sphere", {}, {.vertices = 300}), UsageError);
}

/// A scene file of its own for each.
class OpenSceneFile : public testing::Test {
 protected:
  scenes::Scene open(const std::string& text) {
    write_text(folder_ / "it.toml", text);
    return open_scene((folder_ / "it.toml").string(), {});
  }

 private:
  TemporaryFolder folder_;
};

const std::string stiff_body = "[[body]]\nname = \"ball\"\nposition = [0, 0, 4]\nk = 50000\n";

TEST_F(OpenSceneFile, WithoutAStepHasOneThatItsBodiesBear) {
  const scenes::Scene scene = open("duration = 1\n" + stiff_body);
  EXPECT_GT(scene.settings.steps_per_second, 60);
  EXPECT_EQ(scene.settings.steps_per_second % 60, 0);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find(fmt::format(
                "it.toml:2:1: note: body 'ball': {} steps per second in place of 60, because small "
                "motions are stable up to ",
                scene.settings.steps_per_second)),
            std::string::npos)
      << scene.warnings[0];
  sim::World world = build_world(scene);
  const auto divergence = sim::run(world, 1.0);
  EXPECT_FALSE(divergence) << divergence->what;
}

TEST_F(OpenSceneFile, KeepsAStepThatItNamesOrThatSuffices) {
  const scenes::Scene named = open("[simulation]\nsteps_per_second = 60\n" + stiff_body);
  EXPECT_EQ(named.settings.steps_per_second, 60);
  EXPECT_TRUE(named.warnings.empty());
  const scenes::Scene soft = open("[[body]]\nposition = [0, 0, 4]\nk = 50\n");
  EXPECT_EQ(soft.settings.steps_per_second, 60);
  EXPECT_TRUE(soft.warnings.empty());
}

TEST_F(OpenSceneFile, SaysThatDampingByTheStepIsMoreInShorterSteps) {
  const std::string literal = "[[body]]\nposition = [0, 0, 4]\ndamping = \"literal\"\n";
  const auto steps = [](int n) { return fmt::format("[simulation]\nsteps_per_second = {}\n", n); };
  EXPECT_TRUE(open(steps(60) + literal).warnings.empty());
  EXPECT_TRUE(open(steps(240) + "[[body]]\nposition = [0, 0, 4]\n").warnings.empty());
  const scenes::Scene scene = open(steps(240) + literal);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("note: damping = \"literal\" acts once in every step, at 240 "
                                   "steps per second 4 times as often"),
            std::string::npos)
      << scene.warnings[0];
  const scenes::Scene paper =
      open(steps(240) + "method = \"paper\"\n[[body]]\nposition = [0, 0, 4]\n");
  ASSERT_EQ(paper.warnings.size(), 1u);
  EXPECT_NE(paper.warnings[0].find("the damping of simulation.method = \"paper\" acts once"),
            std::string::npos)
      << paper.warnings[0];
}

TEST_F(OpenSceneFile, KeepsAwayFromTheLimitWhereBodiesMayMeet) {
  const std::string ball = "[[body]]\nname = \"ball\"\nposition = [0, 0, 4]\nk = 250\n";
  EXPECT_EQ(open(ball).settings.steps_per_second, 60);
  const scenes::Scene two =
      open(ball + "[[body]]\nkind = \"rigid\"\nmass = 1\nposition = [9, 0, 4]\n");
  EXPECT_EQ(two.settings.steps_per_second, 120);
  ASSERT_FALSE(two.warnings.empty());
  EXPECT_NE(two.warnings.back().find("come too near that"), std::string::npos)
      << two.warnings.back();
}

TEST_F(OpenSceneFile, TakesTheShortestStepOfItsBodies) {
  const scenes::Scene one = open(stiff_body);
  const scenes::Scene two = open(stiff_body + "[[body]]\nposition = [9, 0, 4]\nk = 500000\n");
  EXPECT_GT(two.settings.steps_per_second, one.settings.steps_per_second);
}

/// A ball that stands, and a bat that hits it at even speed and then stops.
std::string hit_ball(double speed) {
  return fmt::format(
      "duration = 0.3\n[[body]]\nname = \"ball\"\nshape = \"icosphere\"\nsubdivisions = 2\n"
      "radius = 0.6\nrest = \"equilibrium\"\ngauge_pressure = 50\nmass = 0.36\n"
      "position = [0, 0, 1.01]\n"
      "[[body]]\nname = \"bat\"\nkind = \"moved\"\nsize = [0.3, 2, 2]\nposition = [-2, 0, 1.2]\n"
      "motion.smooth = false\nmotion.path = [[0, 0, 0, 0], [{}, 2, 0, 0], [10, 2, 0, 0]]\n",
      2.0 / speed);
}

TEST_F(OpenSceneFile, TakesShorterStepsWhereWhatIsMovedIsFastBesideASoftBody) {
  const int slow = open(hit_ball(5.0)).settings.steps_per_second;
  const scenes::Scene fast = open(hit_ball(30.0));
  // 30 m/s over a tenth of 1.2 m; also a multiple of what small motions need.
  EXPECT_GE(fast.settings.steps_per_second, 250);
  EXPECT_LT(fast.settings.steps_per_second, 250 + slow);
  EXPECT_EQ(fast.settings.steps_per_second % slow, 0);
  ASSERT_EQ(fast.warnings.size(), 1u);
  EXPECT_NE(fast.warnings[0].find(fmt::format(
                "it.toml:11:1: note: body 'bat': {} steps per second in place of 60, because it is "
                "moved at up to 30 m/s, and body 'ball' is 1.2 m wide; ",
                fast.settings.steps_per_second)),
            std::string::npos)
      << fast.warnings[0];
  EXPECT_LT(open(hit_ball(1e5)).settings.steps_per_second, 2'000 + slow);
  // What is turned is as fast as its far end. After the run, nothing moves.
  const std::string ball = hit_ball(5.0).substr(0, hit_ball(5.0).rfind("motion.path"));
  const auto steps = [&](const std::string& keys) {
    return open(ball + keys).settings.steps_per_second;
  };
  EXPECT_GE(steps("motion.rotation = [[0, 0, 0, 0], [1, 0, 0, 3600]]\n"), 62.8 / 0.12);
  EXPECT_EQ(steps("motion.path = [[0, 0, 0, 0], [0.4, 0, 0, 0], [0.41, 5, 0, 0]]\n"), slow);
  // What gathers speed has 6 * 0.1 * 0.9 * 450 / 3 = 81 m/s when the run ends, far from its key.
  const std::string still = hit_ball(5.0).substr(0, hit_ball(5.0).rfind("motion.smooth"));
  const scenes::Scene smooth = open(still + "motion.path = [[0, 0, 0, 0], [3, 450, 0, 0]]\n");
  EXPECT_GE(smooth.settings.steps_per_second, 81.0 / 0.12);
}

TEST_F(OpenSceneFile, ABallThatIsHitFastFliesOffAsInMuchShorterSteps) {
  const auto speed = [&](const std::string& text) {
    sim::World world = build_world(open(text));
    const auto divergence = sim::run(world, 3.5 / 40.0);
    EXPECT_FALSE(divergence) << divergence->what;
    return sim::mean(world.soft.at(0).velocities).x();
  };
  const auto by_steps = [&](int steps) {
    return speed(fmt::format("simulation.steps_per_second = {}\n{}", steps, hit_ball(40.0)));
  };
  const double fine = by_steps(2'880);
  EXPECT_NEAR(speed(hit_ball(40.0)), fine, 0.03 * fine);
  EXPECT_LT(by_steps(180), 0.93 * fine);  // those that small motions need
}

TEST_F(OpenSceneFile, KeepsTheStepWhereWhatIsMovedMeetsBoxesOnly) {
  const std::string bat = hit_ball(30.0).substr(hit_ball(30.0).rfind("[[body]]"));
  const scenes::Scene scene = open(bat + "[[body]]\nkind = \"rigid\"\nposition = [0, 0, 1]\n");
  EXPECT_EQ(scene.settings.steps_per_second, 60);
}

TEST_F(OpenSceneFile, SaysAllErrorsAtOnceAlsoThoseOfModels) {
  const auto errors = [&](const std::string& text) -> std::vector<int> {
    try {
      open(text);
    } catch (const scenes::SceneError& error) {
      std::vector<int> lines;
      for (const scenes::Diagnostic& at : error.diagnostics()) lines.push_back(at.line);
      return lines;
    }
    return {};
  };
  const std::string models =
      "[[body]]\nshape = \"model\"\nmodel.file = \"none.obj\"\n"
      "[[body]]\nshape = \"model\"\nmodel.file = \"it.toml.obj\"\n"
      "[[body]]\nposition = [0, 0, 99]\npinned = [[0, 0, 0, 1, 1, 1], [1, 1, 1, 2, 2, 2]]\n";
  EXPECT_EQ(errors(models), (std::vector<int>{3, 6, 9, 9}));
  EXPECT_EQ(errors("titel = 1\n" + models + "[[valve]]\nfrom = \"a\"\nto = \"b\"\n"),
            (std::vector<int>{1, 4, 7, 12, 13}));
  // A model of several bodies is one error, and so is what its refused keys would make of it.
  EXPECT_EQ(errors("[[body]]\nshape = \"model\"\nmodel.file = \"none.obj\"\n"
                   "[[body]]\nshape = \"model\"\nmodel.file = \"none.obj\"\n"),
            (std::vector<int>{3}));
  EXPECT_EQ(errors("[[body]]\nshape = \"model\"\nmodel.file = \"none.obj\"\n"
                   "model.scale = -1\n"),
            (std::vector<int>{4}));
}

TEST(ModelNameFrom, IsShortWhereTheModelIsNear) {
  const TemporaryFolder folder;
  const std::filesystem::path scene = folder.path() / "run" / "out" / "cat";
  const auto name = [&](const std::filesystem::path& model) {
    return model_name_from(scene, model);
  };
  EXPECT_EQ(name(scene / "cat.ply"), "cat.ply");
  EXPECT_EQ(name(scene / "models" / "cat.ply"), "models/cat.ply");
  EXPECT_EQ(name(folder.path() / "run" / "cat.ply"), "../../cat.ply");
  EXPECT_EQ(name(folder.path() / "cat.ply"), (folder.path() / "cat.ply").string());
  EXPECT_EQ(name("/usr/share/cat.ply"), "/usr/share/cat.ply");
  EXPECT_EQ(model_name_from(scene / "", scene / "cat.ply"), "cat.ply");
  EXPECT_EQ(model_name_from("/pneuma-none", "/usr/cat.ply"), "/usr/cat.ply");
}

TEST(ModelNameFrom, FollowsLinks) {
  const TemporaryFolder folder;
  const std::filesystem::path far = folder.path() / "a" / "b" / "c", link = folder.path() / "out";
  std::filesystem::create_directories(far);
  std::filesystem::create_directory_symlink(far, link);
  EXPECT_EQ(model_name_from(link, folder.path() / "a" / "cat.ply"), "../../cat.ply");
  EXPECT_EQ(model_name_from(link, folder.path() / "cat.ply"), (folder.path() / "cat.ply").string());
}

TEST_F(OpenSceneFile, KeepsTheStepWhereDampingIsByIt) {
  const std::string paper = "simulation.method = \"paper\"\n";
  EXPECT_EQ(open(paper + stiff_body).settings.steps_per_second, 60);
  EXPECT_EQ(open(stiff_body + "damping = \"literal\"\n").settings.steps_per_second, 60);
  EXPECT_THROW(open(paper + "picture.frames_per_second = 24\n" + stiff_body), scenes::SceneError);
}

TEST_F(OpenSceneFile, KeepsTheStepWhereABodyNeedsTooShortAOne) {
  const scenes::Scene stiffer = open(stiff_body + "[[body]]\nposition = [9, 0, 4]\nk = 1e10\n");
  EXPECT_EQ(stiffer.settings.steps_per_second, 60);
  EXPECT_TRUE(stiffer.warnings.empty());
}

/// It would fail in its first step: what makes the step short is named, and what is advised works.
TEST_F(OpenSceneFile, RefusesToRunWithAStepThatFailsAtOnce) {
  const auto refusal = [](const scenes::Scene& scene) -> std::string {
    try {
      refuse_unstable_step(scene, build_world(scene));
    } catch (const scenes::SceneError& error) {
      return error.what();
    }
    return "";
  };
  const std::string pad =
      "[[body]]\nname = \"pad\"\nshape = \"box\"\nsize = [2.4, 0.5, 0.3]\ndivisions = 4\n"
      "k = 2000\nbending = 20\nbending_damping = 0.01\ngauge_pressure = 10\nmass = 0.5\n"
      "position = [0, 0, 1]\n";
  const std::string message = refusal(open("duration = 0.1\n" + pad));
  EXPECT_NE(message.find("it.toml:2:1: body 'pad': small motions stay stable up to steps of "),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("for bending_damping = 0.01 s of bending = 20 N m with rk4"),
            std::string::npos)
      << message;
  const std::string implicit = "simulation.integrator=implicit_euler",
                    many = "simulation.steps_per_second=";
  EXPECT_NE(message.find("use --set " + implicit + ", or --set " + many), std::string::npos)
      << message;
  const std::string steps = message.substr(message.find(many));
  for (const std::string& advised : {implicit, steps.substr(0, steps.find_first_of("\n"))}) {
    const std::size_t value = advised.find('=') + 1;
    const bool is_word = advised == implicit;
    const scenes::Scene followed =
        open(advised.substr(0, value) +
             (is_word ? "\"" + advised.substr(value) + "\"" : advised.substr(value)) + "\n" + pad);
    EXPECT_EQ(refusal(followed), "") << advised;
    sim::World world = build_world(followed);
    EXPECT_FALSE(sim::run(world, 0.03)) << advised;
  }
  // A step that is named is the user's own; a smaller need is met.
  EXPECT_EQ(refusal(open("simulation.steps_per_second = 60\n" + pad)), "");
  EXPECT_EQ(refusal(open(pad.substr(0, pad.find("bending_damping")) + "mass = 0.5\n")), "");
  const std::string stiff =
      refusal(open(stiff_body + "[[body]]\nposition = [9, 0, 4]\nk = 1e10\n"));
  EXPECT_NE(stiff.find("body 'body2'"), std::string::npos) << stiff;
  EXPECT_NE(stiff.find("k = 1e+10 N/m"), std::string::npos) << stiff;
}

}  // namespace
}  // namespace pneuma::app
