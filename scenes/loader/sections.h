// The keys of a scene file, each written down once. Reading, printing, overriding and the reference
// all work from these tables.
//
// A section's slots point into the struct it was made for, and which keys apply follows from the
// struct's values at that moment.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenes/loader/keys.h"

namespace pneuma::scenes {

/// Makes a section from the values that the scene has at that moment.
using SectionMaker = Section (*)(Scene& scene);

/// For every table but [[body]]: the top level first, each table before those within it.
std::span<const SectionMaker> section_makers();

/// What they make.
std::vector<Section> fixed_sections(Scene& scene);

Section body_section(BodyScene& body);
Section valve_section(ValveScene& valve);
Section spring_section(SpringScene& spring);

/// All there are, with the values of a scene and of a first body as they are made: [[body]] is
/// last.
const std::vector<Section>& default_sections();

/// "body1" for index 0.
std::string default_name(std::size_t index);

/// A body of which the file says nothing: its name and its colours follow from its index.
BodyScene default_body(std::size_t index);

}  // namespace pneuma::scenes
