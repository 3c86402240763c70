// What the fuzzers do with the bytes they make up. Plain functions, so that inputs that once broke
// something are tests in every build (inputs_test.cpp).
#pragma once

#include <string_view>

namespace pneuma::fuzz {

// Each returns when the bytes were refused as the headers say, or accepted with every promise kept.
// Throws std::logic_error for a promise that is broken; whatever else comes out is a fault too.

/// A scene file; after each zero byte, which no scene file may hold, one override. What is accepted
/// and printed must read back as the same scene. Complaints must be about places in the file.
void try_scene(std::string_view bytes);

/// A triangle soup (triangle_soup.h). What clean_mesh accepts must be what its header promises.
void try_mesh(std::string_view bytes);

/// What looks at a model's bytes before and after the importer library does: the checks of headers
/// and the form in which a model comes back from the importer's process.
void try_model_bytes(std::string_view bytes);

}  // namespace pneuma::fuzz
