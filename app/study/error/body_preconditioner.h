// Preconditioners for CVODE's BDF on soft bodies without contacts: M near I - gamma df/dy.
//
// A row of M (dx, dv) = (r, s) is dx - gamma dv = r, so that dv = (dx - r) / gamma, and what is
// left is symmetric: with K = -dF/dx and C = -dF/dv of the forces,
//
//   (m / gamma^2 + C / gamma + K) dx = m / gamma^2 (r + gamma s) + C r / gamma.
//
// The matrix is the Hessian of an implicit step of gamma seconds (incremental_potential.h).
// Neglected, as GMRES makes up for it: that the force of a dashpot changes as its spring turns, the
// dashpots of hinges, and pressure weights.
#pragma once

#include <memory>
#include <span>

#include "app/study/error/sundials.h"
#include "sim/world/soft_body.h"

namespace pneuma::app {

enum class BodyPreconditioning {
  blocks,   // the 3 x 3 blocks of the vertices alone
  factors,  // sparse factors, with the gas's term of rank one
};

std::unique_ptr<Sundials::Preconditioner> make_body_preconditioner(
    std::span<const sim::SoftBody> bodies, BodyPreconditioning kind);

}  // namespace pneuma::app
