#include "render/light/body_tree.h"

#include <algorithm>
#include <numeric>

namespace pneuma::render {
namespace {

constexpr std::size_t worth_groups = 256;  // bodies

BodyTree::Group group_of(std::span<const BodyElements> bodies,
                         std::span<const std::size_t> members) {
  BodyTree::Group group{
      {Vec3f::Zero(), Vec3f::Zero(), 0.0f, Light3::Zero()}, 0.0f, BodyTree::none, 0};
  Element& whole = group.whole;
  for (const std::size_t i : members) {
    const Element& body = bodies[i].whole;
    whole.area += body.area;
    whole.centre += body.area * body.centre;
    whole.radiosity += body.area * body.radiosity;
  }
  if (whole.area > 0.0f) {
    whole.centre /= whole.area;
    whole.radiosity /= whole.area;
  } else {
    whole.centre = bodies[members.front()].whole.centre;
  }
  for (const std::size_t i : members) {
    group.radius =
        std::max(group.radius, (bodies[i].whole.centre - whole.centre).norm() + bodies[i].radius);
  }
  return group;
}

int longest_axis(std::span<const BodyElements> bodies, std::span<const std::size_t> members) {
  Box box;
  for (const std::size_t i : members) box.grow(bodies[i].whole.centre);
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  return axis;
}

}  // namespace

void BodyTree::clear() {
  bodies_.clear();
  groups_.clear();
}

void BodyTree::build() {
  groups_.clear();
  if (bodies_.size() < worth_groups) return;
  std::vector<std::size_t> members(bodies_.size());
  std::iota(members.begin(), members.end(), std::size_t{0});
  add_group(members);
}

void BodyTree::add_group(std::span<std::size_t> members) {
  const std::size_t number = groups_.size();
  groups_.push_back(group_of(bodies_, members));
  if (members.size() == 1) {
    groups_[number].body = members.front();
  } else {
    const int axis = longest_axis(bodies_, members);
    const std::size_t half = members.size() / 2;
    std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(half),
                     members.end(), [&](std::size_t a, std::size_t b) {
                       const float first = bodies_[a].whole.centre[axis];
                       const float second = bodies_[b].whole.centre[axis];
                       return first < second || (first == second && a < b);
                     });
    add_group(members.first(half));
    add_group(members.subspan(half));
  }
  groups_[number].after = groups_.size();
}

}  // namespace pneuma::render
