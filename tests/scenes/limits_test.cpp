#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::scenes {
namespace {

using Strings = std::vector<std::string>;

/// Refused as it stands, accepted when [limits] is raised.
void expect_limit(const std::string& top, const std::string& body, const std::string& words,
                  const std::string& raised) {
  const std::string scene = top + "\n[[body]]\n" + body + "\n";
  EXPECT_NE(refusal(scene).find(words), std::string::npos) << refusal(scene);
  const std::string with_limits = top + "\n[limits]\n" + raised + "\n[[body]]\n" + body + "\n";
  EXPECT_EQ(refusal(with_limits), "");
}

TEST(Limits, VertexCountsOfThePapersMeshes) {
  BodyScene body;
  EXPECT_EQ(vertex_count(body), 58);  // section 6.2's sphere: 2 poles and 7 circles of 8
  body.shape = Shape::torus;
  body.stacks = body.slices = 16;
  EXPECT_EQ(vertex_count(body), 256);
  body.shape = Shape::icosphere;
  body.subdivisions = 0;
  EXPECT_EQ(vertex_count(body), 12);
  body.subdivisions = 1;
  EXPECT_EQ(vertex_count(body), 42);  // the icosahedron's 12, and one for each of its 30 edges
  body.shape = Shape::box;
  body.divisions = 1;
  EXPECT_EQ(vertex_count(body), 8);
  body.divisions = 2;
  EXPECT_EQ(vertex_count(body), 26);  // a cube of 3^3 points without the one inside
  body.kind = BodyKind::rigid;
  EXPECT_EQ(vertex_count(body), 8);
}

TEST(Limits, Bodies) {
  expect_limit("", "kind = \"rigid\"\ncopies = [20001, 1, 1]",
               "x.toml:4:10: 20001 bodies are more than the limit of 20000", "bodies = 20001");
}

TEST(Limits, BodiesAreCountedTogether) {
  const std::string half = "[[body]]\nkind = \"rigid\"\ncopies = [1, 10000, 1]\n";
  EXPECT_EQ(refusal(half + half), "");
  EXPECT_NE(refusal(half + half + "[[body]]\n").find("20001 bodies"), std::string::npos);
}

TEST(Limits, VerticesOfOneBody) {
  expect_limit("", "stacks = 400\nslices = 300", "119702 vertices in one body are more than",
               "vertices_per_body = 119702");
}

TEST(Limits, VerticesOfAllBodies) {
  // 163842 vertices need no more than raising the first limit; 13 of them need the second.
  expect_limit("", "stacks = 1001\nslices = 99\ncopies = [21, 1, 1]",
               "2079042 vertices are more than the limit of 2000000", "vertices = 2079042");
}

TEST(Limits, Frames) {
  expect_limit("duration = 1200.1\n", "", "36003 frames are more than the limit of 36000",
               "frames = 36003");
}

TEST(Limits, Memory) {
  expect_limit("[picture]\nwidth = 8192\nheight = 8192\nsamples = 4", "",
               "about 4.01 GiB of memory are needed, more than the limit of 4 GiB",
               "memory_gib = 64");  // the picture takes just 4 GiB, the body next to nothing
}

TEST(Limits, CountsBeyondAnyIntegerAreRefusedNotWrapped) {
  // 10^18 copies of up to 10^8 vertices: the product does not fit in 64 bits.
  const std::string body =
      "[[body]]\nstacks = 10000\nslices = 10000\ncopies = [1000000, 1000000, 1000000]\n";
  const std::string raised =
      "[limits]\nbodies = 10000000\nvertices_per_body = 100000000\nvertices = 2000000000\n"
      "memory_gib = 1e9\n";
  EXPECT_NE(refusal(body).find("99990002 vertices in one body"), std::string::npos);
  EXPECT_NE(refusal(raised + body).find("1000000000000000000 bodies"), std::string::npos);
  std::string many = raised;
  for (int i = 0; i < 100; ++i) {
    many += "[[body]]\nkind = \"rigid\"\ncopies = [1000000, 1000000, 1000000]\n";
  }
  EXPECT_NE(refusal(many).find("bodies are more than"), std::string::npos);
}

TEST(Limits, PictureSides) {
  for (const std::string side : {"width", "height"}) {
    expect_limit("[picture]\n" + side + " = 8193", "",
                 "x.toml:2:" + std::to_string(side.size() + 4) + ": " + side +
                     " = 8193 pixels are more than the limit of 8192; make the picture smaller, or "
                     "raise picture_side in [limits]",
                 "picture_side = 8193");
  }
  // A lower limit blames the size that breaks it, where it is not given, too.
  EXPECT_NE(refusal("[limits]\npicture_side = 1000\n[[body]]\n").find("2:16: width = 1280"),
            std::string::npos);
}

/// A scene of so many bytes.
std::string scene_of(std::size_t bytes) {
  const std::string body = "[[body]]\n#";
  return body + std::string(bytes - body.size(), 'x');
}

constexpr std::size_t mib = 1024 * 1024;

TEST(Limits, FileSize) {
  EXPECT_EQ(refusal(scene_of(mib)), "");
  EXPECT_EQ(refusal(scene_of(mib + 1)),
            "x.toml: 1048577 bytes are more than the limit of 1 MiB for a scene file; make many "
            "bodies of one [[body]] with copies, or raise the limit with --set "
            "limits.scene_file_mib=2");
}

TEST(Limits, FileSizeIsRaisedByAnOverride) {
  const std::string text = scene_of(mib + 1);
  EXPECT_EQ(refusal(text, {"limits.scene_file_mib=2"}), "");
  EXPECT_EQ(refusal(text, {" limits.scene_file_mib = 1.5"}), "");
  EXPECT_EQ(refusal(text, {"limits.scene_file_mib=1", "limits.scene_file_mib=2"}), "");
  EXPECT_NE(refusal(text, {"limits.scene_file_mib=2", "limits.scene_file_mib=1"}), "");
  // What is no size raises nothing, and is refused itself where the file is not.
  for (const std::string value : {"1025", "0", "-1", "nan", "inf", "much", "[2", ""}) {
    const Strings overrides = {"limits.scene_file_mib=" + value};
    EXPECT_NE(refusal(text, overrides).find("limit of 1 MiB"), std::string::npos) << value;
    EXPECT_NE(refusal("[[body]]\n", overrides).find("--set " + overrides[0]), std::string::npos);
  }
}

TEST(Limits, AFileMayLowerTheLimitOfItsSizeButNotRaiseIt) {
  const std::string raised = "[limits]\nscene_file_mib = 2\n";
  EXPECT_EQ(refusal(raised + scene_of(mib - raised.size())), "");
  EXPECT_NE(refusal(raised + scene_of(mib)).find("limit of 1 MiB"), std::string::npos);
  const std::string lowered = "[limits]\nscene_file_mib = 0.5\n";
  EXPECT_EQ(refusal(lowered + scene_of(mib / 2 - lowered.size())), "");
  EXPECT_NE(refusal(lowered + scene_of(mib / 2)).find("limit of 0.5 MiB"), std::string::npos);
}

TEST(Limits, OfFileSizeNameTheSizeOfTheFile) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "long.toml";
  write_text(path, scene_of(3 * mib));
  const auto load = [&](const Strings& overrides) -> std::string {
    try {
      load_scene(path, overrides);
    } catch (const SceneError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(load({}).find("long.toml: 3145728 bytes are more than"), std::string::npos) << load({});
  EXPECT_NE(load({}).find("limits.scene_file_mib=3"), std::string::npos);
  EXPECT_EQ(load({"limits.scene_file_mib=3"}), "");
}

}  // namespace
}  // namespace pneuma::scenes
