// Vertices of OBJ files by the numbers that they have there.
#pragma once

#include <string_view>

#include "assets/model.h"

namespace pneuma::assets {

/// The importer gives each corner of each face a vertex of its own: sets Model::vertices_in_file
/// and vertex_numbers (from 1, as in the format) from the file's lines. Of several vertices in one
/// place the first is named. Changes nothing when a vertex of the model is none of the file's.
void number_as_in_obj(std::string_view file, Model& model);

}  // namespace pneuma::assets
