#include "scenes/loader/tables.h"

#include <algorithm>

#include "scenes/loader/sections.h"

namespace pneuma::scenes {
namespace {

std::vector<std::string_view> find_table_names() {
  Scene scene;
  std::vector<std::string_view> names;
  for (const Section& section : fixed_sections(scene)) {
    if (!section.table.empty()) names.push_back(section.table);
  }
  return names;
}

std::vector<std::string_view> find_body_tables() {
  BodyScene body;
  std::vector<std::string_view> names;
  for (const Key& key : body_section(body).keys) {
    const std::size_t dot = key.name.find('.');
    if (dot == key.name.npos) continue;
    const std::string_view name = key.name.substr(0, dot);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

}  // namespace

const std::vector<std::string_view>& table_names() {
  static const std::vector<std::string_view> names = find_table_names();
  return names;
}

std::vector<std::string_view> child_tables(std::string_view table) {
  std::vector<std::string_view> children;
  for (const std::string_view name : table_names()) {
    const std::size_t dot = name.rfind('.');
    const std::string_view parent = dot == name.npos ? "" : name.substr(0, dot);
    if (parent == table) children.push_back(dot == name.npos ? name : name.substr(dot + 1));
  }
  if (table.empty()) children.push_back("body");
  return children;
}

const std::vector<std::string_view>& body_tables() {
  static const std::vector<std::string_view> names = find_body_tables();
  return names;
}

bool is_body_table(std::string_view name) {
  const std::vector<std::string_view>& names = body_tables();
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace pneuma::scenes
