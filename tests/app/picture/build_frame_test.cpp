#include "app/picture/build_frame.h"

#include <gtest/gtest.h>

#include <set>

#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "render/frame/check_frame.h"
#include "scenes/loader/load_scene.h"
#include "tests/app/picture/prism.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

constexpr const char* two_kinds = R"(
title = "Balls and bricks"
duration = 1.0
[[body]]
kind = "soft"
shape = "sphere"
radius = 2.0
position = [10.0, 0.0, 5.0]
copies = [2, 1, 1]
[[body]]
kind = "rigid"
size = [1.0, 2.0, 3.0]
position = [0.0, 0.0, 4.0]
rotation = [0.0, 0.0, 90.0]
)";

struct Built {
  scenes::Scene scene;
  sim::World world;
  render::Frame frame;
};

Built build(const std::vector<std::string>& overrides = {}, Show show = {}) {
  Built built;
  built.scene = scenes::parse_scene(two_kinds, "test.toml", overrides);
  built.world = build_world(built.scene);
  built.frame = FrameBuilder(built.scene, built.world).build(built.world, {}, {}, show);
  return built;
}

TEST(BuildFrame, MakesAFrameThatCanBeDrawn) {
  EXPECT_NO_THROW(render::check_frame(build({}, {.wireframe = true}).frame));
}

TEST(BuildFrame, DrawsEdgesAsBarsAroundThem) {
  const Built built = build({"body.2.drawn=edges"});
  EXPECT_NO_THROW(render::check_frame(built.frame));
  const render::Mesh& bars = built.frame.meshes[2];
  const render::Mesh surface = build().frame.meshes[2];
  ASSERT_EQ(surface.shape->edges.size(), 12U);
  ASSERT_EQ(bars.positions.size(), 12U * 8U);
  const float radius = 0.003f * render::Vec3f(1.0f, 2.0f, 3.0f).norm();
  for (std::size_t edge = 0; edge < 12; ++edge) {
    for (std::size_t end = 0; end < 2; ++end) {
      const render::Vec3f corner = surface.positions[surface.shape->edges[edge][end]];
      const render::Vec3f along = surface.positions[surface.shape->edges[edge][1 - end]] - corner;
      for (std::size_t around = 0; around < 4; ++around) {
        const render::Vec3f off = bars.positions[8 * edge + 4 * end + around] - corner;
        EXPECT_NEAR(off.norm(), radius, 1e-5f);
        EXPECT_NEAR(off.dot(along), 0.0f, 1e-5f);
      }
    }
  }
  EXPECT_EQ(bars.shape->triangles.size(), 12U * 8U);
  EXPECT_TRUE(surface.takes_light);
  EXPECT_FALSE(bars.takes_light);
}

TEST(BuildFrame, DrawsNothingOfWhatIsNotToBeSeen) {
  const Built built = build({"body.1.drawn=nothing"}, {.field = ColourField::velocity});
  EXPECT_NO_THROW(render::check_frame(built.frame));
  ASSERT_EQ(built.frame.meshes.size(), 3U) << "others keep their places";
  for (const std::size_t ball : {0U, 1U}) {
    EXPECT_TRUE(built.frame.meshes[ball].positions.empty());
    EXPECT_TRUE(built.frame.meshes[ball].shape->triangles.empty());
  }
}

TEST(BuildFrame, PutsEveryVertexWhereItIs) {
  const Built built = build();
  ASSERT_EQ(built.frame.meshes.size(), 3u);
  for (std::size_t body = 0; body < 2; ++body) {
    const sim::VertexArray& positions = built.world.soft[body].positions;
    const render::Mesh& mesh = built.frame.meshes[body];
    ASSERT_EQ(static_cast<int>(mesh.positions.size()), positions.size());
    for (int v = 0; v < positions.size(); ++v) {
      EXPECT_EQ(mesh.positions[sim::at(v)], Vec3(positions[v]).cast<float>());
    }
  }
}

TEST(BuildFrame, TurnsBoxes) {
  // A quarter turn about z swaps width and height.
  render::Vec3f low = render::Vec3f::Constant(100.0f), high = -low;
  const Built built = build();
  for (const render::Vec3f& corner : built.frame.meshes[2].positions) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const float rounding = 1e-6f;
  EXPECT_LT((high - low - render::Vec3f(2.0f, 1.0f, 3.0f)).norm(), rounding);
  EXPECT_LT((0.5f * (high + low) - render::Vec3f(0.0f, 0.0f, 4.0f)).norm(), rounding);
}

TEST(BuildFrame, ShadesSoftBodiesSmoothAndBoxesFlat) {
  const Built built = build();
  const render::Mesh& sphere = built.frame.meshes[0];
  ASSERT_EQ(sphere.normals.size(), sphere.positions.size());
  for (std::size_t v = 0; v < sphere.normals.size(); ++v) {
    EXPECT_NEAR(sphere.normals[v].norm(), 1.0f, 1e-6f);
    const render::Vec3f outwards =
        (sphere.positions[v] - render::Vec3f(10.0f, 0.0f, 5.0f)).normalized();
    // 8 x 8 triangles of a sphere differ from it by up to 22 degrees; a vertex between them by
    // less.
    EXPECT_GT(sphere.normals[v].dot(outwards), 0.95f);
  }
  EXPECT_TRUE(built.frame.meshes[2].normals.empty());
}

TEST(BuildFrame, DrawsABoxWithoutDiagonals) {
  const Built built = build();
  const render::Mesh& box = built.frame.meshes[2];
  ASSERT_EQ(box.shape->edges.size(), 12u);
  const float rounding = 1e-5f;
  for (const auto& [a, b] : box.shape->edges) {
    const float length = (box.positions[a] - box.positions[b]).norm();
    EXPECT_NEAR(length, std::round(length), rounding);  // 1, 2 or 3: no diagonal is a whole number
    EXPECT_LE(length, 3.0f + rounding);
  }
}

TEST(BuildFrame, SharesShapesBetweenCopiesAndFrames) {
  const scenes::Scene scene = scenes::parse_scene(two_kinds, "test.toml");
  const sim::World world = build_world(scene);
  const FrameBuilder builder(scene, world);
  const render::Frame first = builder.build(world, {}), second = builder.build(world, {});
  EXPECT_EQ(first.meshes[0].shape, first.meshes[1].shape);
  for (std::size_t i = 0; i < first.meshes.size(); ++i) {
    EXPECT_EQ(first.meshes[i].shape, second.meshes[i].shape);
  }
}

TEST(BuildFrame, HasTheGroundOnlyWhereThereIsOneAndItIsWanted) {
  EXPECT_TRUE(build().frame.ground);
  EXPECT_FALSE(build({"picture.grid=false"}).frame.ground);
  // Without normals of vertices every triangle is drawn flat.
  EXPECT_FALSE(build({}).frame.meshes.at(0).normals.empty());
  EXPECT_TRUE(build({"picture.rounded=false"}).frame.meshes.at(0).normals.empty());
  // So are the faces of a box, but not a ball, however few triangles it has.
  const auto is_flat = [](const std::string& shape) {
    const scenes::Scene scene =
        scenes::parse_scene("[[body]]\nposition = [0, 0, 9]\n" + shape + "\n", "x.toml");
    const sim::World world = build_world(scene);
    return FrameBuilder(scene, world).build(world, {}).meshes.at(0).normals.empty();
  };
  EXPECT_TRUE(is_flat("shape = \"box\""));
  EXPECT_FALSE(is_flat("shape = \"sphere\"\nstacks = 2\nslices = 3"));
  EXPECT_FALSE(is_flat("shape = \"icosphere\""));
  EXPECT_FALSE(build({"ground.present=false"}).frame.ground);
}

/// Their rims are a twentieth of the length of all edges that are not flat.
TEST(BuildFrame, ModelsThatKeepTheirShapeHaveRims) {
  const TemporaryFolder folder;
  write_text(folder / "pin.obj", assets::obj_text(make_prism(8.0)));
  const auto mesh_of = [&](const std::string& kind) {
    write_text(folder / "scene.toml", "[[body]]\nkind = \"" + kind +
                                          "\"\nshape = \"model\"\nmodel.file = \"pin.obj\"\n"
                                          "position = [0, 0, 9]\n");
    const scenes::Scene scene = scenes::load_scene(folder / "scene.toml");
    const sim::World world = build_world(scene);
    return FrameBuilder(scene, world).build(world, {}).meshes.at(0);
  };
  for (const char* kind : {"static", "moved"}) {
    const render::Mesh mesh = mesh_of(kind);
    EXPECT_TRUE(mesh.normals.empty()) << kind;
    std::set<std::uint32_t> normals;
    for (const auto& corners : mesh.shape->corner_normals) {
      normals.insert(corners.begin(), corners.end());
    }
    EXPECT_EQ(normals.size(), 2u * 2u * 24u + 2u) << "two on rims, one in a face's middle";
  }
  EXPECT_FALSE(mesh_of("soft").normals.empty());
}

TEST(BuildFrame, ItsGridIsOfTheSizeOfTheBodies) {
  const auto spacing = [](const std::string& scale) {
    Built built;
    built.scene =
        scenes::parse_scene("[[body]]\nradius = " + scale + "\nposition = [0, 0, " + scale +
                                "]\n[[body]]\nkind = \"static\"\nsize = [900, 900, 1]\n"
                                "position = [0, 0, -5000]\n",
                            "test.toml");
    built.world = build_world(built.scene);
    return FrameBuilder(built.scene, built.world).build(built.world, {}).ground->grid_spacing;
  };
  EXPECT_FLOAT_EQ(spacing("0.0002"), 1e-4f);
  EXPECT_FLOAT_EQ(spacing("0.2"), 1.0f);
  EXPECT_FLOAT_EQ(spacing("10"), 1.0f);
  EXPECT_FLOAT_EQ(spacing("1000"), 1000.0f);
}

TEST(BuildFrame, FollowsThePictureSettings) {
  EXPECT_TRUE(build().frame.light.shadows);
  EXPECT_FALSE(build({"picture.shadows=false"}).frame.light.shadows);
  EXPECT_FALSE(build().frame.wireframe);
  EXPECT_TRUE(build({}, {.wireframe = true}).frame.wireframe);
}

TEST(BuildFrame, SaysSceneTimeAndStep) {
  Built built = build();
  built.world.steps = 90;
  const FrameBuilder builder(built.scene, built.world);
  EXPECT_EQ(builder.build(built.world, {}).caption->text, "Balls and bricks\nt = 1.50 s   step 90");
  EXPECT_FALSE(build({"picture.caption=false"}).frame.caption);
}

TEST(BuildFrame, TellsTheTimesOfFramesApart) {
  const auto said = [](int frames) {
    Built built = build({"picture.frames_per_second=" + std::to_string(frames),
                         "simulation.steps_per_second=" + std::to_string(2 * frames)});
    built.world.steps = 2 * frames + 2;
    return FrameBuilder(built.scene, built.world).build(built.world, {}).caption->text;
  };
  EXPECT_NE(said(100).find("t = 1.01 s "), std::string::npos);
  EXPECT_NE(said(1000).find("t = 1.001 s "), std::string::npos);
  EXPECT_NE(said(2000).find("t = 1.0005 s "), std::string::npos);
}

TEST(BuildFrame, KeepsTheLettersOfAName) {
  Built built = build({"title=\"\""});
  built.scene.name = "Bälle × 2";  // from the name of the file, which may be anything
  const FrameBuilder builder(built.scene, built.world);
  EXPECT_TRUE(builder.build(built.world, {}).caption->text.starts_with("Bälle × 2\n"));
}

}  // namespace
}  // namespace pneuma::app
