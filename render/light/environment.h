// The light around a scene: a sun far away, a sky and a floor that depend on the elevation only.
#pragma once

#include <Eigen/Core>
#include <array>

namespace pneuma::render {

/// Linear colour.
using Light3 = Eigen::Array3f;

struct Environment {
  // Radiances, in units in which a white, matt surface that they fill the view of shows them; of
  // the sun what it shows facing it.
  Light3 sun = {0.95f, 0.90f, 0.80f};
  Light3 zenith = {0.36f, 0.42f, 0.53f};
  Light3 horizon = {0.58f, 0.60f, 0.63f};
  Light3 floor = {0.60f, 0.60f, 0.58f};  // what the lit ground sends up: its colour in pictures
};

/// Radiance of the sky in a direction whose sine of the elevation is `z`; 0 below the horizon.
Light3 sky_radiance(const Environment& environment, float z);

/// Irradiance of the sky over pi on a surface whose normal has the z component `z`, as
/// c[0] + c[1] z + c[2] z^2: the zonal spherical harmonics of the sky up to the second order, each
/// multiplied by that of the cosine lobe over pi, 1, 2/3 and 1/4 (Ramamoorthi and Hanrahan, "An
/// Efficient Representation for Irradiance Environment Maps", 2001, eq. 8; the order after the
/// second that is not zero, the fourth, is -1/24).
std::array<Light3, 3> sky_irradiance(const Environment& environment);

}  // namespace pneuma::render
