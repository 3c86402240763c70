#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

MeshTopology topology_of(const TriangleMesh& mesh) {
  return MeshTopology(static_cast<int>(mesh.vertices.size()), mesh.triangles);
}

struct NamedMesh {
  const char* name;
  TriangleMesh mesh;
  int vertices, edges, triangles;
};

std::vector<NamedMesh> all_meshes() {
  return {{"sphere", make_sphere(3.0, 8, 8), 58, 168, 112},
          {"torus", make_torus(4.0, 1.5, 16, 16), 256, 768, 512},
          {"cube", make_box({1.0, 2.0, 3.0}, 1), 8, 18, 12},
          {"divided box", make_box({1.0, 2.0, 3.0}, 3), 56, 162, 108},
          {"icosphere", make_icosphere(2.0, 2), 162, 480, 320}};
}

TEST(Mesh, CountsAreThePapersAndEulers) {
  for (const auto& [name, mesh, vertices, edges, triangles] : all_meshes()) {
    const MeshTopology topology = topology_of(mesh);
    EXPECT_EQ(topology.vertex_count(), vertices) << name;
    EXPECT_EQ(topology.edge_count(), edges) << name;
    EXPECT_EQ(topology.triangle_count(), triangles) << name;
    const int genus = std::string(name) == "torus" ? 1 : 0;
    EXPECT_EQ(vertices - edges + triangles, 2 - 2 * genus) << name;
  }
}

/// A box whose diagonals favoured one side would be sheared by its springs.
TEST(Mesh, ABoxOfEvenDivisionsIsItsMirrorImage) {
  const TriangleMesh mesh = make_box({1.0, 2.0, 3.0}, 4);
  const MeshTopology topology = topology_of(mesh);
  const auto key = [](const Vec3& point) {
    return std::array<long, 3>{std::lround(1e6 * point.x()), std::lround(1e6 * point.y()),
                               std::lround(1e6 * point.z())};
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::set<std::set<std::array<long, 3>>> edges, mirrored;
    for (const auto& [from, to] : topology.edges()) {
      Vec3 a = mesh.vertices[at(from)], b = mesh.vertices[at(to)];
      edges.insert({key(a), key(b)});
      a[axis] = -a[axis];
      b[axis] = -b[axis];
      mirrored.insert({key(a), key(b)});
    }
    EXPECT_EQ(edges, mirrored) << axis;
  }
}

TEST(Mesh, EveryEdgeIsUniqueAndJoinsItsTwoTriangles) {
  for (const auto& [name, mesh, vertices, edges, triangles] : all_meshes()) {
    const MeshTopology topology = topology_of(mesh);
    std::map<std::set<int>, std::set<int>> triangles_at;  // by brute force
    for (int t = 0; t < triangles; ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Triangle& corner = topology.triangles()[at(t)];
        triangles_at[{corner[i], corner[(i + 1) % 3]}].insert(t);
        const int edge = topology.triangle_edges()[at(t)][i];
        const auto& ends = topology.edges()[at(edge)];
        EXPECT_EQ((std::set<int>{ends[0], ends[1]}),
                  (std::set<int>{corner[i], corner[(i + 1) % 3]}))
            << name;
      }
    }
    ASSERT_EQ(static_cast<int>(triangles_at.size()), edges) << name;
    for (int e = 0; e < edges; ++e) {
      const auto& [a, b] = topology.edges()[at(e)];
      const auto& [t, u] = topology.edge_triangles()[at(e)];
      EXPECT_LT(a, b);
      EXPECT_EQ((triangles_at[{a, b}]), (std::set<int>{t, u})) << name;
    }
  }
}

/// Starting at its lowest vertex, the way round unchanged.
Triangle from_lowest(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

TEST(Mesh, QuadranglesAreTheTrianglesTwoByTwo) {
  for (const auto& [name, mesh, vertices, edges, triangles] : all_meshes()) {
    const MeshTopology topology = topology_of(mesh);
    std::multiset<Triangle> in_quadrangles, all;
    for (const std::array<RowStart, 4>& rows : topology.quadrangles()) {
      std::array<int, 4> corners;
      std::ranges::transform(rows, corners.begin(),
                             [](RowStart row) { return static_cast<int>(row / row_start(1)); });
      const auto& [a, b, c, d] = corners;
      in_quadrangles.insert(from_lowest({a, b, c}));
      if (d != a) in_quadrangles.insert(from_lowest({a, c, d}));
    }
    for (const Triangle& triangle : topology.triangles()) all.insert(from_lowest(triangle));
    EXPECT_EQ(in_quadrangles, all) << name;
    // Few are left over, or nothing would be gained.
    EXPECT_LT(static_cast<double>(topology.quadrangles().size()), 0.6 * triangles) << name;
  }
}

TEST(Mesh, RingsRunAroundTheirVertexThroughItsTriangles) {
  for (const auto& [name, mesh, vertices, edges, triangles] : all_meshes()) {
    const MeshTopology topology = topology_of(mesh);
    std::size_t corners = 0;
    for (int v = 0; v < vertices; ++v) {
      const auto ring = topology.ring(v);
      corners += ring.size();
      std::set<int> neighbours;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        neighbours.insert(ring[i].vertex);
        const auto& ends = topology.edges()[at(ring[i].edge)];
        EXPECT_EQ(ends[0] + ends[1], v + ring[i].vertex) << name;
        Triangle triangle = topology.triangles()[at(topology.vertex_triangles(v)[i])];
        while (triangle[0] != v)
          std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
        EXPECT_EQ(triangle[1], ring[i].vertex) << name;
        EXPECT_EQ(triangle[2], ring[(i + 1) % ring.size()].vertex) << name;
      }
      EXPECT_EQ(neighbours.size(), ring.size()) << name;
    }
    EXPECT_EQ(corners, static_cast<std::size_t>(3 * triangles)) << name;
  }
}

TEST(Mesh, FeatureNeighboursAreMutualAndOfOtherKinds) {
  const MeshTopology topology = topology_of(make_torus(4.0, 1.5, 6, 5));
  for (int id = 0; id < topology.feature_count(); ++id) {
    const Feature feature = topology.feature(id);
    EXPECT_EQ(topology.feature_id(feature), id);
    EXPECT_EQ(topology.feature_vertices(feature).size(),
              static_cast<std::size_t>(feature.kind) + 1);
    for (const int neighbour : topology.feature_neighbours(id)) {
      EXPECT_NE(topology.feature(neighbour).kind, feature.kind);
      const auto back = topology.feature_neighbours(neighbour);
      EXPECT_EQ(std::count(back.begin(), back.end(), id), 1);
    }
  }
  const Feature triangle = topology.feature(topology.feature_count() - 1);
  EXPECT_EQ(triangle.kind, FeatureKind::triangle);
  EXPECT_EQ(topology.feature_neighbours(topology.feature_id(triangle)).size(), 6u);
}

TEST(Mesh, MeshesThatCannotBeBodiesAreRefusedWithTheOffendingPlace) {
  const auto refusal = [](int vertices, std::vector<Triangle> triangles) -> std::string {
    try {
      MeshTopology(vertices, std::move(triangles));
    } catch (const TopologyError& error) {
      return error.what();
    }
    return "accepted";
  };
  std::vector<Triangle> tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_EQ(refusal(4, tetrahedron), "accepted");
  EXPECT_EQ(refusal(0, {}), "the mesh has no triangles");
  EXPECT_EQ(refusal(3, tetrahedron), "triangle 1 uses vertex 3 of a mesh of 3 vertices");
  EXPECT_EQ(refusal(5, tetrahedron), "vertex 4 belongs to no triangle");
  EXPECT_EQ(refusal(4, {{0, 1, 1}}), "triangle 0 uses vertex 1 twice");

  auto open = tetrahedron;
  open.pop_back();
  EXPECT_EQ(refusal(4, open), "edge 0-2 has one triangle: the mesh is open");
  auto turned = tetrahedron;
  std::swap(turned[0][0], turned[0][1]);
  EXPECT_EQ(refusal(4, turned),
            "edge 0-1 is run through the same way by both its triangles: "
            "the mesh is not consistently oriented");
  auto fin = tetrahedron;
  fin.push_back({0, 1, 4});
  EXPECT_EQ(refusal(5, fin), "edge 0-1 has 3 triangles: the mesh is not manifold");
  auto hourglass = tetrahedron;  // a second tetrahedron on the first one's vertex 3
  for (const Triangle& t : tetrahedron) hourglass.push_back({t[0] + 3, t[1] + 3, t[2] + 3});
  EXPECT_EQ(refusal(7, hourglass),
            "vertex 3 joins two sheets of the surface: the mesh is not manifold");
  TriangleMesh collapsed = make_box({1.0, 1.0, 0.0}, 1);
  EXPECT_THROW(make_soft_mesh(collapsed), TopologyError);
}

TEST(Volume, IsExactForBoxAndTetrahedron) {
  const TriangleMesh box = make_box({1.0, 2.0, 3.0}, 3);
  // Sums of a hundred products of size 1, each rounded once: some 1e-16 relative.
  EXPECT_NEAR(volume(topology_of(box), to_vertex_array(box.vertices)), 6.0, 1e-14);

  const std::vector<Vec3> corners = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}};
  const MeshTopology tetrahedron(4, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  EXPECT_NEAR(volume(tetrahedron, to_vertex_array(corners)), 5.0, 1e-14);
}

TEST(Volume, AgreesWithTheSumOfColumnsUnderEachTriangle) {
  // Divergence theorem with the field (0, 0, z): another sum than a.(b x c).
  for (const auto& [name, mesh, vertices, edges, triangles] : all_meshes()) {
    double columns = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 &p = mesh.vertices[at(a)], &q = mesh.vertices[at(b)], &r = mesh.vertices[at(c)];
      const double mean_height = (p.z() + q.z() + r.z()) / 3.0;
      columns += mean_height * 0.5 *
                 ((q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x()));
    }
    // Rounding of some 500 terms.
    EXPECT_NEAR(volume(topology_of(mesh), to_vertex_array(mesh.vertices)) / columns, 1.0, 1e-13)
        << name;
  }
}

TEST(Volume, KeepsItsDigitsAMillionMetresAway) {
  // Coordinates that are multiples of 2^-20 stay exact when moved by 1e6 (needs 20 + 20 bits), so
  // the volume may change by rounding alone.
  TriangleMesh mesh = make_torus(4.0, 1.5, 16, 16);
  for (Vec3& vertex : mesh.vertices) vertex = (vertex * 0x1p20).array().round().matrix() * 0x1p-20;
  const MeshTopology topology = topology_of(mesh);
  const double near = volume(topology, to_vertex_array(mesh.vertices));
  for (Vec3& vertex : mesh.vertices) vertex += Vec3(1e6, -1e6, 1e6);
  const double far = volume(topology, to_vertex_array(mesh.vertices));
  EXPECT_NEAR(far / near, 1.0, 1e-12);
}

TEST(Measure, IcosphereApproachesTheSphere) {
  const TriangleMesh mesh = make_icosphere(2.0, 5);
  const MeshTopology topology = topology_of(mesh);
  const VertexArray positions = to_vertex_array(mesh.vertices);
  // 20480 triangles inscribed in the sphere: the volume and area fall short by order of their area.
  EXPECT_NEAR(volume(topology, positions), 4.0 / 3.0 * std::numbers::pi * 8.0, 0.001 * 33.5);
  EXPECT_NEAR(surface_area(topology, positions), 4.0 * std::numbers::pi * 4.0, 0.001 * 50.3);
  std::vector<Vec3> normals;
  vertex_normals(topology, positions, normals);
  for (int v = 0; v < positions.size(); ++v) {
    // The normal of a vertex of an almost regular ring is its direction up to the ring's
    // irregularity.
    EXPECT_GT(normals[at(v)].dot(positions[v]) / 2.0, 0.9999);
  }
}

}  // namespace
}  // namespace pneuma::sim
