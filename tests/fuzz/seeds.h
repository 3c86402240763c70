// What the fuzzers start from.
#pragma once

#include <string>
#include <vector>

namespace pneuma::fuzz {

/// The project's scenes, as they are and as printed with every key, some with overrides.
std::vector<std::string> scene_seeds();

/// Small closed meshes, and some that are nearly so.
std::vector<std::string> mesh_seeds();

/// A cube in each format, and as a packed model.
std::vector<std::string> model_byte_seeds();

/// libFuzzer's -dict for scenes: the keys and words of scene files.
std::string scene_dictionary();

}  // namespace pneuma::fuzz
