// Which shapes are drawn with sharp edges, and where these are.
#include "app/picture/faceted.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "assets/load_model.h"
#include "sim/mesh/primitives.h"
#include "tests/app/picture/prism.h"
#include "tests/support/paths.h"

namespace pneuma::app {
namespace {

sim::SoftMesh prism(double height) { return *sim::make_soft_mesh(make_prism(height)); }

TEST(Faceted, IsWhatBendsAtSharpEdgesForTheMostPart) {
  EXPECT_TRUE(is_faceted(*sim::make_soft_mesh(sim::make_box({2.0, 2.0, 2.0}, 3))));
  // Of 2 x 2 pi m of sharp rims to 24 sides of a height: 0.39 with a height of 0.8 m.
  EXPECT_TRUE(is_faceted(prism(0.8)));
  EXPECT_FALSE(is_faceted(prism(2.0)));
  EXPECT_FALSE(is_faceted(*sim::make_soft_mesh(sim::make_sphere(1.0, 8, 8))));
}

TEST(FlatFaces, AreFoundHoweverFewTheirEdges) {
  for (const double height : {0.8, 8.0, 100.0}) EXPECT_TRUE(has_flat_faces(prism(height)));
  EXPECT_TRUE(has_flat_faces(*sim::make_soft_mesh(sim::make_box({2.0, 2.0, 2.0}, 3))));
  EXPECT_FALSE(has_flat_faces(*sim::make_soft_mesh(sim::make_sphere(1.0, 16, 16))));
  // Of an icosahedron all edges bend by 41.8 degrees, and of the cat many by more.
  EXPECT_FALSE(has_flat_faces(*sim::make_soft_mesh(sim::make_icosphere(1.0, 0))));
  const auto cat = assets::load_model(project_folder() / "assets" / "cat_500.ply");
  EXPECT_FALSE(has_flat_faces(*sim::make_soft_mesh(cat.mesh)));
}

/// How many normals the corners have at each vertex; no two vertices may share one.
std::map<std::size_t, int> vertices_by_normals(const sim::SoftMesh& mesh) {
  std::map<int, std::set<std::uint32_t>> at_vertex;
  std::map<std::uint32_t, int> vertex_of;
  const auto normals = corner_normals(mesh);
  for (std::size_t t = 0; t < normals.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int vertex = mesh.topology.triangles()[t][i];
      at_vertex[vertex].insert(normals[t][i]);
      EXPECT_EQ(vertex_of.emplace(normals[t][i], vertex).first->second, vertex);
      EXPECT_LT(normals[t][i], 3 * normals.size());
    }
  }
  std::map<std::size_t, int> counts;
  for (const auto& [vertex, numbers] : at_vertex) ++counts[numbers.size()];
  return counts;
}

TEST(CornerNormals, AreAsManyAtAVertexAsSmoothFacesMeetThere) {
  using Counts = std::map<std::size_t, int>;
  // Of 56 vertices 8 corners, 12 x 2 on edges, 6 x 4 within faces.
  EXPECT_EQ(vertices_by_normals(*sim::make_soft_mesh(sim::make_box({2.0, 2.0, 2.0}, 3))),
            (Counts{{1, 24}, {2, 24}, {3, 8}}));
  EXPECT_EQ(vertices_by_normals(prism(0.8)), (Counts{{1, 2}, {2, 48}}));
  EXPECT_EQ(vertices_by_normals(*sim::make_soft_mesh(sim::make_sphere(1.0, 16, 16))),
            (Counts{{1, 242}}));
}

}  // namespace
}  // namespace pneuma::app
