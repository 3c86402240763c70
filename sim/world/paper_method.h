// The paper's method as printed, under one switch (ERRATA row 68).
#pragma once

#include "sim/world/world.h"

namespace pneuma::sim {

/// Sets the method and every choice that it decides: the paper's integrator, contacts and numbers
/// (3.2, 5.2.1, 5.3). What it does not decide stays: step, gravity, ground, seed.
inline void use_paper_method(Settings& settings) {
  settings.method = Method::paper;
  settings.integrator = Integrator::martin;
  settings.contact = ContactMethod::impulses;
  settings.skin_thickness = 0.5;
  settings.soft_search = SoftSearch::particles;
  settings.particles = {
      .per_vertex = 1.0 / 8.0, .attraction = 2.0, .max_sweeps = 10, .settled_below = 4};
  settings.relaxation_time = 0.0;
  settings.contact_iterations = 1;
  settings.sleep_speed = 0.0;
}

/// The paper's gas, pressure weights and damping (3.1.2, 3.1.3).
inline void use_paper_method(SoftMaterial& material) {
  material.gas_exponent = 1.0;
  material.ambient_pressure = 0.0;
  material.bending = material.bending_damping = 0.0;
  material.pressure_weighting = PressureWeighting::valence;
  material.damping = Damping::literal;
}

/// Of the settings and of every soft body.
inline void use_paper_method(World& world) {
  use_paper_method(world.settings);
  for (SoftBody& body : world.soft) use_paper_method(body.material);
}

}  // namespace pneuma::sim
