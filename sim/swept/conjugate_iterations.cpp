#include "sim/swept/conjugate_iterations.h"

#include <algorithm>
#include <bit>
#include <cmath>

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
  nothing_ = {};  // of iterations that were not finite, NaN
  find_pairs(impulses);
  put_together();
  find_moved_boxes(impulses);
}

/// Impulses of a pair that do not come one after the other are two pairs.
void ConjugateIterations::find_pairs(std::span<SweptImpulse* const> impulses) {
  others_.clear();
  between_boxes_.clear();
  pairs_.clear();
  for (SweptImpulse* impulse : impulses) {
    if (!impulse->is_of_boxes()) {
      others_.push_back(impulse);
      continue;
    }
    const auto boxes = boxes_of(*impulse);
    if (between_boxes_.empty() || boxes_of(*between_boxes_.back()) != boxes) {
      pairs_.push_back({.begin = between_boxes_.size()});
      for (BoxChange* box : boxes) {
        if (box) box->colours = 0;
      }
    }
    between_boxes_.push_back(impulse);
    ++pairs_.back().count;
  }
  for (Pair& pair : pairs_) pair.colour = next_colour(*between_boxes_[pair.begin]);
  std::ranges::sort(pairs_, {}, &Pair::order);
}

void ConjugateIterations::put_together() {
  fours_.clear();
  of_boxes_.clear();
  for (std::size_t begin = 0, end = 0; begin < pairs_.size(); begin = end) {
    const std::size_t colour = pairs_[begin].colour, most = colour == max_colours ? 1 : 4;
    while (end < pairs_.size() && end - begin < most && pairs_[end].colour == colour) ++end;
    put_together(std::span(pairs_).subspan(begin, end - begin));
  }
}

/// The first of these has the most impulses.
void ConjugateIterations::put_together(std::span<const Pair> pairs) {
  FourPairs& four = fours_.emplace_back();
  four.first.fill(&nothing_);
  four.second.fill(&nothing_);
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto [first, second] = boxes_of(*between_boxes_[pairs[lane].begin]);
    if (first) four.first[lane] = first;
    if (second) four.second[lane] = second;
  }
  four.begin = of_boxes_.size();
  for (std::size_t i = 0; i < pairs.front().count; ++i) {
    std::array<SweptImpulse*, 4> impulses{};
    for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
      const auto& [colour, begin, count] = pairs[lane];
      if (i < count) impulses[lane] = between_boxes_[begin + i];
    }
    of_boxes_.emplace_back().set(impulses);
  }
  four.end = of_boxes_.size();
}

/// Their colours are not needed any more: they say which are not found yet.
void ConjugateIterations::find_moved_boxes(std::span<SweptImpulse* const> impulses) {
  for (const SweptImpulse* impulse : impulses) {
    for (BoxChange* box : boxes_of(*impulse)) {
      if (box) box->colours = 1;
    }
  }
  moved_.clear();
  for (const SweptImpulse* impulse : impulses) {
    for (BoxChange* box : boxes_of(*impulse)) {
      if (!box || box->colours == 0) continue;
      box->colours = 0;
      moved_.push_back({.box = box});
    }
  }
}

double ConjugateIterations::correct(double tolerance, int max_iterations) {
  for (FourBoxImpulses& four : of_boxes_) four.begin();
  ways_.assign(others_.size(), {});
  for (Moved& moved : moved_) moved.direction = moved.turn = Vec4d{};
  squared_before_ = ratio_ = 0.0;
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
  note_velocities();
  FourBoxImpulses::Change change;
  correct_boxes(change);
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

void ConjugateIterations::correct_boxes(FourBoxImpulses::Change& change) {
  for (const FourPairs& four : fours_) {
    FourMotions first = FourMotions::of(four.first), second = FourMotions::of(four.second);
    for (std::size_t i = four.begin; i < four.end; ++i) {
      of_boxes_[i].correct(ratio_, first, second, change);
    }
    first.give_back(four.first);
    second.give_back(four.second);
  }
}

void ConjugateIterations::note_velocities() {
  for (Moved& moved : moved_) {
    moved.velocity = moved.box->velocity;
    moved.angular_velocity = moved.box->angular_velocity;
  }
}

/// Fletcher and Reeves' ratio; where corrections grow, the directions are forgotten. Boxes go on by
/// what all impulses give them, so that of these only vertices need their own.
void ConjugateIterations::go_on() {
  const bool grows = squared_ >= squared_before_;
  ratio_ = grows ? 0.0 : squared_ / squared_before_;
  for (Moved& moved : moved_) {
    BoxChange& box = *moved.box;
    const Vec4d faster = ratio_ * moved.direction, turn = ratio_ * moved.turn;
    moved.direction = faster + (box.velocity - moved.velocity);
    moved.turn = turn + (box.angular_velocity - moved.angular_velocity);
    box.velocity += faster;
    box.angular_velocity += turn;
  }
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Vec4d more = ratio_ * ways_[i].direction;
    if (!grows) others_[i]->exceed_beside_boxes(more);
    ways_[i].direction = more + ways_[i].correction;
  }
  squared_before_ = squared_;
}

}  // namespace pneuma::sim
