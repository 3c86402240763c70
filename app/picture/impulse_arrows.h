// The impulses of contacts as arrows, drawn over the surfaces.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "render/frame/frame.h"
#include "sim/collision/contact.h"

namespace pneuma::app {

/// N s that an arrow of one metre stands for: 1, 2 or 5 times a power of ten, so that the largest
/// impulse is seen well but fills no more than a fifth of the picture's height where the camera's
/// target is.
double arrow_scale(std::span<const sim::Contact> contacts, const render::Camera& camera);

/// For each contact a disc where the bodies touch, in a colour of their kinds, and an arrow along
/// the impulse on the first one. `scale` in N s per metre.
void add_impulses(std::span<const sim::Contact> contacts, double scale, render::Frame& frame);

/// What the arrows' lengths mean, for the caption: what rests gets its weight times the step, so
/// that arrows are shorter in shorter steps.
std::string arrow_legend(double scale, int steps_per_second);

}  // namespace pneuma::app
