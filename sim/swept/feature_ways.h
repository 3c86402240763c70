// Two features on their ways through a step: where they are nearest, and whether they meet.
#pragma once

#include <optional>

#include "sim/swept/closest_points.h"
#include "sim/swept/moving_surface.h"

namespace pneuma::sim {

/// The nearest points of a pair at the start or the end of the step, if they are less than `reach`
/// (m) apart.
std::optional<ClosestPoints> closest_points(const MovingSurface& first, const MovingSurface& second,
                                            const NearFeatures& pair, Moment moment, double reach);

/// The direction from the second to the first of features that touch: the triangle's, or across
/// both edges to the side on which the first surface is.
Vec3 touching_normal(const MovingSurface& first, const MovingSurface& second,
                     const NearFeatures& pair, Moment moment);

/// Of the angle between two edges.
double sine_between_edges(const MovingSurface& first, const MovingSurface& second,
                          const NearFeatures& edges, Moment moment);

/// m. By how much the distance of a pair can change on their ways at most.
double greatest_change(const MovingSurface& first, const MovingSurface& second,
                       const NearFeatures& pair);

/// Whether a plane between the features, across the triangle or along both edges, shows that they
/// are more than `distance` (m) apart at the start. Says so of most pairs in a tenth of the time
/// that closest_points takes, and never of parallel edges or of a triangle without area.
bool are_apart(const MovingSurface& first, const MovingSurface& second, const NearFeatures& pair,
               double distance);

/// Of the pairs of features whose nearest points, after a fraction of the step, are on common edges
/// and vertices one stands for them all, and none where other features next to these are nearer.
/// Faces that lie on each other touch at all their corners, though one of these is always a trifle
/// nearer: up to an angle with `sine_of_flat` they all stand.
bool stands_for_its_parts(const MovingSurface& first, const MovingSurface& second,
                          const NearFeatures& pair, const ClosestPoints& closest, double fraction,
                          double sine_of_flat);

/// Whether no edge at a vertex of a surface leads nearer to a point beside the surface, after a
/// fraction of the step.
bool is_nearest_vertex(const MovingSurface& surface, int vertex, const Vec3& point, double fraction,
                       double sine_of_flat);

/// After which fraction of their ways the features have come to within 1.2 times `least` (m, above
/// zero and less than their distance at the start); none if they stay further apart. Conservative:
/// they may also just come near that. Never misses a crossing: each advance is shorter than the
/// features would need to meet at their speeds along the line between their nearest points
/// (conservative advancement; Mirtich 1996, "Impulse-based dynamic simulation of rigid body
/// systems"; by sums of what is certainly free, Li, Kaufman and Jiang 2021,
/// "Codimensional incremental potential contact", section 5).
std::optional<double> time_of_meeting(const MovingSurface& first, const MovingSurface& second,
                                      const NearFeatures& pair, double distance, double least);

/// The nearest points of a pair after a fraction of the step.
ClosestPoints closest_points_at(const MovingSurface& first, const MovingSurface& second,
                                const NearFeatures& pair, double fraction);

}  // namespace pneuma::sim
