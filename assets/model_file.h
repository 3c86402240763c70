// A model's bytes, and what can be told from them before any importer sees them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "assets/model.h"

namespace pneuma::assets {

/// What to do about a file with too many vertices or triangles.
inline constexpr std::string_view how_to_keep_counts =
    "simplify the model with model.vertices (of a model file --vertices N), or raise "
    "vertices_per_body in [limits], eight times which a file may have that is not simplified";

enum class Format { obj, ply, stl, off, gltf, glb, a3ds, dae, fbx };

/// By the file's ending, upper or lower case. Throws ModelError that lists the endings.
Format format_of(const std::filesystem::path& path);

/// Whether the ending is one of a model's.
bool has_model_ending(const std::filesystem::path& path);

/// "obj, ply, stl, off, gltf, glb, 3ds, dae or fbx".
std::string model_endings();

/// "x", "y" or "z": which axis of the file points upwards. What a DAE says, and y if it does not; y
/// of glTF; z of other formats, whose files come both ways and do not say.
std::string_view up_axis(const std::filesystem::path& path);

/// The whole file. Throws ModelError when it cannot be read, is a folder, is empty or is, with the
/// `read_before` bytes of the model's other files, larger than `max_bytes`; no more than that is
/// read.
std::string read_model_file(const std::filesystem::path& path, std::size_t max_bytes,
                            std::size_t read_before = 0);

/// Takes the comments, from # to the end of a line, and lines that hold nothing else out of a text
/// of the format OFF. The importer knows neither everywhere.
std::string without_comments(std::string_view off);

/// Throws ModelError when the bytes are not of the format, or when a header announces more than the
/// file can hold or than `max_vertices` and `max_triangles`: importers believe it, and reserve
/// memory for it. Formats without counts in one place (obj, gltf, dae, fbx, 3ds) pass when they
/// begin as they must.
void check_model_header(Format format, std::string_view bytes, std::size_t max_vertices,
                        std::size_t max_triangles);

/// "12:5: 'q' is not a number", by line and column, of the first such word where an OFF file, or a
/// PLY or STL file of text, must have numbers; empty: none was found, or it is of another format.
/// The importer does not tell the line.
std::string number_mistake(Format format, std::string_view file);

}  // namespace pneuma::assets
