// Overlapping pairs: two soft bodies that lie so deep in each other that their surfaces no longer
// say which way is out (ERRATA row 64).
//
// The feature tests of 5.2.1.1 see what is within two skins of a surface. Where bodies lie in each
// other by more, only their surfaces' lines of intersection are in contact, and vertices there are
// pushed out of whichever triangle is near, here to one side and there to the other: the bodies as
// wholes stay where they are. Such pairs are told by the line between their centres of mass. From
// each centre on, the line lies inside the body up to where it first leaves it; where the two
// pieces overlap, the bodies do, whatever their shapes. A body whose centre is not inside itself,
// such as a torus, has no such piece, and what is in its hole is not in it.
#pragma once

#include <optional>

#include "sim/world/world.h"

namespace pneuma::sim {

/// Two soft bodies of a world, first < second.
struct OverlappingPair {
  int first = 0;
  int second = 0;
  Vec3 between = Vec3::Zero();  // m, from the first's centre of mass to the second's
  double clear = 0.0;           // m between the centres, at which a skin would lie between them
};

/// Memory of find_overlapping_pair; contents mean nothing between calls.
struct OverlappingPairScratch {
  VertexArray seen;  // a body's vertices, seen along the line
};

/// Whether a body's centre of mass, at rest, lies inside it: other bodies are in no overlapping
/// pair.
bool has_filled_centre(const SoftMesh& mesh);

/// m. Pairs whose bounding spheres' centres are farther apart are not looked at: of a body whose
/// centre of mass is that of its sphere, the piece of the line is no longer than the radius (m,
/// without the skin). Other bodies may have to come deeper before they are.
double overlap_reach(double first_radius, double second_radius, double skin_thickness,
                     bool is_depenetrating);

/// None unless the bodies overlap along the line between their centres by more than two skins,
/// which the feature tests see all of, or so that the smaller one's centre lies in the other; and
/// by more than a quarter of what the smaller one has of the line: with thin skins every firm
/// contact is deeper than those. For a pair that is being moved apart already, none when a skin
/// lies between them. Where the centres coincide the line is along x.
std::optional<OverlappingPair> find_overlapping_pair(const World& world, int first, int second,
                                                     bool is_depenetrating,
                                                     OverlappingPairScratch& scratch);

}  // namespace pneuma::sim
