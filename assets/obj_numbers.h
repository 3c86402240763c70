// What the importer does not tell of OBJ files: the numbers that vertices have there, and the line
// of a mistake.
#pragma once

#include <string>
#include <string_view>

#include "assets/model.h"

namespace pneuma::assets {

/// The importer gives each corner of each face a vertex of its own: sets Model::vertices_in_file
/// and vertex_numbers (from 1, as in the format) from the file's lines. Of several vertices in one
/// place the first is named. Changes nothing when a vertex of the model is none of the file's.
void number_as_in_obj(std::string_view file, Model& model);

/// The first line that is none of the format's, as "6:7: f names vertex 9 of 4", by its number and
/// column; empty: none was found. Of vertices and faces only.
std::string obj_mistake(std::string_view file);

}  // namespace pneuma::assets
