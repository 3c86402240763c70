#include "sim/soft/bending.h"

#include <array>
#include <cmath>

#include "sim/mesh/rotation.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

using Vec12 = Eigen::Matrix<double, 12, 1>;

/// A hinge as it is bent now.
struct Bent {
  Vec4d edge;                            // b - a
  Vec4d to_first, to_second;             // from a to c and d
  Vec4d first, second;                   // twice the area vectors of the triangles
  double squared_first, squared_second;  // of their lengths
  double length = 0.0;                   // of the edge
  double cosine = 1.0, sine = 0.0;       // of t - t0
  bool is_flat() const { return !(squared_first > 0.0 && squared_second > 0.0); }  // a triangle is
};

Bent bend(const HingeTable::Corners& corners, const HingeAngle& rest, const VertexReader& x) {
  Bent bent;
  const Vec4d a = x[corners[0]];
  bent.edge = x[corners[1]] - a;
  bent.to_first = x[corners[2]] - a;
  bent.to_second = x[corners[3]] - a;
  bent.first = cross(bent.edge, bent.to_first);
  bent.second = cross(bent.to_second, bent.edge);
  bent.squared_first = dot(bent.first, bent.first);
  bent.squared_second = dot(bent.second, bent.second);
  if (bent.is_flat()) return bent;
  bent.length = std::sqrt(dot(bent.edge, bent.edge));
  const double scale = 1.0 / std::sqrt(bent.squared_first * bent.squared_second);
  const double cosine = scale * dot(bent.first, bent.second);
  const double sine = scale / bent.length * dot(cross(bent.first, bent.second), bent.edge);
  bent.cosine = cosine * rest.cosine + sine * rest.sine;
  bent.sine = sine * rest.cosine - cosine * rest.sine;
  return bent;
}

/// dt/dx of the four corners. A triangle turns about the edge when its third corner moves along its
/// normal, by 1 / height; the ends of the edge take the opposite of that, each by how near it is.
struct AngleGradient {
  Vec4d a, b, c, d;
};

AngleGradient angle_gradient(const Bent& bent) {
  const Vec4d first = (bent.length / bent.squared_first) * bent.first;
  const Vec4d second = (bent.length / bent.squared_second) * bent.second;
  const double squared = bent.length * bent.length;
  const double f = dot(bent.to_first, bent.edge) / squared;
  const double s = dot(bent.to_second, bent.edge) / squared;
  return {(1.0 - f) * first + (1.0 - s) * second, f * first + s * second, -first, -second};
}

Vec12 stacked(const AngleGradient& gradient) {
  const std::array rows = {gradient.a, gradient.b, gradient.c, gradient.d};
  Vec12 result;
  for (int i = 0; i < 12; ++i) result[i] = rows[at(i / 3)][i % 3];
  return result;
}

/// Adds what one triangle, of the normal n with its third corner `apex` from a, adds to d^2t/dx^2.
/// Its gradient is l w, w = n / |n|^2, negative at the apex and divided between the ends of the
/// edge by where the apex is along it; every factor is derived in turn. `third`: 2 or 3, which
/// corner the apex is; `sign`: of n = sign edge x apex.
void add_angle_hessian(const Vec3& edge, const Vec3& apex, double sign, int third,
                       HingeHessian& result) {
  using Change = Eigen::Matrix<double, 3, 12>;
  using Row = Eigen::Matrix<double, 1, 12>;
  Change of_edge = Change::Zero(), of_apex = Change::Zero();
  of_edge.middleCols<3>(0) = of_apex.middleCols<3>(0) = -Mat3::Identity();
  of_edge.middleCols<3>(3).setIdentity();
  of_apex.middleCols<3>(3 * third).setIdentity();

  const Vec3 normal = sign * edge.cross(apex);
  const double squared = normal.squaredNorm();
  const Change of_normal = sign * (cross_matrix(edge) * of_apex - cross_matrix(apex) * of_edge);
  const Vec3 w = normal / squared;
  const Change of_w = (of_normal - 2.0 * w * (normal.transpose() * of_normal)) / squared;

  const double length = edge.norm();
  const Vec3 along = edge / length;
  const Row of_length = along.transpose() * of_edge;
  const Change of_along = (of_edge - along * of_length) / length;
  const double to_b = apex.dot(along), to_a = length - to_b;  // the fractions times l
  const Row of_to_b = along.transpose() * of_apex + apex.transpose() * of_along;
  const Row of_to_a = of_length - of_to_b;

  result.middleRows<3>(0) += w * of_to_a + to_a * of_w;
  result.middleRows<3>(3) += w * of_to_b + to_b * of_w;
  result.middleRows<3>(3 * third) -= w * of_length + length * of_w;
}

}  // namespace

double bending_energy(const SoftMesh& mesh, const VertexArray& positions, double rigidity) {
  if (!mesh.hinges || rigidity == 0.0) return 0.0;
  const HingeTable& hinges = *mesh.hinges;
  const VertexReader x(positions);
  double sum = 0.0;
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    const Bent bent = bend(hinges.corners[e], hinges.rest[e], x);
    // 1 - cosine, which near the rest angle would be rounding.
    sum += hinges.weights[e] *
           (bent.cosine > 0.0 ? bent.sine * bent.sine / (1.0 + bent.cosine) : 1.0 - bent.cosine);
  }
  return rigidity * sum;
}

void add_bending_forces(const SoftMesh& mesh, const VertexArray& positions, double rigidity,
                        int stride, VertexArray& forces) {
  if (!mesh.hinges || rigidity == 0.0) return;
  const HingeTable& hinges = *mesh.hinges;
  const VertexReader x(positions), force(forces);
  const VertexWriter out(forces);
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    const HingeTable::Corners& corners = hinges.corners[e];
    const Bent bent = bend(corners, hinges.rest[e], x);
    if (bent.is_flat()) continue;
    const double torque = -rigidity * hinges.weights[e] * bent.sine;
    const AngleGradient gradient = angle_gradient(bent);
    const auto add = [&](int v, Vec4d along) {
      out.put(stride * v, fma(torque, along, force[stride * v]));
    };
    add(corners[0], gradient.a);
    add(corners[1], gradient.b);
    add(corners[2], gradient.c);
    add(corners[3], gradient.d);
  }
}

Vec12 hinge_stiffness_root(const SoftMesh& mesh, const VertexArray& positions, double rigidity,
                           int edge) {
  const HingeTable& hinges = *mesh.hinges;
  const Bent bent = bend(hinges.corners[at(edge)], hinges.rest[at(edge)], VertexReader(positions));
  if (bent.is_flat()) return Vec12::Zero();
  return std::sqrt(rigidity * hinges.weights[at(edge)]) * stacked(angle_gradient(bent));
}

/// E'' = K cos(t - t0) dt/dx dt/dx^T + K sin(t - t0) d^2t/dx^2.
HingeHessian hinge_hessian(const SoftMesh& mesh, const VertexArray& positions, double rigidity,
                           int edge) {
  const HingeTable& hinges = *mesh.hinges;
  const Bent bent = bend(hinges.corners[at(edge)], hinges.rest[at(edge)], VertexReader(positions));
  HingeHessian result = HingeHessian::Zero();
  if (bent.is_flat()) return result;
  const Vec3 along = to_vec3(bent.edge);
  add_angle_hessian(along, to_vec3(bent.to_first), 1.0, 2, result);
  add_angle_hessian(along, to_vec3(bent.to_second), -1.0, 3, result);
  const Vec12 gradient = stacked(angle_gradient(bent));
  result *= bent.sine;
  result += bent.cosine * gradient * gradient.transpose();
  return rigidity * hinges.weights[at(edge)] * result;
}

}  // namespace pneuma::sim
