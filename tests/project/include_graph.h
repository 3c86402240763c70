// Which source file includes what, read from the #include lines.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pneuma {

struct Include {
  std::string file;      // which includes, by its path from the project's folder
  int line = 0;          // from 1
  std::string included;  // as written, without quotes or brackets
  bool ours = false;     // in quotes; in brackets it belongs to a library
};

/// "sim/step" for "sim/step/stages/plan.h", "" for "plan.h".
std::string folder_of(const std::string& path);

/// Whether `folder` is `parent` or lies anywhere below it.
bool lies_in(std::string_view folder, std::string_view parent);

std::vector<Include> read_includes(const std::string& file, const std::string& text);

/// All #include lines of the sources in these folders and below, in the order of the files' names.
std::vector<Include> includes_of_tree(const std::filesystem::path& project,
                                      const std::vector<std::string>& folders);

/// A folder and the folders that its own files include.
using FolderGraph = std::map<std::string, std::set<std::string>>;
FolderGraph folder_graph(const std::vector<Include>& includes);

/// The folders of one cycle, the first one again at the end; empty without a cycle.
std::vector<std::string> find_cycle(const FolderGraph& graph);

}  // namespace pneuma
