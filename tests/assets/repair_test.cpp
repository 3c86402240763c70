// Faults that are mended on demand: against closed forms, and by looking at every way.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "assets/clean_mesh.h"
#include "assets/fill_holes.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"
#include "tests/assets/model_writers.h"

namespace pneuma::assets {
namespace {

using sim::at;

CleanModel clean(const sim::TriangleMesh& mesh, bool repair, const std::string& component = "") {
  return clean_mesh({mesh, {}, {}, 0, {}},
                    {.component = component, .centre = false, .repair = repair});
}

std::string refusal(const sim::TriangleMesh& mesh, bool repair) {
  try {
    clean(mesh, repair);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

testing::AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << text << "' has no '" << part << "'";
}

/// What was done, in one text.
std::string repairs(const CleanModel& model) {
  std::string text;
  for (const std::string& done : model.repaired) text += done + "\n";
  return text;
}

TEST(Repair, LeavesAGoodMeshAsItIs) {
  const CleanModel model = clean(crooked_box(), true);
  EXPECT_EQ(model.mesh.vertices, crooked_box().vertices);
  EXPECT_EQ(model.mesh.triangles, crooked_box().triangles);
  EXPECT_TRUE(model.repaired.empty());
}

TEST(Repair, IsWhatARefusalNames) {
  sim::TriangleMesh open = cube();
  open.triangles.pop_back();
  EXPECT_TRUE(holds(refusal(open, false), "--repair (in a scene model.repair = true)"));
  open.triangles.resize(6);
  EXPECT_TRUE(holds(refusal(open, true), "open"));
  EXPECT_TRUE(holds(refusal(open, true), "no repair is known for this"));
  EXPECT_TRUE(holds(refusal(open, true), "1 hole is too large to be closed by a repair, with "));
  EXPECT_TRUE(holds(refusal(open, true), "at most 0.25 times the surface's area"));
}

TEST(Repair, FillsTheHoleOfAFace) {
  for (std::size_t missing : {1u, 2u}) {
    sim::TriangleMesh open = cube();
    open.triangles.resize(12 - missing);
    const CleanModel model = clean(open, true);
    EXPECT_DOUBLE_EQ(enclosed_volume(model.mesh), 8.0);
    EXPECT_TRUE(holds(repairs(model), fmt::format("1 hole filled by {} triangle", missing)));
  }
}

/// The least area of all ways to cut a polygon into triangles, by trying each.
double least_area(const std::vector<Vec3>& polygon) {
  if (polygon.size() < 3) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const std::vector<Vec3> low(polygon.begin(), polygon.begin() + static_cast<long>(k) + 1);
    const std::vector<Vec3> high(polygon.begin() + static_cast<long>(k), polygon.end());
    const double area = sim::area_vector(polygon.front(), polygon[k], polygon.back()).norm();
    least = std::min(least, area + least_area(low) + least_area(high));
  }
  return least;
}

double area_of(const sim::TriangleMesh& mesh, std::size_t from) {
  double area = 0.0;
  for (std::size_t t = from; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    area +=
        sim::area_vector(mesh.vertices[at(a)], mesh.vertices[at(b)], mesh.vertices[at(c)]).norm();
  }
  return area;
}

/// A crooked rim around a dent, so that the ways differ.
TEST(Repair, FillsAHoleByTheLeastArea) {
  sim::TriangleMesh sphere = sim::make_sphere(1.0, 10, 9);
  int pole = 0;
  for (std::size_t v = 0; v < sphere.vertices.size(); ++v) {
    if (sphere.vertices[v].z() > sphere.vertices[at(pole)].z()) pole = static_cast<int>(v);
  }
  std::vector<Vec3> rim;
  std::erase_if(sphere.triangles, [&](const Triangle& triangle) {
    return std::ranges::find(triangle, pole) != triangle.end();
  });
  std::vector<int> around;
  for (const Edge& edge : edges_of(sphere.triangles)) {
    if (edge.triangles.size() == 1)
      around.insert(around.end(), edge.vertices.begin(), edge.vertices.end());
  }
  std::ranges::sort(around, [&](int v, int w) {
    const Vec3 &a = sphere.vertices[at(v)], &b = sphere.vertices[at(w)];
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  around.erase(std::unique(around.begin(), around.end()), around.end());
  ASSERT_EQ(around.size(), 9u);
  for (std::size_t i = 0; i < around.size(); ++i) {
    sphere.vertices[at(around[i])].z() += 0.07 * std::sin(2.0 + 2.3 * static_cast<double>(i));
    rim.push_back(sphere.vertices[at(around[i])]);
  }
  NumberedMesh mesh{sphere, std::vector<int>(sphere.vertices.size(), 0),
                    std::vector<int>(sphere.triangles.size(), 0)};
  const std::size_t before = sphere.triangles.size();
  EXPECT_EQ(fill_holes(mesh).size(), 1u);
  EXPECT_EQ(mesh.mesh.triangles.size(), before + 7);
  EXPECT_NEAR(area_of(mesh.mesh, before), least_area(rim), 1e-12);
}

TEST(Repair, LeavesTheMouthOfABowlOpen) {
  sim::TriangleMesh bowl = sim::make_sphere(1.0, 12, 12);
  std::erase_if(bowl.triangles, [&](const Triangle& triangle) {
    return std::ranges::any_of(triangle, [&](int v) { return bowl.vertices[at(v)].z() > 0.01; });
  });
  EXPECT_TRUE(holds(refusal(bowl, true), "the surface is open"));
  EXPECT_TRUE(holds(refusal(bowl, true), "those of an obstacle"));
  EXPECT_TRUE(holds(refusal(bowl, true), "give a sheet or an open bowl a wall"));
}

TEST(Repair, WeldsACrack) {
  sim::TriangleMesh cracked = cube_of_24();
  for (std::size_t v = 0; v < 4; ++v) cracked.vertices[v].x() += 1e-3;  // the diagonal is 3.5
  EXPECT_TRUE(holds(refusal(cracked, false), "2 components, none of them closed"));
  const CleanModel model = clean(cracked, true);
  EXPECT_EQ(model.mesh.vertices.size(), 8u);
  EXPECT_NEAR(enclosed_volume(model.mesh), 8.0, 4.0 * 1e-3);
  EXPECT_TRUE(holds(repairs(model), "4 vertices at cracks of up to 0.0035 welded to others"));
}

TEST(Repair, SplitsVerticesWhereSurfacesMeetInAPoint) {
  const sim::TriangleMesh two = both(cube(), moved(cube(), {2.0, 2.0, 2.0}));
  EXPECT_TRUE(holds(refusal(two, false), "several fans"));
  const CleanModel first = clean(two, true, "1"), second = clean(two, true, "2");
  EXPECT_TRUE(holds(repairs(first), "1 vertex at which fans of triangles meet split"));
  EXPECT_DOUBLE_EQ(enclosed_volume(first.mesh), 8.0);
  EXPECT_LT(enclosed_volume(second.mesh), 8.0);
  EXPECT_GT(enclosed_volume(second.mesh), 7.5);
}

TEST(Repair, DropsAFin) {
  sim::TriangleMesh finned = cube();
  finned.vertices.push_back({2.0, 2.0, 0.0});
  const auto [a, b, c] = finned.triangles[0];
  finned.triangles.push_back({a, b, static_cast<int>(finned.vertices.size()) - 1});
  EXPECT_TRUE(holds(refusal(finned, false), "three triangles or more"));
  const CleanModel model = clean(finned, true);
  EXPECT_EQ(model.mesh.triangles, cube().triangles);
  EXPECT_TRUE(holds(repairs(model), "1 triangle that stood out of the surface dropped"));
}

/// A vertex in the middle of an edge, on one side of it only: closed by a triangle without area, or
/// left open.
TEST(Repair, RefusesWhatHasNothingButFins) {
  sim::TriangleMesh book;
  book.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  EXPECT_TRUE(holds(refusal(book, true), "no triangle is left after a repair: 3 triangles"));
}

TEST(Repair, TakesOutTrianglesWithoutArea) {
  for (const bool is_closed : {true, false}) {
    sim::TriangleMesh mesh = cube();
    const auto [a, b, c] = mesh.triangles[0];
    const int middle = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(0.5 * (mesh.vertices[at(a)] + mesh.vertices[at(b)]));
    mesh.triangles[0] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
    if (is_closed) mesh.triangles.push_back({a, b, middle});
    EXPECT_TRUE(holds(refusal(mesh, false), is_closed ? "without area" : "open"));
    const CleanModel model = clean(mesh, true);
    EXPECT_DOUBLE_EQ(enclosed_volume(model.mesh), 8.0);
    EXPECT_EQ(model.mesh.vertices.size(), 9u);
    EXPECT_TRUE(holds(repairs(model), "1 triangle without area taken out"));
  }
}

/// A vertex far aside, above the surface, which its triangles reach from below.
sim::TriangleMesh folded_sphere() {
  sim::TriangleMesh sphere = sim::make_icosphere(1.0, 4);
  Vec3& vertex = sphere.vertices[100];
  vertex = 1.0005 * (vertex + 0.13 * vertex.cross(Vec3::UnitX()).normalized()).normalized();
  return sphere;
}

TEST(Repair, PartsASurfaceFromItselfAndLeavesTheRest) {
  const sim::TriangleMesh folded = folded_sphere();
  EXPECT_TRUE(holds(refusal(folded, false), "try --repair"));
  const CleanModel model = clean(folded, true);
  EXPECT_TRUE(holds(repairs(model), "moved to part the surface from itself"));
  std::size_t moved = 0;
  for (std::size_t v = 0; v < folded.vertices.size(); ++v) {
    if (model.mesh.vertices[v] != folded.vertices[v]) ++moved;
  }
  EXPECT_TRUE(holds(repairs(model), fmt::format("{} vertices moved", moved)));
  EXPECT_LT(moved, 60u);
  EXPECT_NEAR(enclosed_volume(model.mesh), enclosed_volume(sim::make_icosphere(1.0, 4)), 0.01);
}

TEST(Repair, RefusesWhatWouldNeedMuchSmoothing) {
  // A torus whose tube is thicker than its hole is wide.
  const sim::TriangleMesh torus = sim::make_torus(1.0, 0.9, 24, 24);
  sim::TriangleMesh fat = torus;
  for (Vec3& vertex : fat.vertices) {
    const Vec3 ring = Vec3(vertex.x(), vertex.y(), 0.0).normalized();
    vertex = ring + 1.5 * (vertex - ring);
  }
  EXPECT_EQ(refusal(torus, false), "");
  const std::string message = refusal(fat, true);
  EXPECT_TRUE(holds(message, "the surface touches itself"));
  EXPECT_EQ(message.find("--repair"), std::string::npos) << message;
}

}  // namespace
}  // namespace pneuma::assets
