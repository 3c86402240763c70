// The keys of a scene file, each written down once. Reading, printing, overriding and the reference
// all work from these tables.
//
// A section's slots point into the struct it was made for, and which keys apply follows from the
// struct's values at that moment.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/keys.h"

namespace pneuma::scenes {

Section top_section(Scene& scene);
Section simulation_section(sim::Settings& settings);
Section particles_section(sim::ParticleSettings& particles);
Section ground_section(sim::Settings& settings);
Section camera_section(CameraScene& camera);
Section picture_section(PictureScene& picture);
Section limits_section(Limits& limits);
Section body_section(BodyScene& body);

/// All of a scene's sections but its bodies', the top level first.
std::vector<Section> fixed_sections(Scene& scene);

/// "body1" for index 0.
std::string default_name(std::size_t index);

}  // namespace pneuma::scenes
