// The model files of scenes.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/loader/scene.h"
#include "sim/mesh/triangle_mesh.h"

namespace pneuma::app {

/// An absolute path as it is; another one from the scene file's folder, from here, or from a
/// folder of models that come with the program: the first of them where there is such a file.
/// Throws assets::ModelError that lists where it was looked for.
std::filesystem::path find_model(const std::string& file,
                                 const std::filesystem::path& scene_folder);

/// How a scene file in `folder`, which need not be there yet, names the model of an absolute path:
/// from there, if it lies near, so that both can move together; else by that path. Near is below
/// the folder or a folder up to two above, as out/NAME is below where its run was started.
std::string model_name_from(const std::filesystem::path& folder,
                            const std::filesystem::path& model);

/// The mesh of a body whose shape is a model. Throws scenes::SceneError at the body's
/// model.file; Interrupted when the process was asked to stop during the import.
sim::TriangleMesh load_model_mesh(const scenes::Scene& scene, const scenes::BodyScene& body);

/// Why there is no such mesh, or nothing: a scenes::ModelCheck.
std::string model_error(const scenes::Scene& scene, const scenes::BodyScene& body);

}  // namespace pneuma::app
