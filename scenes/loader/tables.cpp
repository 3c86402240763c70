#include "scenes/loader/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "scenes/loader/sections.h"
#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

std::vector<std::string_view> find_table_names() {
  std::vector<std::string_view> names;
  for (const Section& section : default_sections()) {
    if (!section.table.empty() && !is_listed(section.table)) names.push_back(section.table);
  }
  return names;
}

std::vector<std::string_view> find_body_tables() {
  std::vector<std::string_view> names;
  for (const Key& key : default_sections().back().keys) {
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
  if (table.empty()) children.insert(children.end(), {"body", "valve", "spring"});
  return children;
}

const std::vector<std::string_view>& body_tables() {
  static const std::vector<std::string_view> names = find_body_tables();
  return names;
}

std::vector<const Key*> keys_of_body_table(std::string_view table) {
  std::vector<const Key*> keys;
  for (const Key& key : default_sections().back().keys) {
    const std::size_t dot = key.name.find('.');
    if (dot != key.name.npos && key.name.substr(0, dot) == table) keys.push_back(&key);
  }
  return keys;
}

bool is_body_table(std::string_view name) {
  const std::vector<std::string_view>& names = body_tables();
  return std::find(names.begin(), names.end(), name) != names.end();
}

namespace {

/// By which a table may be meant: "particles" is enough for "simulation.particles".
std::string_view last_part(std::string_view table) {
  const std::size_t dot = table.rfind('.');
  return dot == table.npos ? table : table.substr(dot + 1);
}

/// "body" of "bodies", "light" of "lights"; a name that is no plural stays.
std::string singular(std::string_view name) {
  const auto without = [&](std::size_t letters) { return name.substr(0, name.size() - letters); };
  if (name.ends_with("ies")) return fmt::format("{}y", without(3));
  if (name.ends_with('s')) return std::string(without(1));
  return std::string(name);
}

constexpr std::size_t fewest_letters = 3;  // that stand for a longer name: "cam", "sim"

struct NamedHeader {
  std::string_view name;
  std::string header;
};

/// Every table that a header can start, those within a [[body]] among them.
std::vector<NamedHeader> all_headers() {
  std::vector<NamedHeader> headers;
  for (const Section& section : default_sections()) {
    if (!section.table.empty())
      headers.push_back({last_part(section.table), header_of(section.table)});
  }
  for (const std::string_view table : body_tables()) {
    headers.push_back({table, fmt::format("[body.{}]", table)});
  }
  return headers;
}

/// One of the names, or none when none is near.
std::optional<std::string_view> nearest_table(std::string_view name,
                                              const std::vector<std::string_view>& names) {
  const std::string one = singular(name);
  for (const std::string_view meant : {name, std::string_view(one)}) {
    if (const auto found = base::nearest(meant, names)) return found;
  }
  if (name.size() < fewest_letters) return std::nullopt;
  const auto begun =
      std::ranges::find_if(names, [&](std::string_view table) { return table.starts_with(name); });
  return begun == names.end() ? std::nullopt : std::optional(*begun);
}

}  // namespace

std::string table_suggestion(std::string_view name) {
  const std::vector<NamedHeader> all = all_headers();
  std::vector<std::string_view> names, headers;
  for (const NamedHeader& table : all) {
    names.push_back(table.name);
    headers.push_back(table.header);
  }
  std::string hint = ";";
  if (const auto near = nearest_table(name, names)) {
    const auto table = std::ranges::find(all, *near, &NamedHeader::name);
    hint = fmt::format("; did you mean {}?", table->header);
  }
  return fmt::format("{} tables: {}", hint, fmt::join(headers, ", "));
}

}  // namespace pneuma::scenes
