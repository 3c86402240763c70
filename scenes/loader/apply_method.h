// simulation.method = "paper": one key that sets others.
#pragma once

#include "scenes/loader/reader.h"
#include "scenes/loader/report.h"
#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// Whatever else the scene says (sim/world/paper_method.h).
void use_paper_method(Scene& scene);

/// Sets what the scene's method decides. A key that it sets is an error beside it; but when an
/// override is what chose the method, the file's values of such keys give way to it, as those of
/// keys do that an override makes inapplicable.
void apply_method(Scene& scene, const Reader& reader, Report& report);

}  // namespace pneuma::scenes
