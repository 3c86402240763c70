#include "sim/response/group_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {

template <class Visit>
void GroupMotion::visit_soft(const Visit& visit) const {
  for (const int body : bodies_) {
    if (at(body) < world_.soft.size()) visit(world_.soft[at(body)]);
  }
}

template <class Visit>
void GroupMotion::visit_vertices(const Visit& visit) const {
  visit_soft([&](const SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      visit(body.material.vertex_mass, Vec3(body.positions[v]), Vec3(body.velocities[v]));
    }
  });
}

template <class Visit>
void GroupMotion::visit_boxes(const Visit& visit) const {
  for (const int body : bodies_) {
    if (at(body) >= world_.soft.size()) visit(world_.rigid[at(body) - world_.soft.size()]);
  }
}

void GroupMotion::leave_out_common() {
  const Mean all = mean();
  centre_ = all.centre;
  velocity_ = all.velocity;
  Vec3 angular_momentum = Vec3::Zero();
  visit_vertices([&](double m, const Vec3& x, const Vec3& v) {
    angular_momentum += m * (x - centre_).cross(v - velocity_);
  });
  visit_boxes([&](const RigidBox& box) {
    angular_momentum +=
        box.mass * (box.position - centre_).cross(box.velocity - velocity_) + spin(box);
  });
  angular_velocity_ = inertia(centre_).ldlt().solve(angular_momentum);
}

double GroupMotion::energy() const {
  double sum = 0.0;
  visit_vertices([&](double mass, const Vec3& x, const Vec3& v) {
    sum += 0.5 * mass * (v - common(x)).squaredNorm();
  });
  visit_boxes([&](const RigidBox& box) {
    const Vec3 own_spin = box.angular_velocity - angular_velocity_;
    sum += 0.5 * box.mass * (box.velocity - common(box.position)).squaredNorm() +
           0.5 * own_spin.dot(world_inertia(box) * own_spin);
  });
  return sum;
}

double GroupMotion::take(double energy) {
  const double there_is = this->energy();
  const double taken = std::min(energy, there_is);
  if (!(taken > 0.0)) return 0.0;
  slow(std::sqrt(1.0 - taken / there_is));
  return taken;
}

void GroupMotion::slow(double factor) {
  visit_soft([&](SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      const Vec3 of_all = common(body.positions[v]);
      body.velocities[v] = of_all + factor * (body.velocities[v] - of_all);
    }
  });
  visit_boxes([&](RigidBox& box) {
    const Vec3 of_all = common(box.position);
    box.velocity = of_all + factor * (box.velocity - of_all);
    box.angular_velocity = angular_velocity_ + factor * (box.angular_velocity - angular_velocity_);
  });
}

void GroupMotion::turn(const Vec3& angular_momentum) {
  const Vec3 centre = mean().centre;
  const Vec3 angular_velocity = inertia(centre).ldlt().solve(angular_momentum);
  visit_soft([&](SoftBody& body) {
    for (int v = 0; v < body.positions.size(); ++v) {
      body.velocities[v] += angular_velocity.cross(body.positions[v] - centre);
    }
  });
  visit_boxes([&](RigidBox& box) {
    box.velocity += angular_velocity.cross(box.position - centre);
    box.angular_velocity += angular_velocity;
  });
}

bool GroupMotion::has_soft_bodies() const {
  bool any = false;
  visit_soft([&](const SoftBody&) { any = true; });
  return any;
}

double GroupMotion::mass() const {
  double sum = 0.0;
  visit_soft(
      [&](const SoftBody& body) { sum += body.material.vertex_mass * body.positions.size(); });
  visit_boxes([&](const RigidBox& box) { sum += box.mass; });
  return sum;
}

GroupMotion::Mean GroupMotion::mean() const {
  double mass = 0.0;
  Mean sum;
  const auto add = [&](double m, const Vec3& x, const Vec3& v) {
    mass += m;
    sum.centre += m * x;
    sum.velocity += m * v;
  };
  visit_vertices(add);
  visit_boxes([&](const RigidBox& box) { add(box.mass, box.position, box.velocity); });
  return {sum.centre / mass, sum.velocity / mass};
}

Mat3 GroupMotion::inertia(const Vec3& centre) const {
  Mat3 sum = Mat3::Zero();
  const auto add = [&](double m, const Vec3& x) {
    const Vec3 arm = x - centre;
    sum += m * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  };
  visit_vertices([&](double m, const Vec3& x, const Vec3&) { add(m, x); });
  visit_boxes([&](const RigidBox& box) {
    add(box.mass, box.position);
    sum += world_inertia(box);
  });
  return sum;
}

}  // namespace pneuma::sim
