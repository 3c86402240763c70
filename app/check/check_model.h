// What `pneuma check` says of a model file.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/check/model_report.h"
#include "app/world/model_scene.h"

namespace pneuma::app {

struct ModelCheck {
  std::filesystem::path path;
  assets::CleanModel model;
  ModelReport report;
};

/// Reads, mends and simplifies the model as for its scene, but without scale and turn. Throws
/// assets::ModelError.
ModelCheck check_model(const std::filesystem::path& path, const ModelChoice& choice = {});

std::string model_check_text(const ModelCheck& check);

/// A line about what makes the steps of its scene so short, if there are very many of them; else
/// nothing.
std::string many_steps_text(const ModelReport& report, int steps_per_second);

nlohmann::json model_check_json(const ModelCheck& check);

}  // namespace pneuma::app
