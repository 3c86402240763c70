// `pneuma export --format html`: the page holds the run that the simulation makes.
#include <cmath>
#include <numbers>

#include "app/export/exported_mesh.h"
#include "app/export/replay/quantise.h"
#include "app/export/replay/recording.h"
#include "app/export/replay/replay_data.h"
#include "app/export/sink/bytes.h"
#include "app/files/scene_catalogue.h"
#include "app/host/errors.h"
#include "app/picture/build_frame.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "render/geometry/rounding.h"
#include "scenes/loader/load_scene.h"
#include "sim/mesh/measure.h"
#include "tests/app/export/read_replay.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// Two balls that meet, on which a box lies.
const std::string meeting = R"(
title = "Balls & <boxes> </script>"
duration = 1.0
[[body]]
name = "left"
n = 0.05
rest = "equilibrium"
radius = 1.0
position = [-1.2, 0.0, 1.0]
velocity = [3.0, 0.0, 0.0]
[[body]]
name = "right"
n = 0.05
rest = "equilibrium"
radius = 1.0
position = [1.2, 0.0, 1.0]
[[body]]
name = "box"
kind = "rigid"
position = [0.0, 4.0, 1.1]
)";

class ReplayTest : public RenderTest {
 protected:
  ReplayTest() { write_text(scene(), meeting); }

  ProgramResult run_export(const std::string& options) const {
    return run_pneuma(fmt::format("export '{}' --format html --out '{}' {} 2>&1", scene().string(),
                                  out().string(), options),
                      "PNEUMA_GL=none");
  }
  std::string page() const { return read_text(out() / "fall.html"); }
};

TEST_F(ReplayTest, PositionsReadBackWithinTheStatedError) {
  ASSERT_EQ(run_export("--frames 3-24").exit_code, 0);
  const ReadReplay replay(page());
  EXPECT_EQ(replay.header["first_frame"], 3);
  EXPECT_EQ(replay.header["frames"], 22);
  const std::vector<double> read = replay.coordinates("positions");

  const scenes::Scene loaded = scenes::load_scene(scene());
  Simulation simulation(loaded, build_world(loaded), 1);
  while (simulation.frame() < 3) simulation.advance_frame();
  double farthest = 0.0;
  sim::Bounds bounds;
  std::size_t at = 0;
  for (;; simulation.advance_frame()) {
    for (const ExportedMesh& mesh :
         MeshExporter(loaded, simulation.world()).meshes(simulation.world())) {
      for (const sim::Vec3& vertex : mesh.vertices) {
        bounds.include(vertex);
        for (int axis = 0; axis < 3; ++axis) {
          farthest = std::max(farthest, std::abs(read.at(at++) - vertex[axis]));
        }
      }
    }
    if (simulation.frame() == 24) break;
  }
  EXPECT_EQ(at, read.size());
  const double extent = bounds.size().maxCoeff();
  const auto stated = replay.header["lattice"]["max_error"].get<double>();
  // Contacts, which it holds too, lie a little outside of the bodies.
  EXPECT_NEAR(replay.header["lattice"]["extent"].get<double>(), extent, 0.01 * extent);
  EXPECT_LE(stated, 1e-4 * extent);
  // The page's numbers come from the renderer's, which are of single precision.
  EXPECT_LE(farthest, stated + 1e-6 * extent);
  EXPECT_GT(farthest, 0.5 * stated) << "closer than a lattice of 16 bits can be";
}

TEST_F(ReplayTest, HasTheContactsAndParticlesOfEachFrame) {
  ASSERT_EQ(run_export("").exit_code, 0);
  const ReadReplay replay(page());
  const auto counts = replay.series<std::uint32_t>("contacts_counts");
  const auto normals = replay.series<std::int8_t>("contacts_normals");
  const std::vector<double> places = replay.coordinates("contacts_places");
  const double error = replay.header["lattice"]["max_error"].get<double>() + 1e-6;

  const scenes::Scene loaded = scenes::load_scene(scene());
  sim::World world = build_world(loaded);
  world.settings.particles.shown = true;
  Simulation simulation(loaded, std::move(world), 1);
  std::size_t at = 0;
  std::size_t particles = 0;
  for (std::size_t frame = 0; frame < counts.size(); ++frame) {
    const auto contacts = simulation.contacts();
    ASSERT_EQ(counts[frame], contacts.size()) << "frame " << frame;
    for (const sim::Contact& contact : contacts) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(normals.at(at) / 127.0, contact.normal[axis], 1.0 / 253.0);
        EXPECT_NEAR(places.at(at++), contact.point[axis], error);
      }
    }
    for (const sim::ParticlePair& pair : simulation.world().particles) {
      if (pair.near) particles += pair.first_features.size() + pair.second_features.size();
    }
    simulation.advance_frame();
  }
  EXPECT_GT(at, 0u) << "nothing touches: the scene tests nothing";
  EXPECT_GT(particles, 0u);
  EXPECT_GE(replay.series<std::uint8_t>("particles_looks").size(), particles);  // and white discs
}

TEST_F(ReplayTest, SaysHowFarBodiesAreDrawnRounded) {
  ASSERT_EQ(run_export("").exit_code, 0);
  const ReadReplay replay(page());
  const auto shares = replay.series<std::uint8_t>("shares");
  const scenes::Scene loaded = scenes::load_scene(scene());
  Simulation simulation(loaded, build_world(loaded), 1);
  const FrameBuilder builder(loaded, simulation.world());
  const auto frames = replay.header["frames"].get<std::size_t>();
  const auto steps = replay.header["share_steps"].get<float>();
  std::size_t held = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::size_t vertex = 0;
    for (const render::Mesh& mesh : builder.build(simulation.world(), {}).meshes) {
      if (mesh.room.empty()) continue;  // the box
      const std::vector<float> share =
          render::bulge_shares(mesh.shape->triangles, mesh.positions, mesh.normals, mesh.room);
      for (const float expected : share) {
        const float read = static_cast<float>(shares.at(vertex++ * frames + frame)) / steps;
        EXPECT_LE(read, expected + 1e-6f);
        EXPECT_GE(read, expected - 1.0f / steps - 1e-6f);
        if (expected < 1.0f) ++held;
      }
    }
    EXPECT_EQ(vertex * frames, shares.size());
    simulation.advance_frame();
  }
  EXPECT_GT(held, 0u) << "nothing is near: the scene tests nothing";

  ASSERT_EQ(run_export("--overwrite --frames 2 --set picture.rounded=false").exit_code, 0);
  EXPECT_TRUE(ReadReplay(page()).series<std::uint8_t>("shares").empty());
}

TEST_F(ReplayTest, HasTheWayOfACameraThatMoves) {
  const std::string still = "--set camera.eye=[3,-9,4] --set camera.target=[1,0,2]";
  ASSERT_EQ(run_export("--frames 13-21 --set camera.orbit=90 " + still).exit_code, 0);
  const ReadReplay moving(page());
  const auto cameras = moving.series<float>("cameras");
  ASSERT_EQ(cameras.size(), 6u * 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const double angle =
        0.5 * std::numbers::pi * (13.0 + static_cast<double>(i)) /
        moving.header["frames_per_second"].get<double>();  // from above, anticlockwise
    EXPECT_NEAR(cameras[6 * i], 1.0 + 2.0 * std::cos(angle) + 9.0 * std::sin(angle), 1e-5);
    EXPECT_NEAR(cameras[6 * i + 1], 2.0 * std::sin(angle) - 9.0 * std::cos(angle), 1e-5);
    EXPECT_EQ(cameras[6 * i + 2], 4.0f);
    EXPECT_EQ(cameras[6 * i + 3], 1.0f);
    EXPECT_EQ(cameras[6 * i + 5], 2.0f);
  }
  ASSERT_EQ(run_export("--overwrite --frames 2 " + still).exit_code, 0);
  EXPECT_TRUE(ReadReplay(page()).series<float>("cameras").empty());
}

TEST_F(ReplayTest, NeedsNothingButItself) {
  ASSERT_EQ(run_export("--frames 2").exit_code, 0);
  const std::string text = page();
  EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
  for (const char* link : {"://", " src=", " href=", "@import", "url(", "import(", "fetch("}) {
    EXPECT_EQ(text.find(link), std::string::npos) << link;
  }
  EXPECT_EQ(text.find("{{"), std::string::npos) << "a place of the template is not filled";
  EXPECT_NE(text.find("<title>Balls &amp; &lt;boxes> &lt;/script></title>"), std::string::npos);
  EXPECT_EQ(ReadReplay(text).header["title"], "Balls & <boxes> </script>");
}

TEST_F(ReplayTest, PlotsAreTheNumbersOfRunJson) {
  ASSERT_EQ(run_export("--frames 10").exit_code, 0);
  ASSERT_EQ(render_into("pictures", "--frames 10 --size 64x48").exit_code, 0);
  const nlohmann::json frames = record("pictures")["frames"];
  const ReadReplay replay(page());
  const auto line = [&](std::size_t plot, std::size_t number) {
    return replay.series<float>(replay.header["plots"][plot]["lines"][number]["stream"]);
  };
  for (std::size_t i = 0; i < 10; ++i) {
    const double kinetic =
        frames[i]["energy"]["kinetic"].get<double>() - frames[0]["energy"]["kinetic"].get<double>();
    EXPECT_NEAR(line(0, 1)[i], kinetic, 1e-6 * std::abs(kinetic)) << i;
    const double volume =
        frames[i]["volumes"]["left"].get<double>() + frames[i]["volumes"]["right"].get<double>();
    EXPECT_NEAR(line(1, 0)[i], volume, 1e-6 * volume);
    EXPECT_NEAR(line(2, 0)[i], frames[i]["greatest_penetration"].get<double>(), 1e-7);
    EXPECT_EQ(line(3, 0)[i], frames[i]["contacts"]["count"].get<float>());
  }
}

TEST_F(ReplayTest, ADivergedRunCanBeWatchedUpToThere) {
  EXPECT_EQ(
      run_export("--set left.k=5000 --set left.k_max=1e9 --set simulation.steps_per_second=60")
          .exit_code,
      5);
  EXPECT_GE(ReadReplay(page()).header["frames"], 1);
}

TEST_F(ReplayTest, RefusesARunThatIsTooLongForAPage) {
  const ProgramResult result = run_export(
      "--set limits.frames=10000000 --set simulation.steps_per_second=6000 --set "
      "picture.frames_per_second=6000 --set duration=1000");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("--frames"), std::string::npos) << result.output;
}

TEST_F(ReplayTest, RefusesMoreContactsThanAPageHolds) {
  const scenes::Scene loaded = scenes::load_scene(scene());
  Simulation simulation(loaded, build_world(loaded), 1);
  Recorder recorder(loaded, simulation.world());
  for (; simulation.frame() < 20; simulation.advance_frame()) recorder.add(simulation);
  const std::size_t bytes = replay_data(recorder.recording()).bytes.size();
  EXPECT_NO_THROW(replay_data(recorder.recording(), bytes));
  EXPECT_THROW(replay_data(recorder.recording(), bytes - 1), UsageError);
}

TEST_F(ReplayTest, DoesNotReplaceAPageUnasked) {
  ASSERT_EQ(run_export("--frames 2").exit_code, 0);
  EXPECT_EQ(run_export("--frames 2").exit_code, 6);
  EXPECT_EQ(run_export("--frames 3 --overwrite").exit_code, 0);
  EXPECT_EQ(ReadReplay(page()).header["frames"], 3);
}

TEST(Quantise, DifferencesAreFromAStraightLine) {
  // 10; 13 - 10 = 3; 17 - (2 * 13 - 10) = 1; each doubled. 65535 is -1 modulo 65536, and 0 is 1
  // more.
  const std::vector<std::uint16_t> rising = {10, 65535, 13, 0, 17, 1};
  EXPECT_EQ(differences(rising, 2, Foretold::by_line),
            (std::vector<std::uint8_t>{20, 1, 6, 2, 2, 0,  //
                                       0, 0, 0, 0, 0, 0}));
  const std::vector<std::uint16_t> far = {300, 0};
  EXPECT_EQ(differences(far, 1, Foretold::by_line),
            (std::vector<std::uint8_t>{600 % 256, 599 % 256, 2, 2}));
}

TEST(Quantise, DifferencesAreFromTheRowBefore) {
  // 10; 13 - 10 = 3; 17 - 13 = 4; each doubled. 65535 is -1 modulo 65536, and 0 and 1 are 1 more.
  const std::vector<std::uint16_t> rising = {10, 65535, 13, 0, 17, 1};
  EXPECT_EQ(differences(rising, 2, Foretold::by_row),
            (std::vector<std::uint8_t>{20, 1, 6, 2, 8, 2,  //
                                       0, 0, 0, 0, 0, 0}));
}

TEST(Quantise, Base64IsThatOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe"), "//4=");
}

TEST(LongReplay, ThePageOfEveryPaperSceneIsSmall) {
  const TemporaryFolder folder;
  for (const CatalogueEntry& entry : scene_catalogue()) {
    const ProgramResult result = run_pneuma(fmt::format(
        "export {} --format html --quiet --out '{}' 2>&1", entry.name, folder.path().string()));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    EXPECT_LE(fs::file_size(folder / (entry.name + ".html")), 3'000'000u) << entry.name;
  }
}

}  // namespace
}  // namespace pneuma::app
