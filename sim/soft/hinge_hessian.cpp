#include <array>
#include <cmath>

#include "sim/mesh/rotation.h"
#include "sim/soft/bending.h"
#include "sim/soft/bent_hinge.h"

namespace pneuma::sim {
namespace {

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Change = Eigen::Matrix<double, 3, 12>;
using Row = Eigen::Matrix<double, 1, 12>;

Vec12 stacked(const HingeGradient& gradient) {
  const std::array rows = {gradient.a, gradient.b, gradient.c, gradient.d};
  Vec12 result;
  for (int i = 0; i < 12; ++i) result[i] = rows[at(i / 3)][i % 3];
  return result;
}

/// One triangle of a hinge, of the normal n = sign edge x apex, and what the corners change of it.
/// `third`: 2 or 3, which corner the apex is.
struct HingeTriangle {
  HingeTriangle(const Vec4d& edge_vector, const Vec4d& to_apex, double normal_sign,
                int third_corner)
      : edge(to_vec3(edge_vector)),
        apex(to_vec3(to_apex)),
        sign(normal_sign),
        third(third_corner),
        normal(sign * edge.cross(apex)) {
    of_edge.middleCols<3>(0) = of_apex.middleCols<3>(0) = -Mat3::Identity();
    of_edge.middleCols<3>(3).setIdentity();
    of_apex.middleCols<3>(3 * third).setIdentity();
    of_normal = sign * (cross_matrix(edge) * of_apex - cross_matrix(apex) * of_edge);
  }

  Vec3 edge, apex;
  double sign;
  int third;
  Vec3 normal;
  Change of_edge = Change::Zero(), of_apex = Change::Zero(), of_normal;
};

/// Adds what it adds to d^2t/dx^2. Its gradient is l w, w = n / |n|^2, negative at the apex and
/// divided between the ends of the edge by where the apex is along it; every factor is derived in
/// turn.
void add_angle_hessian(const HingeTriangle& triangle, HingeHessian& result) {
  const auto& [edge, apex, sign, third, normal, of_edge, of_apex, of_normal] = triangle;
  const double squared = normal.squaredNorm();
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

/// ds/dx and d^2s/dx^2 of it. d^2|n| = (dn . dn - (d|n|)^2) / |n| + n / |n| . d^2n, n being
/// bilinear in edge and apex.
struct WeightDerivatives {
  Vec12 gradient = Vec12::Zero();
  HingeHessian hessian = HingeHessian::Zero();
};
WeightDerivatives weight_derivatives(const HingeTriangle& triangle, double at_rest) {
  WeightDerivatives result;
  const double size = triangle.normal.norm(), fraction = 0.5 * size / at_rest;
  if (fraction >= NormalWeight::flat_fraction) return result;
  const NormalWeight weight(fraction);
  const Vec3 unit = triangle.normal / size;
  const Vec12 of_size = triangle.of_normal.transpose() * unit;
  const HingeHessian bilinear =
      -triangle.sign * triangle.of_edge.transpose() * cross_matrix(unit) * triangle.of_apex;
  const HingeHessian of_of_size =
      (triangle.of_normal.transpose() * triangle.of_normal - of_size * of_size.transpose()) / size +
      bilinear + bilinear.transpose();
  const double scale = 0.5 / at_rest;
  result.gradient = weight.slope() * scale * of_size;
  result.hessian = weight.curvature() * scale * scale * of_size * of_size.transpose() +
                   weight.slope() * scale * of_of_size;
  return result;
}

}  // namespace

Vec12 hinge_stiffness_root(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                           int edge) {
  const BentHinge bent = bend(hinges, at(edge), VertexReader(positions));
  if (bent.is_flat()) return Vec12::Zero();
  return std::sqrt(rigidity * hinges.weights[at(edge)]) * stacked(angle_gradient(bent));
}

/// With s = s1 s2, the derivative K (s sin(t - t0) dt/dx - cos(t - t0) ds/dx) derived again.
HingeHessian hinge_hessian(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                           int edge) {
  const BentHinge bent = bend(hinges, at(edge), VertexReader(positions));
  HingeHessian result = HingeHessian::Zero();
  if (bent.is_flat()) return result;
  const HingeTriangle first(bent.edge, bent.to_first, 1.0, 2);
  const HingeTriangle second(bent.edge, bent.to_second, -1.0, 3);
  add_angle_hessian(first, result);
  add_angle_hessian(second, result);
  const Vec12 gradient = stacked(angle_gradient(bent));
  result *= bent.weight() * bent.sine;
  result += bent.weight() * bent.cosine * gradient * gradient.transpose();
  if (bent.weight() < 1.0) {
    const WeightDerivatives s1 = weight_derivatives(first, bent.areas[0]);
    const WeightDerivatives s2 = weight_derivatives(second, bent.areas[1]);
    const Vec12 of_weight = bent.second_weight * s1.gradient + bent.first_weight * s2.gradient;
    HingeHessian mixed = bent.sine * gradient * of_weight.transpose();
    mixed -= bent.cosine * s1.gradient * s2.gradient.transpose();
    result += mixed + mixed.transpose();
    result -= bent.cosine * (bent.second_weight * s1.hessian + bent.first_weight * s2.hessian);
  }
  return rigidity * hinges.weights[at(edge)] * result;
}

}  // namespace pneuma::sim
