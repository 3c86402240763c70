// A stability study in parts of one integrator each, as JSON that is read back without loss.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/study/stability/stability_study.h"

namespace pneuma::app {

nlohmann::json part_json(const StabilityStudy& study);

/// The study of all these integrators, in the order of the parts; `options` are those that every
/// part was measured with.
StabilityStudy join_parts(const StabilityOptions& options, std::span<const nlohmann::json> parts);

}  // namespace pneuma::app
