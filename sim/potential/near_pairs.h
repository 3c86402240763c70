// The pairs of features that the contact potential is a sum over, and which of them may come within
// its reach on their ways.
#pragma once

#include <array>
#include <vector>

#include "sim/potential/contact_surfaces.h"
#include "sim/swept/moving_surface.h"

namespace pneuma::sim {

/// A vertex and a triangle (the vertex first), or two edges. Features that share a vertex are no
/// pair, nor are those of which no vertex is moved by forces.
struct ContactPair {
  std::array<int, 4> vertices{};  // in the array of all surfaces
  bool is_edges = false;
  int first = 0;  // surfaces; the same for a pair of one surface
  int second = 0;
  double weight = 0.0;     // m^2, for which the pair stands
  double reach = 0.0;      // m
  double mollifier = 0.0;  // m^4: of edges, the squared cross product below which they count less
  double restitution = 0.0;
  double friction = 0.0;
};

/// Finds pairs by bounding hierarchies.
class PairFinder {
 public:
  /// Refers to the surfaces, which must outlive it.
  explicit PairFinder(const ContactSurfaces& surfaces);

  /// Fills `pairs` with all that come within their reach while every vertex is anywhere within
  /// `margin` (m) of its straight way, and some more, each once, in an order by their vertices
  /// alone.
  void find(const VertexArray& from, const VertexArray& to, double margin,
            std::vector<ContactPair>& pairs);

 private:
  void add(int first, int second, std::vector<ContactPair>& pairs);

  const ContactSurfaces& surfaces_;
  std::vector<MovingSurface> moving_;
  std::vector<NearFeatures> near_;
};

/// The weight in m^2 of a vertex and a triangle: half of the vertex' area, as both surfaces have
/// vertices, and of two edges. Two sheets of area A at a distance d have the energy A kappa reach
/// f(d / reach) by their vertices, whatever their meshes, and once more by their edges, as straight
/// lines cross each other on average.
double vertex_weight(double vertex_area, double triangle_area);
double edge_weight(double first_length, double second_length);

/// m, between features of a surface that share no vertex, if less than `within`; else that.
double min_self_distance(const ContactSurface& surface, const VertexArray& positions,
                         double within);

}  // namespace pneuma::sim
