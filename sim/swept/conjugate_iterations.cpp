#include "sim/swept/conjugate_iterations.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace pneuma::sim {
namespace {

/// Impulses of one colour have no box in common. What finds no colour stands for itself.
constexpr std::size_t max_colours = 64;

std::array<BoxChange*, 2> boxes_of(const SweptImpulse& impulse) {
  return {impulse.first().box(), impulse.second().box()};
}

/// The first that none of the impulses on the same boxes has yet.
std::size_t next_colour(const SweptImpulse& impulse) {
  std::uint64_t taken = 0;
  for (const BoxChange* box : boxes_of(impulse)) taken |= box ? box->colours : 0;
  const auto colour = static_cast<std::size_t>(std::countr_one(taken));
  if (colour == max_colours) return colour;
  for (BoxChange* box : boxes_of(impulse)) {
    if (box) box->colours |= std::uint64_t{1} << colour;
  }
  return colour;
}

}  // namespace

void ConjugateIterations::begin(std::span<SweptImpulse* const> impulses) {
  sort_by_colour(impulses);
  put_together();
}

/// Counting sort, in which impulses of one colour stay in their order.
void ConjugateIterations::sort_by_colour(std::span<SweptImpulse* const> impulses) {
  others_.clear();
  coloured_.clear();
  for (SweptImpulse* impulse : impulses) {
    if (!impulse->is_of_boxes()) {
      others_.push_back(impulse);
      continue;
    }
    coloured_.push_back({0, impulse});
    for (BoxChange* box : boxes_of(*impulse)) {
      if (box) box->colours = 0;
    }
  }
  std::array<std::size_t, max_colours + 2> begin{};
  for (Coloured& one : coloured_) {
    one.colour = next_colour(*one.impulse);
    ++begin[one.colour + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  sorted_.resize(coloured_.size());
  for (const Coloured& one : coloured_) sorted_[begin[one.colour]++] = one;
}

void ConjugateIterations::put_together() {
  of_boxes_.clear();
  std::size_t lane = 4, colour = 0;
  for (const Coloured& one : sorted_) {
    if (lane == 4 || one.colour != colour || colour == max_colours) {
      of_boxes_.emplace_back();
      lane = 0;
    }
    colour = one.colour;
    of_boxes_.back().set(lane++, *one.impulse);
  }
}

double ConjugateIterations::correct(double tolerance, int max_iterations) {
  for (FourBoxImpulses& four : of_boxes_) four.begin();
  ways_.assign(others_.size(), {});
  squared_before_ = 0.0;
  double greatest = 0.0;
  for (int i = 0; i < max_iterations; ++i) {
    greatest = iterate();
    if (greatest <= tolerance || i + 1 == max_iterations) break;
    go_on();
  }
  for (const FourBoxImpulses& four : of_boxes_) four.end();
  return greatest;
}

double ConjugateIterations::iterate() {
  FourBoxImpulses::Change change;
  for (FourBoxImpulses& four : of_boxes_) four.correct(change);
  double squared = 0.0, greatest = 0.0;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    squared = std::max(squared, change.squared_velocity[lane]);
  }
  squared_ = sum_of_lanes(change.energy);
  for (std::size_t i = 0; i < others_.size(); ++i) {
    SweptImpulse& impulse = *others_[i];
    const Vec4d before = impulse.impulse();
    greatest = std::max(greatest, impulse.correct());
    ways_[i].correction = impulse.impulse() - before;
    squared_ += impulse.mobility() * dot(ways_[i].correction, ways_[i].correction);
  }
  return std::max(greatest, std::sqrt(squared));
}

/// Fletcher and Reeves' ratio; where corrections grow, the directions are forgotten.
void ConjugateIterations::go_on() {
  const bool grows = squared_ >= squared_before_;
  const double ratio = grows ? 0.0 : squared_ / squared_before_;
  for (FourBoxImpulses& four : of_boxes_) four.go_on(grows, ratio);
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Vec4d more = ratio * ways_[i].direction;
    if (!grows) others_[i]->exceed(more);
    ways_[i].direction = more + ways_[i].correction;
  }
  squared_before_ = squared_;
}

}  // namespace pneuma::sim
