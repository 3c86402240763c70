#include "tests/project/include_graph.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace pneuma {
namespace {

namespace fs = std::filesystem;

bool is_source(const fs::path& path) {
  return path.extension() == ".h" || path.extension() == ".cpp";
}

std::vector<fs::path> sources_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (is_source(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// Depth-first search: `path` holds the folders from the start to the current one.
bool extend_to_cycle(const FolderGraph& graph, std::vector<std::string>& path,
                     std::set<std::string>& finished) {
  const std::string here = path.back();
  const auto entry = graph.find(here);
  if (entry == graph.end()) return false;
  for (const std::string& next : entry->second) {
    if (next == here || finished.contains(next)) continue;
    const auto start = std::ranges::find(path, next);
    const bool closes = start != path.end();
    if (closes) path.erase(path.begin(), start);
    path.push_back(next);
    if (closes || extend_to_cycle(graph, path, finished)) return true;
    path.pop_back();
  }
  finished.insert(here);
  return false;
}

}  // namespace

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

bool lies_in(std::string_view folder, std::string_view parent) {
  return folder.starts_with(parent) &&
         (folder.size() == parent.size() || folder[parent.size()] == '/');
}

std::vector<Include> read_includes(const std::string& file, const std::string& text) {
  static const std::regex include(R"(\s*#\s*include\s*(?:"([^"]+)\"|<([^>]+)>).*)");
  std::vector<Include> includes;
  std::istringstream lines(text);
  std::smatch match;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!std::regex_match(line, match, include)) continue;
    const bool ours = match[1].matched;
    includes.push_back({file, number, ours ? match[1] : match[2], ours});
  }
  return includes;
}

std::vector<Include> includes_of_tree(const fs::path& project,
                                      const std::vector<std::string>& folders) {
  std::vector<Include> all;
  for (const std::string& folder : folders) {
    for (const fs::path& path : sources_below(project / folder)) {
      std::ifstream file(path, std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      const auto includes = read_includes(path.lexically_relative(project).generic_string(), text);
      all.insert(all.end(), includes.begin(), includes.end());
    }
  }
  return all;
}

FolderGraph folder_graph(const std::vector<Include>& includes) {
  FolderGraph graph;
  for (const Include& include : includes) {
    if (include.ours) graph[folder_of(include.file)].insert(folder_of(include.included));
  }
  return graph;
}

std::vector<std::string> find_cycle(const FolderGraph& graph) {
  std::set<std::string> finished;
  for (const auto& [folder, included] : graph) {
    std::vector<std::string> path = {folder};
    if (extend_to_cycle(graph, path, finished)) return path;
  }
  return {};
}

}  // namespace pneuma
