// The line of a number that is none, in files of text: the importer does not tell it.
#pragma once

#include <string>
#include <string_view>

#include "assets/model_file.h"

namespace pneuma::assets {

/// "line 12: 'q' is not a number", of the first such word where an OFF file, or a PLY or STL file
/// of text, must have numbers; empty: none was found, or it is of another format.
std::string number_mistake(Format format, std::string_view file);

}  // namespace pneuma::assets
