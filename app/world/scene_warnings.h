// What a user should know before a run.
#pragma once

#include <string>
#include <vector>

#include "app/world/gas_advice.h"
#include "app/world/step_advice.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Of the [[body]] of which a world's body is a copy: "ball" or, of several, "ball.3".
scenes::Place place_of(const scenes::Scene& scene, const std::string& name);

/// Of bodies with few vertices (quick_advice); none of the paper's scenes, which are meant to
/// swell.
std::vector<GasAdvice> gas_advices_before_run(const scenes::Scene& scene, const sim::World& start);

/// The loader's warnings, bodies whose steps are too long, bodies that gas blows up, and bodies
/// that the contact potential throws apart from the start, each with its place:
/// "two_balls.toml:4:1: warning: body 'ball': ...".
std::vector<std::string> scene_warnings(const scenes::Scene& scene, const sim::World& start,
                                        const std::vector<StepAdvice>& steps,
                                        const std::vector<GasAdvice>& gas);

}  // namespace pneuma::app
