// Models that are none: each gets a message with what is wrong and where, from the program too.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ostream>

#include "assets/load_model.h"
#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::assets {
namespace {

using Strings = std::vector<std::string>;

struct Broken {
  std::string name;
  std::string file;
  std::string content;
  Strings expected;  // in the message
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t place = text.find(what);
  if (place == text.npos) throw std::logic_error("'" + what + "' is not in: " + text);
  return text.replace(place, what.size(), by);
}

std::string half(const std::string& text) { return text.substr(0, text.size() / 2); }

sim::TriangleMesh without_first_triangle() {
  sim::TriangleMesh mesh = cube();
  mesh.triangles.erase(mesh.triangles.begin());
  return mesh;
}

sim::TriangleMesh dented() {
  sim::TriangleMesh mesh = sim::make_icosphere(1.0, 2);
  mesh.vertices[0] *= -1.5;  // out at the other side
  return mesh;
}

sim::TriangleMesh with_nan() {
  sim::TriangleMesh mesh = cube();
  mesh.vertices[5].y() = std::nan("");
  return mesh;
}

sim::TriangleMesh with_infinity() {
  sim::TriangleMesh mesh = cube();
  mesh.vertices[5].y() = std::numeric_limits<double>::infinity();
  return mesh;
}

sim::TriangleMesh with_index(int index) {
  sim::TriangleMesh mesh = cube();
  mesh.triangles[3][1] = index;
  return mesh;
}

sim::TriangleMesh without_triangles() {
  sim::TriangleMesh mesh = cube();
  mesh.triangles.clear();
  return mesh;
}

/// Bytes without order, the same on every machine.
std::string noise(std::size_t count) {
  std::string bytes;
  for (std::uint32_t state = 1; bytes.size() < count; state = state * 1664525u + 1013904223u) {
    bytes += static_cast<char>(state >> 24);
  }
  return bytes;
}

const Broken broken_models[] = {
    {"truncated_binary_stl", "a.stl", half(stl_bytes(cube())), {"header announces 12 triangles"}},
    {"truncated_within_the_text_of_an_stl",
     "a.stl",
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0",
     {"ends within line 5, after a vertex", "cut short"}},
    {"truncated_within_the_stl_header", "a.stl", stl_bytes(cube()).substr(0, 60), {"cut short"}},
    {"truncated_binary_ply", "a.ply", half(ply_bytes(dented())), {}},
    {"truncated_ply", "a.ply", half(ply_text(dented())), {"cut short"}},
    {"truncated_ply_faces",
     "a.ply",
     ply_text(cube()).substr(0, ply_text(cube()).size() - 16),
     {"20 lines", "there are 18", "cut short"}},
    {"truncated_ply_header", "a.ply", ply_text(cube()).substr(0, 60), {"end_header"}},
    {"truncated_off", "a.off", half(off_text(cube())), {}},
    {"truncated_glb", "a.glb", half(glb_bytes(cube())), {}},
    {"truncated_gltf", "a.gltf", half(gltf_text(cube(), "it.bin")), {}},
    {"truncated_dae", "a.dae", half(dae_text(cube())), {}},
    {"truncated_fbx", "a.fbx", half(fbx_text(cube())), {}},
    {"truncated_3ds", "a.3ds", half(a3ds_bytes(cube())), {}},
    {"gltf_without_its_buffer", "a.gltf", gltf_text(cube(), "gone.bin"), {"gone.bin"}},
    {"nan_in_obj", "a.obj", obj_text(with_nan()), {"vertex", "is not finite", "nan"}},
    {"nan_in_binary_ply", "a.ply", ply_bytes(with_nan()), {"vertex 5", "is not finite", "nan"}},
    {"nan_in_stl", "a.stl", stl_bytes(with_nan()), {"vertex", "is not finite", "nan"}},
    {"infinity_in_binary_ply", "a.ply", ply_bytes(with_infinity()), {"vertex 5", "inf"}},
    {"index_out_of_range_in_obj",
     "a.obj",
     obj_text(with_index(8)),
     {"a.obj:", "f names vertex 9 of 8"}},
    {"no_number_in_obj",
     "a.obj",
     "v 0 0 0\nv 1 x 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
     {"a.obj:2:5: v needs three numbers"}},
    {"no_number_in_ply",
     "a.ply",
     "ply\nformat ascii 1.0\ncomment q\nelement vertex 3\nproperty float x\nproperty float y\n"
     "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
     "0 0 0\n1 0 0\n0 q 0\n3 0 1 2\n",
     {":13:3: 'q' is not a number"}},
    {"no_number_in_off",
     "a.off",
     "OFF  # counts: vertices, faces, edges\n# of them\n3 1 0\n0 0 0\n1 0 0\n0 1 z\n3 0 1 2\n",
     {":6:5: 'z' is not a number"}},
    {"no_number_in_stl",
     "a.stl",
     "solid the vertex x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 x 0\n"
     "vertex 0 1 0\nendloop\nendfacet\nendsolid\n",
     {":5:10: 'x' is not a number"}},
    {"nan_of_obj_in_its_line", "a.obj", "v 0 nan 0\n" + obj_text(with_nan()), {"a.obj:1:5: v has"}},
    {"word_in_a_face_of_obj", "a.obj", obj_text(cube()) + "f 1 q 2\n", {"f holds what is no"}},
    {"index_zero_in_obj", "a.obj", obj_text(cube()) + "f 0 1 2\n", {"f names vertex 0"}},
    {"index_out_of_range_in_ply", "a.ply", ply_text(with_index(8)), {}},
    {"index_far_out_of_range_in_ply", "a.ply", ply_bytes(with_index(2'000'000'000)), {}},
    {"negative_index_in_ply", "a.ply", ply_bytes(with_index(-1)), {}},
    {"index_out_of_range_in_off", "a.off", off_text(with_index(8)), {}},
    {"index_out_of_range_in_glb", "a.glb", glb_bytes(with_index(8)), {}},
    {"index_out_of_range_in_3ds", "a.3ds", a3ds_bytes(with_index(8)), {}},
    {"index_out_of_range_in_dae", "a.dae", dae_text(with_index(8)), {}},
    {"index_out_of_range_in_fbx", "a.fbx", fbx_text(with_index(8)), {}},
    {"zero_triangles", "a.ply", ply_text(without_triangles()), {"no triangles"}},
    {"zero_vertices", "a.off", "OFF\n0 0 0\n", {"no vertices"}},
    {"open", "a.obj", obj_text(without_first_triangle()), {"3 boundary edges", "edge ", "from ("}},
    {"non_manifold_edge",
     "a.ply",
     ply_text(both(cube(), moved(cube(), {2.0, 2.0, 0.0}))),
     {"1 edge with three triangles or more", "(1, 1, -1)", "(1, 1, 1)"}},
    {"non_manifold_vertex",
     "a.ply",
     ply_text(both(cube(), moved(cube(), {2.0, 2.0, 2.0}))),
     {"1 vertex at which several fans", "(1, 1, 1)"}},
    {"two_components",
     "a.ply",
     ply_text(both(cube(), moved(cube(), {5.0, 0.0, 0.0}))),
     {"2 components", "1: 8 vertices", "2: 8 vertices"}},
    {"mixed_units",
     "a.ply",
     ply_text(both(cube(), moved(scaled(cube(), 1000.0), {5000.0, 0.0, 0.0}))),
     {"2 components", "2 x 2 x 2", "2000 x 2000 x 2000"}},
    {"scale_of_1e9", "a.ply", ply_text(scaled(cube(), 1e9)), {"3.46e+09 m across", "model.scale"}},
    {"scale_of_1e_9", "a.ply", ply_text(scaled(cube(), 1e-9)), {"e-09 m across", "model.scale"}},
    {"huge_counts_in_ply",
     "a.ply",
     replaced(ply_bytes(cube()), "element vertex 8", "element vertex 4000000000"),
     {"announces 4000000000 vertices", "bytes"}},
    {"huge_counts_of_faces_in_ply",
     "a.ply",
     replaced(ply_text(cube()), "element face 12", "element face 99999999999"),
     {"announces 99999999999 faces"}},
    {"count_that_is_no_number",
     "a.ply",
     replaced(ply_text(cube()), "element face 12", "element face -12"),
     {"no number"}},
    {"huge_counts_in_off",
     "a.off",
     replaced(off_text(cube()), "8 12 0", "800000000 12 0"),
     {"announces 800000000 vertices"}},
    {"huge_counts_in_stl",
     "a.stl",
     stl_bytes(cube()).replace(80, 4, "\xff\xff\xff\xff"),
     {"announces 4294967295 triangles"}},
    {"huge_counts_in_glb",
     "a.glb",
     replaced(glb_bytes(cube()), R"("count":8)", R"("count":999999999)"),
     {}},
    {"self_touching", "a.obj", obj_text(dented()), {"touches itself", "pairs of triangles"}},
    {"empty", "a.obj", "", {"the file is empty"}},
    {"noise_as_obj", "a.obj", noise(5000), {}},
    {"noise_as_ply", "a.ply", noise(5000), {"does not begin with the word ply"}},
    {"noise_as_stl", "a.stl", noise(5000), {}},
    {"noise_as_off", "a.off", noise(5000), {"does not begin with the word OFF"}},
    {"noise_as_gltf", "a.gltf", noise(5000), {}},
    {"noise_as_glb", "a.glb", "glTF" + noise(5000), {}},
    {"noise_as_3ds", "a.3ds", "MM" + noise(5000), {}},
    {"noise_as_dae", "a.dae", noise(5000), {}},
    {"noise_as_fbx", "a.fbx", "Kaydara FBX Binary  " + noise(5000), {}},
    {"another_format", "a.ply", obj_text(cube()), {"does not begin with the word ply"}},
};

/// Not one of these: every test's process makes them all, which would take most of its time.
Broken model_of_too_many_vertices() {
  return {"too_many_vertices",
          "a.off",
          off_text(sim::make_sphere(1.0, 400, 300)),
          {"119702 vertices are more than the limit of 100000"}};
}

class BrokenModelTest : public testing::TestWithParam<Broken> {};

INSTANTIATE_TEST_SUITE_P(Models, BrokenModelTest, testing::ValuesIn(broken_models),
                         [](const auto& broken) { return broken.param.name; });

/// `message` without its path has all the parts, and is no longer than people read.
void expect_message(const std::string& message, const std::filesystem::path& path,
                    const Strings& expected) {
  EXPECT_TRUE(message.find(path.string() + ":") != std::string::npos) << message;
  EXPECT_GT(message.size(), path.string().size() + 10) << message;
  EXPECT_LT(message.size(), 2000u) << message;
  for (const std::string& part : expected) {
    EXPECT_NE(message.find(part), message.npos) << "'" << part << "' in: " << message;
  }
}

void expect_refusal(const Broken& broken) {
  const TemporaryFolder folder;
  const auto path = folder / broken.file;
  write_text(path, broken.content);
  write_text(folder / "it.bin", gltf_buffer(cube()));
  try {
    load_model(path);
    FAIL() << "accepted";
  } catch (const ModelError& error) {
    expect_message(error.what(), path, broken.expected);
  }
}

void expect_program_to_refuse(const Broken& broken, const std::string& of_a_model_file = "") {
  const TemporaryFolder folder;
  const auto path = folder / broken.file, errors = folder / "errors", out = folder / "out";
  write_text(path, broken.content);
  write_text(folder / "it.bin", gltf_buffer(cube()));
  for (const std::string& arguments :
       {fmt::format("check --json '{}' {}", path.string(), of_a_model_file),
        fmt::format("render model --quiet --out '{}' --set model.file='{}'", out.string(),
                    path.string())}) {
    const ProgramResult said = run_pneuma(fmt::format("{} 2>'{}'", arguments, errors.string()));
    EXPECT_EQ(said.exit_code, 3) << arguments;
    EXPECT_EQ(said.output, "") << arguments;
    expect_message(read_text(errors), path, broken.expected);
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_P(BrokenModelTest, IsRefusedWithAReason) { expect_refusal(GetParam()); }

TEST_P(BrokenModelTest, EndsTheProgramWithAReasonAndNothingElse) {
  expect_program_to_refuse(GetParam());
}

TEST(BrokenModel, OfTooManyVerticesIsRefused) {
  const Broken broken = model_of_too_many_vertices();
  expect_refusal(broken);
  // Without the option it is simplified to what is allowed.
  expect_program_to_refuse(broken, "--vertices 150000");
}

TEST(BrokenModel, OfAKnownLineIsNotSaidTwice) {
  const TemporaryFolder folder;
  const auto path = folder / "a.obj";
  write_text(path, "v 0 0 0\nv 1 0\nf 1 2 1\n");
  try {
    load_model(path);
    FAIL() << "accepted";
  } catch (const ModelError& error) {
    EXPECT_EQ(error.what(), path.string() + ":2:6: v needs three numbers");
  }
}

/// Of what may be wrong with a model, this alone can be mended without a guess.
TEST(BrokenModel, InsideOutIsMendedAndSaid) {
  const TemporaryFolder folder;
  sim::TriangleMesh mesh = cube();
  for (sim::Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  write_text(folder / "inside_out.ply", ply_text(mesh));
  const ProgramResult said = run_pneuma("check '" + (folder / "inside_out.ply").string() + "'");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.output.find("12 triangles turned"), said.output.npos) << said.output;
}

TEST(BrokenModel, FilesThatCannotBeRead) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.ply");
  write_text(folder / "cube.txt", ply_text(cube()));
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      load_model(folder / name);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "accepted";
  };
  expect_message(refusal("folder.ply"), folder / "folder.ply", {"is a folder"});
  expect_message(refusal("gone.ply"), folder / "gone.ply", {"cannot be opened: No such file"});
  expect_message(refusal("cube.txt"), folder / "cube.txt",
                 {"'.txt'", "obj, ply, stl, off, gltf, glb, 3ds, dae or fbx"});
}

TEST(BrokenModel, TheProgramSaysSoAndNothingElse) {
  const TemporaryFolder folder;
  write_text(folder / "open.ply", ply_text(without_first_triangle()));
  write_text(folder / "index.ply", ply_bytes(with_index(2'000'000'000)));
  for (const char* name : {"open.ply", "index.ply", "gone.ply"}) {
    const std::string path = (folder / name).string();
    for (const std::string& arguments :
         {"check " + path, "check --json " + path, "check model --set model.file=" + path,
          "render model --quiet --out " + (folder / "out").string() +
              " --set model.file=" + path}) {
      const ProgramResult said = run_pneuma(arguments + " 2>/dev/null");
      EXPECT_EQ(said.exit_code, 3) << arguments;
      EXPECT_EQ(said.output, "") << arguments;
      const ProgramResult message = run_pneuma(arguments + " 2>&1");
      // A model of a scene is blamed on what named it.
      const bool of_scene = arguments.find("--set ") != std::string::npos;
      EXPECT_TRUE(message.output.starts_with((of_scene ? "--set model.file=" : "") + path))
          << message.output;
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace pneuma::assets
