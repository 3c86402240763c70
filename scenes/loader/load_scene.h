// Scene files: strict TOML in, a checked Scene out, or every error of the file at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// One error. Line and column count from 1; a line of 0 means the file as a whole.
struct Diagnostic {
  std::string file;  // the path, or "--set PATH=VALUE"
  int line = 0;
  int column = 0;
  std::string message;
  std::string source_line = {};  // the whole line of the file; empty: not to be shown
};

Diagnostic diagnostic_at(const Place& place, std::string message);
/// Of a place without a file: at the scene's.
Diagnostic diagnostic_at(const Scene& scene, Place place, std::string message);

/// "file:line:column: message".
std::string to_string(const Diagnostic& diagnostic);

/// The same, and below it the source line with a caret under the column.
std::string with_source_line(const Diagnostic& diagnostic);

/// A scene that cannot be used, or a scene file that cannot be read. what() has every error with
/// its source line, in the order of the file, then those of the overrides.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(std::vector<Diagnostic> diagnostics);

  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// Why a body's model cannot be used, or nothing. The loader itself reads no models.
using ModelCheck = std::function<std::string(const Scene&, const BodyScene&)>;

/// Reads and checks a scene. Each override is "PATH=VALUE", where PATH is
///   duration, simulation.integrator, ...   a key of the file
///   body.k                                 of every body to which the key applies
///   body.2.k, NAME.k                       of the second body, of the body called NAME
///   model.file                             short for body.model.file
/// and VALUE is a TOML value, or a bare word that stands for a string. Later overrides win. They
/// take the place of the file's values before anything is checked, so that a bad value in the file
/// is no error once it is overridden, and checks across keys see the final values. An override of a
/// key that decides which others apply (kind, shape, gas, ground.present, camera.eye, colours,
/// contact) makes the file's keys that then do not apply be ignored, with a warning of those of a
/// body that nothing takes the place of; without it they are errors, but warnings where they are
/// idle under the default contact. Throws SceneError, and of a scene with errors asks `check_model`
/// for those of its models, so that they come at once.
Scene load_scene(const std::filesystem::path& path, std::span<const std::string> overrides = {},
                 const ModelCheck& check_model = {});

/// The same from text. `file` is what diagnostics name and gives the scene's name.
Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  std::span<const std::string> overrides = {}, const ModelCheck& check_model = {});

/// What a list of scenes shows of one.
struct SceneInfo {
  std::filesystem::path path;
  std::string name;
  std::string title;
  std::string figure;
  std::optional<double> paper_fps;
  bool has_flow_or_springs = false;  // gas that comes or goes, or springs between bodies
  std::string error;                 // the first error, when the scene is not valid
};

/// The .toml files of a folder, sorted by name. Throws SceneError when the folder cannot be read.
std::vector<SceneInfo> list_scenes(const std::filesystem::path& folder);

}  // namespace pneuma::scenes
