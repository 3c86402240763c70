// Bodies whose springs hold their shape against their gas: which of the equilibria (equilibrium.h)
// they take, and whether it lasts.
//
// What softening leaves unbalanced changes the shape. Of coarse meshes that is little, but smooth
// loads meet ever softer motions the finer a mesh is, in proportion to the square of its edges: a
// sphere of 1,262 vertices would grow by a third. So where much is left the softening is reduced,
// as far as springs can bear the tensions and no push folds the shape.
#pragma once

#include <memory>

#include "sim/equilibrium/equilibrium.h"
#include "sim/mesh/soft_mesh.h"

namespace pneuma::sim {

/// The mesh with rest lengths that hold its shape at the positions. Throws EquilibriumError as
/// find_equilibrium does, for the equilibrium that asks least of the springs.
std::shared_ptr<const SoftMesh> held_mesh(const SoftMesh& mesh, const VertexArray& positions,
                                          const SoftMaterial& material);

/// The amount of gas in mol at the material's temperature, whatever its n, up to which springs hold
/// the shape as well as with less; held_mesh may take more and let the body leave its shape
/// further. Infinite when no spring is stretched.
/// Throws EquilibriumError for the other reasons of held_mesh. The temperature must be above 0.
double max_held_gas(const SoftMesh& mesh, const VertexArray& positions,
                    const SoftMaterial& material);

/// Whether springs, hinges and gas that are in balance at the positions come back to it from every
/// small push: d^2E/dx^2 is above 0 in all directions but those of rigid motion. Near a balance,
/// too: what is unbalanced moves the body a little, and no further.
bool is_stable(const SoftMesh& mesh, const VertexArray& positions, const SoftMaterial& material);

/// Vertices up to which that takes well below a second: sparse factors of 3 V rows.
inline constexpr int quickly_stable = 3'000;

/// N/m: the k, from the material's on and to within 2 %, from which the shape is stable that
/// held_mesh makes of it. Infinite when it is not at a thousand times the k. Throws
/// EquilibriumError.
double stable_stiffness(const SoftMesh& mesh, const VertexArray& positions,
                        const SoftMaterial& material);

}  // namespace pneuma::sim
