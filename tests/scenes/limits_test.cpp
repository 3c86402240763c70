#include <gtest/gtest.h>

#include "scenes/load_scene.h"

namespace pneuma::scenes {
namespace {

std::string refusal(const std::string& text) {
  try {
    parse_scene(text, "x.toml");
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

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
               "GiB of memory are needed", "memory_gib = 64");
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

TEST(Limits, FileSize) {
  const std::string body = "[[body]]\n#";
  EXPECT_EQ(refusal(body + std::string(greatest_file_size - body.size(), 'x')), "");
  EXPECT_NE(refusal(body + std::string(greatest_file_size - body.size() + 1, 'x'))
                .find("larger than 1048576 bytes"),
            std::string::npos);
}

}  // namespace
}  // namespace pneuma::scenes
