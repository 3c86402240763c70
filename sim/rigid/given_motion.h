// Boxes that are moved by keys in time, and where such keys lead.
#pragma once

#include <span>

#include "sim/world/world.h"

namespace pneuma::sim {

/// Of keys in order of time, at a time in s; zero without a key. The smooth curve is the monotone
/// cubic of Fritsch and Butland (1984, "A method for constructing local monotone piecewise cubic
/// interpolants"): where values rise from key to key, so does the curve; at the first and last key,
/// and where values turn back, its slope is 0.
Vec3 value_at(std::span<const KeyFrame> keys, bool smooth, double time);

struct Pose {
  Vec3 position;  // m
  Eigen::Quaterniond orientation;
};

/// At a time in s.
Pose pose_at(const GivenMotion& motion, double time);

struct Velocities {
  Vec3 linear;   // m/s
  Vec3 angular;  // rad/s, world axes
};

/// The derivative of pose_at; at a key of even speeds that after it.
Velocities velocities_at(const GivenMotion& motion, double time);

/// Gives each box that has a motion the velocities that lead to where it is at
/// the end of the next step, which is what contacts need: between its ends a step knows even motion
/// only.
void aim_given_motions(World& world);

/// Puts these boxes where they are at a time, s: after a step they differ by rounding only, which
/// thereby does not add up.
void place_given_motions(World& world, double time);

}  // namespace pneuma::sim
