#include "render/light/gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pneuma::render {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float far_away = 3.0f;  // radii of the body from its centre to the receivers
constexpr float near = 2.0f;      // radii of an element from its centre to the receivers
// Radii of a group. Its bodies take up to (r / d)^2 of the hemisphere, and by where in the group
// they are less or more by the order of that squared.
constexpr float far_from_group = 4.0f;
constexpr float smallest_share = 0.02f;  // of the hemisphere, as a divisor

/// `dz`: m, by which the element is above the receivers.
void add_taken(const Element& element, const Receivers::Column& taken, const Receivers::Column& dz,
               Receivers& to) {
  const Receivers::Column above = taken * (1e6f * dz).max(0.0f).min(1.0f);  // no branch
  to.above += above;
  to.below += taken - above;
  to.red += taken * element.radiosity[0];
  to.green += taken * element.radiosity[1];
  to.blue += taken * element.radiosity[2];
}

/// The part of the hemisphere that a disc of the area A takes, seen from a distance d large beside
/// its radius r: A cos(r) cos(e) / (pi d^2), with the angles at receiver and element. Nearer by, a
/// receiver at the height h above the disc's plane is looked at from sqrt(h^2 + r^2), so that discs
/// side by side take all of the hemisphere of what they cover at whatever height.
void add_disc(const Element& element, Receivers& to) {
  using Column = Receivers::Column;
  const Vec3f& at = element.centre;
  const Vec3f& normal = element.normal;
  const Column dx = at.x() - to.x;
  const Column dy = at.y() - to.y;
  const Column dz = at.z() - to.z;
  const Column height = -normal.x() * dx - normal.y() * dy - normal.z() * dz;
  const Column raised = (height * height + element.area / pi).sqrt();
  const Column up = raised - height;
  const Column squared = dx * dx + dy * dy + dz * dz + element.area / pi + 1e-9f;  // from there
  const Column facing = to.nx * normal.x() + to.ny * normal.y() + to.nz * normal.z();
  const Column at_receiver = (to.nx * dx + to.ny * dy + to.nz * dz - up * facing).max(0.0f);
  const Column in_front = (1e6f * height).max(0.0f).min(1.0f);
  add_taken(element, in_front * element.area / pi * at_receiver * raised / (squared * squared), dz,
            to);
}

struct Ball {
  Vec3f centre;
  float radius;

  float distance_to(const Vec3f& point) const { return (point - centre).norm() - radius; }
  /// Any of it is in front of the element.
  bool is_before(const Element& element) const {
    return element.normal.dot(centre - element.centre) + radius > 0.0f;
  }
};

Ball around(const Receivers& receivers) {
  Box box;
  for (Eigen::Index i = 0; i < receivers.count; ++i) {
    box.grow({receivers.x[i], receivers.y[i], receivers.z[i]});
  }
  return {box.centre(), 0.5f * (box.max - box.min).norm()};
}

/// Of receivers in a ball; what all of them are behind takes nothing.
void add_disc(const Element& element, const Ball& ball, Receivers& to) {
  if (ball.is_before(element)) add_disc(element, to);
}

/// A ball faces every receiver: A cos(r) / (pi d^2 + A) (GPU Gems 2, 14.3).
void add_ball(const Element& element, Receivers& to) {
  using Column = Receivers::Column;
  const Vec3f& at = element.centre;
  const Column dx = at.x() - to.x;
  const Column dy = at.y() - to.y;
  const Column dz = at.z() - to.z;
  const Column squared = dx * dx + dy * dy + dz * dz + 1e-9f;
  const Column at_receiver = (to.nx * dx + to.ny * dy + to.nz * dz).max(0.0f);
  add_taken(element, element.area * at_receiver / (squared.sqrt() * (pi * squared + element.area)),
            dz, to);
}

/// `add` adds the elements of a body or a group to `to`.
template <class Add>
void add_whole(Receivers& to, const Add& add) {
  const Receivers::Column above = to.above;
  const Receivers::Column below = to.below;
  add();
  to.sky_left *= (1.0f - (to.above - above) / to.sky).max(0.0f);
  to.floor_left *= (1.0f - (to.below - below) / to.floor).max(0.0f);
}

void add_whole_ball(const Element& whole, Receivers& receivers) {
  add_whole(receivers, [&] { add_ball(whole, receivers); });
}

void add_body(const BodyElements& body, const Ball& ball, Receivers& receivers) {
  if (ball.distance_to(body.whole.centre) > far_away * body.radius) {
    add_whole_ball(body.whole, receivers);
    return;
  }
  add_whole(receivers, [&] {
    for (std::size_t i = 0; i < body.elements.size(); ++i) {
      const Element& element = body.elements[i];
      const std::size_t first = body.first_part[i], end = body.first_part[i + 1];
      const float reach = near * std::sqrt(element.area / pi);
      if (first == end || ball.distance_to(element.centre) > reach) {
        add_disc(element, ball, receivers);
      } else {
        for (std::size_t part = first; part < end; ++part) {
          add_disc(body.parts[part], ball, receivers);
        }
      }
    }
  });
}

}  // namespace

void Receivers::begin(std::size_t points) {
  const auto size = static_cast<Eigen::Index>(points);
  count = 0;
  for (Column* column : {&x, &y, &z, &nx, &ny, &nz}) column->resize(size);
  for (Column* share : {&sky, &floor}) share->setOnes(size);
  for (Column* left : {&sky_left, &floor_left}) left->setOnes(size);
  for (Column* sum : {&above, &below, &red, &green, &blue}) sum->setZero(size);
}

void Receivers::add(const Vec3f& position, const Vec3f& normal) {
  const Eigen::Index row = count++;
  x[row] = position.x();
  y[row] = position.y();
  z[row] = position.z();
  nx[row] = normal.x();
  ny[row] = normal.y();
  nz[row] = normal.z();
  sky[row] = std::max(0.5f + 0.5f * normal.z(), smallest_share);
  floor[row] = std::max(0.5f - 0.5f * normal.z(), smallest_share);
}

void gather(std::span<const BodyElements> bodies, Receivers& receivers) {
  const Ball ball = around(receivers);
  for (const BodyElements& body : bodies) add_body(body, ball, receivers);
}

void gather(const BodyTree& tree, Receivers& receivers) {
  const std::span<const BodyTree::Group> groups = tree.groups();
  if (groups.empty()) return gather(tree.bodies(), receivers);
  const Ball ball = around(receivers);
  for (std::size_t i = 0; i < groups.size();) {
    const BodyTree::Group& group = groups[i];
    if (group.is_one()) {
      add_body(tree.bodies()[group.body], ball, receivers);
    } else if (ball.distance_to(group.whole.centre) > far_from_group * group.radius) {
      add_whole_ball(group.whole, receivers);
      i = group.after;
      continue;
    }
    ++i;
  }
}

IndirectLight left_at(const Receivers& receivers, std::size_t number) {
  const auto i = static_cast<Eigen::Index>(number);
  const float sky_left = receivers.sky_left[i];
  const float floor_left = receivers.floor_left[i];
  const float all = receivers.above[i] + receivers.below[i];
  const float taken =
      receivers.sky[i] * (1.0f - sky_left) + receivers.floor[i] * (1.0f - floor_left);
  const float sent = all > 0.0f ? taken / all : 0.0f;
  return {sent * Vec3f(receivers.red[i], receivers.green[i], receivers.blue[i]),
          {sky_left, floor_left},
          {IndirectLight::no_box, IndirectLight::no_box}};
}

}  // namespace pneuma::render
