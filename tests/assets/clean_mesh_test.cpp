#include "assets/clean_mesh.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"
#include "tests/assets/model_writers.h"

namespace pneuma::assets {
namespace {

using sim::at;
using Strings = std::vector<std::string>;

CleanModel clean(const sim::TriangleMesh& mesh, const CleanOptions& options = {}) {
  return clean_mesh({mesh, {}, {}, 0, {}}, options);
}

TEST(CleanMesh, LeavesAGoodMeshAsItIs) {
  const sim::TriangleMesh mesh = crooked_box();
  const CleanModel model = clean(mesh, {.centre = false});
  EXPECT_EQ(model.mesh.vertices, mesh.vertices);
  EXPECT_EQ(model.mesh.triangles, mesh.triangles);
  EXPECT_EQ(model.cleaned, Strings());
}

TEST(CleanMesh, WeldsACube) {
  const CleanModel model = clean(cube_of_24());
  EXPECT_EQ(model.mesh.vertices.size(), 8u);
  EXPECT_EQ(model.cleaned, Strings{"24 vertices welded to 8"});
  EXPECT_EQ(model.vertices_before, 24);
}

TEST(CleanMesh, TurnsAnInsideOutCube) {
  sim::TriangleMesh mesh = cube();
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  const CleanModel model = clean(mesh);
  EXPECT_DOUBLE_EQ(enclosed_volume(model.mesh), 8.0);
  EXPECT_EQ(model.cleaned, Strings{"12 triangles turned, so that all face outwards"});
}

TEST(CleanMesh, DropsWhatIsThereTwiceOrNotAtAll) {
  sim::TriangleMesh mesh = cube();
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  const Triangle first = mesh.triangles[0];
  mesh.triangles.push_back({first[1], first[0], first[2]});  // the same three, from behind
  mesh.triangles.push_back({first[0], first[0], first[1]});
  const CleanModel model = clean(mesh, {.centre = false});
  EXPECT_EQ(model.mesh.vertices, cube().vertices);
  EXPECT_EQ(model.mesh.triangles, cube().triangles);
  EXPECT_EQ(model.cleaned, (Strings{"1 degenerate triangle dropped", "1 duplicate triangle dropped",
                                    "1 vertex without triangles dropped"}));
}

TEST(CleanMesh, AVertexWithoutTrianglesMayLieAnywhere) {
  // So far away that, counted from there, the cube's corners are all in one place; and so far that
  // the way cannot be counted in welding distances.
  for (const double distance : {1e20, 1e64, 1e308}) {
    sim::TriangleMesh mesh = cube();
    mesh.vertices.insert(mesh.vertices.begin(), {distance, 0.0, 0.0});
    for (Triangle& triangle : mesh.triangles) {
      for (int& v : triangle) ++v;
    }
    const CleanModel model = clean(mesh, {.centre = false});
    EXPECT_EQ(model.mesh.vertices, cube().vertices);
    EXPECT_EQ(model.mesh.triangles, cube().triangles);
    EXPECT_EQ(model.cleaned, Strings{"1 vertex without triangles dropped"});
  }
}

TEST(CleanMesh, KeepsTheOnlyClosedComponent) {
  sim::TriangleMesh lid = moved(cube(), {10.0, 0.0, 0.0});
  lid.triangles.resize(2);
  const CleanModel model = clean(both(lid, cube()));
  EXPECT_DOUBLE_EQ(enclosed_volume(model.mesh), 8.0);
  EXPECT_EQ(model.kept, 1);
  EXPECT_EQ(model.components.size(), 2u);
  EXPECT_EQ(model.components[0].boundary_edges, 4);  // two triangles that share a side
  EXPECT_EQ(model.cleaned.back(), "1 other component left out");
}

TEST(CleanMesh, KeepsTheComponentThatIsNamed) {
  Model model;
  model.mesh = both(cube(), moved(scaled(cube(), 0.5), {10.0, 0.0, 0.0}));
  model.parts.assign(12, 0);
  model.parts.resize(24, 1);
  model.part_names = {"big", "small"};
  EXPECT_DOUBLE_EQ(enclosed_volume(clean_mesh(model, {.component = "small"}).mesh), 1.0);
  EXPECT_DOUBLE_EQ(enclosed_volume(clean_mesh(model, {.component = "big"}).mesh), 8.0);
  EXPECT_DOUBLE_EQ(enclosed_volume(clean_mesh(model, {.component = "2"}).mesh), 1.0);
  for (const char* component : {"3", "0", "-1", "medium", "1.0", "99999999999999999999"}) {
    EXPECT_THROW(clean_mesh(model, {.component = component}), ModelError) << component;
  }
  model.part_names[1] = "big";
  EXPECT_THROW(clean_mesh(model, {.component = "big"}), ModelError) << "there are two";
}

TEST(CleanMesh, ScalesThenTurnsThenCentres) {
  const sim::TriangleMesh box = moved(sim::make_box({1.0, 2.0, 3.0}, 1), {7.0, 8.0, 9.0});
  const auto size = [&](const CleanOptions& options) {
    sim::Bounds bounds;
    for (const Vec3& v : clean(box, options).mesh.vertices) bounds.include(v);
    return bounds;
  };
  // A quarter turn is not exact: cos(pi/2) is 6e-17 in doubles.
  const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-13; };
  EXPECT_TRUE(near(size({.scale = 2.0}).size(), {2.0, 4.0, 6.0}));
  EXPECT_TRUE(near(size({.scale = 2.0}).centre(), Vec3::Zero()));
  EXPECT_TRUE(near(size({.rotation = {90.0, 0.0, 0.0}}).size(), {1.0, 3.0, 2.0}));
  EXPECT_TRUE(near(size({.rotation = {0.0, 0.0, 90.0}}).size(), {2.0, 1.0, 3.0}));
  // x first: y takes the place of z, and then z turns x and y.
  EXPECT_TRUE(near(size({.rotation = {90.0, 0.0, 90.0}}).size(), {3.0, 1.0, 2.0}));
  EXPECT_TRUE(near(size({.centre = false}).centre(), {7.0, 8.0, 9.0}));
  EXPECT_TRUE(
      near(size({.rotation = {0.0, 0.0, 90.0}, .centre = false}).centre(), {-8.0, 7.0, 9.0}));
}

std::string cleaning_refusal(const sim::TriangleMesh& mesh, const CleanOptions& options = {}) {
  try {
    clean(mesh, options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

void expect_refusal(const sim::TriangleMesh& mesh, const Strings& fragments,
                    const CleanOptions& options = {}) {
  const std::string message = cleaning_refusal(mesh, options);
  for (const std::string& fragment : fragments) {
    EXPECT_NE(message.find(fragment), message.npos) << "'" << fragment << "' in: " << message;
  }
}

TEST(CleanMesh, RefusesWhatIsNoMesh) {
  expect_refusal({}, {"no triangles"});
  expect_refusal({{{0, 0, 0}}, {{0, 0, 0}}}, {"all triangles are in one place, (0, 0, 0)"});
  expect_refusal({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}}}, {"not degenerate"});
  sim::TriangleMesh mesh = cube();
  mesh.triangles[3][1] = 8;
  expect_refusal(mesh, {"triangle 3 uses vertex 8, but there are 8 vertices"});
  mesh.triangles[3][1] = -1;
  expect_refusal(mesh, {"triangle 3 uses vertex -1"});
  mesh = cube();
  mesh.vertices[5].y() = std::nan("");
  expect_refusal(mesh, {"vertex 5 is not finite", "nan"});
  mesh.vertices[5].y() = 1e308;
  expect_refusal(mesh, {"across"});
}

TEST(CleanMesh, SaysWhereASurfaceIsOpen) {
  sim::TriangleMesh mesh = cube();
  mesh.triangles.erase(mesh.triangles.begin());
  const std::string message = cleaning_refusal(mesh);
  EXPECT_NE(message.find("3 boundary edges"), message.npos) << message;
  // The three sides of the triangle that is gone, with their ends.
  for (std::size_t i = 0; i < 3; ++i) {
    const Triangle gone = cube().triangles[0];
    const auto [low, high] = std::minmax(gone[i], gone[(i + 1) % 3]);
    const std::string edge = "edge " + std::to_string(low) + "-" + std::to_string(high) + " from (";
    EXPECT_NE(message.find(edge), message.npos) << edge << " in: " << message;
  }
  // At most five places of many.
  sim::TriangleMesh sieve = sim::make_sphere(1.0, 16, 16);
  for (std::size_t t = 0; t < sieve.triangles.size() / 8; ++t) {
    sieve.triangles.erase(sieve.triangles.begin() + static_cast<std::ptrdiff_t>(6 * t));
  }
  const std::string many = cleaning_refusal(sieve);
  std::size_t places = 0;
  for (std::size_t i = many.find("edge "); i != many.npos; i = many.find("edge ", i + 1)) {
    if (std::isdigit(static_cast<unsigned char>(many[i + 5])) != 0) ++places;
  }
  EXPECT_EQ(places, 5u) << many;
}

TEST(CleanMesh, NumbersPlacesAsTheInputDoes) {
  sim::TriangleMesh mesh = cube_of_24();
  mesh.triangles.pop_back();
  const std::string message = cleaning_refusal(mesh);
  // Whatever three edges are open, their vertices are among the input's first 24 and are at a
  // corner of the cube.
  EXPECT_NE(message.find("3 boundary edges"), message.npos) << message;
  EXPECT_NE(message.find("1, "), message.npos) << message;
}

TEST(CleanMesh, RefusesWhatIsNotManifold) {
  // Two cubes that share the edge from (1, 1, -1) to (1, 1, 1).
  expect_refusal(both(cube(), moved(cube(), {2.0, 2.0, 0.0})),
                 {"not manifold: 1 edge with three triangles or more", "(1, 1, -1)", "(1, 1, 1)"},
                 {.component = "1"});
  // Two cubes that share the vertex (1, 1, 1).
  expect_refusal(both(cube(), moved(cube(), {2.0, 2.0, 2.0})),
                 {"1 vertex at which several fans of triangles meet", "at (1, 1, 1)"});
}

TEST(CleanMesh, RefusesAKleinBottle) {
  // A torus of n x n squares whose last row is joined to the first the wrong way round. It runs
  // through itself too, but that it has one side is seen first.
  constexpr int n = 8;
  sim::TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = 2.0 * std::numbers::pi * i / n, v = 2.0 * std::numbers::pi * j / n;
      mesh.vertices.push_back(
          {(3.0 + std::cos(v)) * std::cos(u), (3.0 + std::cos(v)) * std::sin(u), std::sin(v)});
    }
  }
  const auto index = [](int i, int j) { return i < n ? n * i + (j % n) : (2 * n - j) % n; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  expect_refusal(mesh, {"one side only", "at which the triangles cannot agree"});
}

TEST(CleanMesh, RefusesASurfaceThroughItself) {
  // A sphere whose north pole is pushed out at the south.
  sim::TriangleMesh mesh = sim::make_icosphere(1.0, 2);
  const auto top = std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                                    [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  top->z() = -1.5;
  expect_refusal(mesh, {"touches itself", "pairs of triangles meet", "triangle "});
}

TEST(CleanMesh, RefusesFlatTrianglesAndFlatBodies) {
  // A tetrahedron with a vertex in the middle of one of its edges, moved off it by next to nothing.
  sim::TriangleMesh needle = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 1e-8, 1e-8}},
                              {{0, 4, 3}, {4, 1, 3}, {0, 2, 1}, {0, 1, 4}, {0, 3, 2}, {1, 2, 3}}};
  expect_refusal(needle, {"1 triangle without area", "triangle 3 at (0.5,"});
  // A double tetrahedron so low that its triangles are not flat by themselves but its inside is.
  sim::TriangleMesh slab = sim::make_box({1.0, 1.0, 1e-9}, 1);
  EXPECT_NE(cleaning_refusal(slab), "no error");
}

/// A scale of 0 welds the two sides of a body into one layer, here of a ball and of a cube.
TEST(CleanMesh, SaysThatAModelIsFlat) {
  for (const int axis : {0, 1, 2}) {
    for (sim::TriangleMesh mesh : {sim::make_icosphere(1.0, 1), cube()}) {
      for (Vec3& vertex : mesh.vertices) vertex[axis] = 0.0;
      const std::string along = fmt::format("the model is flat: its extent along {} is 0, of ",
                                            std::string_view("xyz")[sim::at(axis)]);
      for (const bool repair : {false, true}) expect_refusal(mesh, {along}, {.repair = repair});
    }
  }
}

TEST(CleanMesh, RefusesWhatIsTooLargeOrTooSmallAndSaysAScale) {
  expect_refusal(scaled(cube(), 1e9), {"across", "1e-06 m to 1e+06 m", "model.scale"});
  expect_refusal(scaled(cube(), 1e-9), {"across", "model.scale"});
  EXPECT_NO_THROW(clean(scaled(cube(), 1e9), {.scale = 1e-9}));
  EXPECT_NO_THROW(clean(scaled(cube(), 1e-9), {.scale = 1e9}));
  expect_refusal(moved(cube(), {1e7, 0.0, 0.0}), {"further than"}, {.centre = false});
  EXPECT_NO_THROW(clean(moved(cube(), {1e7, 0.0, 0.0})));
  expect_refusal(sim::make_icosphere(1.0, 3), {"642 vertices are more than the limit of 600"},
                 {.most_vertices = 600});
  EXPECT_NO_THROW(clean(sim::make_icosphere(1.0, 3), {.most_vertices = 642}));
}

TEST(CleanMesh, ListsTheComponentsWhenItCannotChoose) {
  expect_refusal(both(cube(), moved(scaled(cube(), 1000.0), {5000.0, 0.0, 0.0})),
                 {"2 components", "1: 8 vertices, 12 triangles, 2 x 2 x 2, closed",
                  "2: 8 vertices, 12 triangles, 2000 x 2000 x 2000, closed", "model.component"});
}

// Any triangles on few points: either refused, or fit for a soft body.
RC_GTEST_PROP(CleanMesh, WhatItAcceptsIsASoftBody, ()) {
  const auto coordinate =
      rc::gen::map(rc::gen::inRange(0, 3), [](int i) { return double{0.5} * i; });
  sim::TriangleMesh mesh;
  mesh.vertices = *rc::gen::container<std::vector<Vec3>>(
      8, rc::gen::apply([](double x, double y, double z) { return Vec3(x, y, z); }, coordinate,
                        coordinate, coordinate));
  const auto index = rc::gen::inRange(0, 8);
  mesh.triangles = *rc::gen::container<std::vector<Triangle>>(rc::gen::apply(
      [](int a, int b, int c) {
        return Triangle{a, b, c};
      },
      index, index, index));
  try {
    const CleanModel model = clean(mesh);
    RC_ASSERT(enclosed_volume(model.mesh) > 0.0);
  } catch (const ModelError&) {
    RC_ASSERT(true);
  }
}

// A good mesh spoilt in ways that can be mended: shuffled, turned, split at its corners.
RC_GTEST_PROP(CleanMesh, MendsWhatWasGood, ()) {
  const sim::TriangleMesh good = *rc::gen::element(
      cube(), crooked_box(), sim::make_torus(5.0, 2.0, 5, 4), sim::make_icosphere(1.0, 1));
  sim::TriangleMesh spoilt;
  for (const Triangle& triangle : good.triangles) {
    Triangle corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = static_cast<int>(spoilt.vertices.size());
      spoilt.vertices.push_back(good.vertices[at(triangle[i])]);
    }
    if (*rc::gen::arbitrary<bool>()) std::swap(corners[1], corners[2]);
    const int copies = *rc::gen::inRange(1, 3);
    for (int i = 0; i < copies; ++i) spoilt.triangles.push_back(corners);
  }
  const CleanModel model = clean(spoilt);
  RC_ASSERT(model.mesh.vertices.size() == good.vertices.size());
  RC_ASSERT(model.mesh.triangles.size() == good.triangles.size());
  // Summed in another order, about another point.
  RC_ASSERT(std::abs(enclosed_volume(model.mesh) - enclosed_volume(good)) <=
            1e-12 * enclosed_volume(good));
}

}  // namespace
}  // namespace pneuma::assets
