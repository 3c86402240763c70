#include "sim/potential/lagged_terms.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Of a parabola that touches parting_ramp() at q and is nowhere below it: the one that does so of
/// max(0, q - 1/2), near whose corner the max curvature of the ramp is enough.
double bounding_ramp_curvature(double q) { return 0.5 / std::max(std::abs(q - 0.5), 1.0 / 3.0); }

}  // namespace

void LaggedTerms::start(const std::vector<ActiveContact>& active, const VertexArray& velocities,
                        const VertexArray& base, double step, double regularisation_speed) {
  terms_.clear();
  length_ = step * regularisation_speed;
  for (const ActiveContact& contact : active) {
    Term term{.vertices = contact.vertices,
              .count = contact.count,
              .weights = contact.point.weights,
              .normal = contact.point.normal()};
    const double parting = term.normal.dot(relative_velocity(contact, velocities));
    term.taken = (1.0 - contact.restitution * contact.restitution) * contact.push();
    const double left =
        contact.push() - term.taken * parting_ramp(parting / regularisation_speed).slope;
    term.braking = contact.friction * left;
    for (int i = 0; i < term.count; ++i) {
      term.base += term.weights[at(i)] * base[term.vertices[at(i)]];
    }
    if (term.taken > 0.0 || term.braking > 0.0) terms_.push_back(term);
  }
}

Vec3 LaggedTerms::way(const Term& term, const VertexArray& positions) const {
  Vec3 sum = -term.base;
  for (int i = 0; i < term.count; ++i) {
    sum += term.weights[at(i)] * positions[term.vertices[at(i)]];
  }
  return sum;
}

double LaggedTerms::energy(const VertexArray& positions) const {
  double sum = 0.0;
  for (const Term& term : terms_) {
    const Vec3 u = way(term, positions);
    const double parting = term.normal.dot(u);
    const double sliding = (u - parting * term.normal).norm();
    sum += length_ * (term.taken * parting_ramp(parting / length_).value +
                      term.braking * smooth_friction(sliding / length_).value);
  }
  return sum;
}

void LaggedTerms::add_gradient(const VertexArray& positions, VertexArray& gradient) const {
  for (const Term& term : terms_) {
    const Vec3 u = way(term, positions);
    const double parting = term.normal.dot(u);
    const Vec3 across = u - parting * term.normal;
    const double sliding = across.norm();
    Vec3 force = term.taken * parting_ramp(parting / length_).slope * term.normal;
    if (sliding > 0.0) {
      force += term.braking * smooth_friction(sliding / length_).slope / sliding * across;
    }
    for (int i = 0; i < term.count; ++i) {
      gradient[term.vertices[at(i)]] += term.weights[at(i)] * force;
    }
  }
}

void LaggedTerms::append_hessian(const VertexArray& positions, Form form,
                                 std::vector<WeightedBlock>& blocks) const {
  const bool is_bounding = form == Form::bounding;
  for (const Term& term : terms_) {
    const Vec3 u = way(term, positions);
    const double parting = term.normal.dot(u);
    const Vec3 across = u - parting * term.normal;
    const double sliding = across.norm();
    const Mat3 along_normal = term.normal * term.normal.transpose();
    const double q = parting / length_;
    const double curvature = is_bounding ? bounding_ramp_curvature(q) : parting_ramp(q).curvature;
    Mat3 block = term.taken / length_ * curvature * along_normal;
    // Of h(y) / y along the surface, and its change along the way: slope and curvature of H.
    const double y = sliding / length_;
    const double per_length =
        term.braking / length_ * (y > 0.0 ? smooth_friction(y).slope / y : 2.0);
    block += per_length * (Mat3::Identity() - along_normal);
    if (sliding > 0.0 && !is_bounding) {
      const Vec3 direction = across / sliding;
      const double along = term.braking / length_ * smooth_friction(y).curvature - per_length;
      block += along * direction * direction.transpose();
    }
    blocks.push_back({term.vertices, term.count, term.weights, block});
  }
}

}  // namespace pneuma::sim
