// The tables of a scene file by name, as the sections give them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/keys.h"

namespace pneuma::scenes {

/// Every table but [[body]], with its path: "simulation", "simulation.particles", "ground", ...
const std::vector<std::string_view>& table_names();

/// The tables directly within one: "particles" within "simulation"; "body" among those within "".
std::vector<std::string_view> child_tables(std::string_view table);

/// For a header that is none of theirs: "; did you mean [[body]]?", if one has a name near it, and
/// all there are.
std::string table_suggestion(std::string_view name);

/// The tables within a [[body]]. They are for people only: to the loader "model.file" is one key of
/// the body.
const std::vector<std::string_view>& body_tables();
bool is_body_table(std::string_view name);

/// Those of a table within a [[body]], as body_tables() has it: "model.file", "model.component",
/// ...
std::vector<const Key*> keys_of_body_table(std::string_view table);

}  // namespace pneuma::scenes
