// Collision particles, contacts and names, drawn over the surfaces.
#pragma once

#include <span>
#include <string_view>

#include "render/frame/frame.h"
#include "sim/collision/contact.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// A disc for each particle of the pairs that are near, in a colour of its body; those whose
/// feature is in contact are larger, on a white disc.
void add_particles(const sim::World& world, std::span<const sim::Contact> contacts,
                   render::Frame& frame);

/// By the kinds of bodies.
render::Colour contact_colour(const sim::Contact& contact);

/// For each contact a disc where the bodies touch and a line along the normal, in a colour of the
/// kinds of bodies.
void add_contacts(std::span<const sim::Contact> contacts, render::Frame& frame);

/// Lines of a caption: what these marks mean.
std::string_view particle_legend();
std::string_view contact_legend();

/// The bodies' names, over them.
void add_labels(const sim::World& world, render::Frame& frame);

}  // namespace pneuma::app
