#include "sim/potential/lagged_terms.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Of a parabola that touches parting_ramp() at q and is nowhere below it: the one that does so of
/// max(0, q - 1/2), near whose corner the max curvature of the ramp is enough.
double bounding_ramp_curvature(double q) { return 0.5 / std::max(std::abs(q - 0.5), 1.0 / 3.0); }

/// Of a pair's distance, which is left where it would be at the base at least: sdirk2 extrapolates
/// to where things may be in each other.
constexpr double least_distance = 0.1;

}  // namespace

void LaggedTerms::start(const std::vector<ActiveContact>& active, const VertexArray& positions,
                        const VertexArray& velocities, const VertexArray& base, double step,
                        double regularisation_speed) {
  terms_.clear();
  length_ = step * regularisation_speed;
  for (const ActiveContact& contact : active) {
    Term term{.vertices = contact.vertices,
              .count = contact.count,
              .weights = contact.point.weights,
              .normal = contact.point.normal()};
    const double parting = term.normal.dot(relative_velocity(contact, velocities));
    const double share = 1.0 - contact.restitution * contact.restitution;
    term.braking = contact.friction * contact.push() *
                   (1.0 - share * parting_ramp(parting / regularisation_speed).slope);
    Vec3 place = Vec3::Zero();
    for (int i = 0; i < term.count; ++i) {
      place += term.weights[at(i)] * positions[term.vertices[at(i)]];
      term.base += term.weights[at(i)] * base[term.vertices[at(i)]];
    }
    const double at_base = contact.point.distance - term.normal.dot(place - term.base);
    term.nearest = std::max(at_base, least_distance * contact.point.distance) + 0.5 * length_;
    term.reach = contact.reach;
    term.strength = share * contact.mollifier * contact.strength;
    term.held = barrier_at(term.nearest, term.reach, term.strength).value;
    if (term.strength > 0.0 || term.braking > 0.0) terms_.push_back(term);
  }
}

Vec3 LaggedTerms::way(const Term& term, const VertexArray& positions) const {
  Vec3 sum = -term.base;
  for (int i = 0; i < term.count; ++i) {
    sum += term.weights[at(i)] * positions[term.vertices[at(i)]];
  }
  return sum;
}

FunctionValue LaggedTerms::taken(const Term& term, double parting) const {
  if (parting <= 0.0) return {};
  const FunctionValue ramp = parting_ramp(parting / length_);
  const FunctionValue b =
      barrier_at(term.nearest + length_ * ramp.value, term.reach, term.strength);
  return {term.held - b.value, -b.slope * ramp.slope,
          -b.curvature * ramp.slope * ramp.slope - b.slope * ramp.curvature / length_};
}

/// B(a) - B(a + r) is concave in r: below its tangent, and r below its parabola.
double LaggedTerms::bounding_curvature(const Term& term, double parting) const {
  const double q = parting / length_;
  const FunctionValue b =
      barrier_at(term.nearest + length_ * parting_ramp(q).value, term.reach, term.strength);
  return -b.slope * bounding_ramp_curvature(q) / length_;
}

double LaggedTerms::energy(const VertexArray& positions) const {
  double sum = 0.0;
  for (const Term& term : terms_) {
    const Vec3 u = way(term, positions);
    const double parting = term.normal.dot(u);
    const double sliding = (u - parting * term.normal).norm();
    sum += taken(term, parting).value +
           length_ * term.braking * smooth_friction(sliding / length_).value;
  }
  return sum;
}

void LaggedTerms::add_gradient(const VertexArray& positions, VertexArray& gradient) const {
  for (const Term& term : terms_) {
    const Vec3 u = way(term, positions);
    const double parting = term.normal.dot(u);
    const Vec3 across = u - parting * term.normal;
    const double sliding = across.norm();
    Vec3 force = taken(term, parting).slope * term.normal;
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
    const double curvature =
        is_bounding ? bounding_curvature(term, parting) : taken(term, parting).curvature;
    Mat3 block = curvature * along_normal;
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
