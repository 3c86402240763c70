// A scene back as text.
#pragma once

#include <cstdint>
#include <string>

#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// The effective scene as TOML, every key that applies with its unit and meaning; a `*` marks a
/// value that is not the default. parse_scene reads it back to the same scene.
std::string print_scene(const Scene& scene);

/// 64-bit FNV-1a over all values of the scene (not its name): equal scenes, equal fingerprints.
std::uint64_t scene_fingerprint(const Scene& scene);

/// The keys that decide a soft body's mesh, as TOML: bodies of equal texts can share one.
std::string shape_text(const BodyScene& body);

/// All keys of a scene file with allowed values, unit, default and meaning.
std::string scene_reference();

}  // namespace pneuma::scenes
