// Options that several subcommands share, so that they read and work alike.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "app/accuracy/accuracy.h"
#include "app/world/model_scene.h"
#include "render/context/backend.h"

namespace CLI {
class App;
}

namespace pneuma::app {

/// SCENE: one, and required.
void add_scene_option(CLI::App& command, std::string& scene);

/// --set PATH=VALUE, as often as wanted.
void add_override_option(CLI::App& command, std::vector<std::string>& overrides);

/// --accuracy: picture, 1e-2 or 1e-3.
void add_accuracy_option(CLI::App& command, std::optional<Accuracy>& accuracy);

/// --component, --repair, --up and --vertices, of a model file.
void add_model_options(CLI::App& command, ModelChoice& choice);

/// --frames, as typed: see frame_range.h.
void add_frames_option(CLI::App& command, std::string& frames);

/// --backend: osmesa or egl.
void add_backend_option(CLI::App& command, std::optional<render::Backend>& backend);

/// --threads of the simulation: see thread_count.h.
void add_threads_option(CLI::App& command, int& threads);

/// Below a command's help: what one may type, each line a whole command.
void add_examples(CLI::App& command, std::initializer_list<std::string> lines);

/// --quiet.
void add_quiet_option(CLI::App& command, bool& quiet);

}  // namespace pneuma::app
