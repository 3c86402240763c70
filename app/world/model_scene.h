// A scene of a model alone: it falls on the ground, dents, bounces and rests, with numbers that
// suit its mesh.
//
// Springs of k make a membrane of about k sqrt(3) N/m, whatever the lengths of its edges. The whole
// body has the same size, mass and k whatever its mesh, so that its weight stretches that membrane
// by a percent or two, and gas a little above the pressure outside bears the weight. What is
// outside makes the gas resist a change of volume. Faces that are flat or concave are held by
// hinges between triangles (sim/soft/bending.h), made as stiff as costs no step, and softer where
// many triangles may fold. The mesh decides the mass of a vertex, and with it the step
// (sim/soft/stability_limit.h); one of very many vertices is simplified before.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "assets/clean_mesh.h"
#include "assets/import_model.h"

namespace pneuma::app {

/// How a model file is read.
struct ModelChoice {
  std::string component = {};  // of several in the file, by name or number; empty: the only closed
  bool repair = false;         // assets::CleanOptions::repair
  // Degrees about x, then y, then z, as model.rotation; none: as files of its format stand.
  std::optional<sim::Vec3> rotation = {};
  std::optional<int> vertices = {};  // at most, as model.vertices; none: most_chosen_vertices
  // As of the scene that is made of it.
  int most_vertices = assets::CleanOptions{}.most_vertices;
  std::size_t most_bytes = assets::ImportLimits{}.bytes;
};

/// Finer models are simplified to it, where they can be, so that their runs do not take long.
inline constexpr int most_chosen_vertices = 8'000;

/// The rotation that turns the model's "x", "y" or "z" upwards.
sim::Vec3 rotation_of_up(std::string_view axis);

/// Degrees: as chosen, or as files of its format stand.
sim::Vec3 model_rotation(const std::filesystem::path& model, const ModelChoice& choice);

/// The model with the mesh of its body; `placing` says scale, rotation and centre. Throws
/// assets::ModelError; Interrupted when the process was asked to stop during the import.
assets::CleanModel chosen_model(const std::filesystem::path& model, const ModelChoice& choice,
                                assets::CleanOptions placing = {});

/// The scene as TOML, to be kept and edited: only what is not a default, with the reasons, what
/// was repaired and what was simplified. Reads the model, by its absolute path. Throws
/// assets::ModelError.
std::string model_scene_text(const std::filesystem::path& model, const ModelChoice& choice = {});

/// What the scene's file is called: NAME.toml of NAME.ply.
std::filesystem::path model_scene_file(const std::filesystem::path& model);

}  // namespace pneuma::app
