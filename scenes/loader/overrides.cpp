#include "scenes/loader/overrides.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "scenes/loader/sections.h"
#include "scenes/loader/tables.h"
#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

/// Thrown and caught in this file only: why an override cannot be applied.
struct RefusedOverride {
  std::string message;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t start = 0;;) {
    const std::size_t dot = path.find('.', start);
    parts.emplace_back(path.substr(start, dot - start));
    if (dot == std::string_view::npos) return parts;
    start = dot + 1;
  }
}

/// A TOML value, or else a bare word.
Value parse_value(std::string_view text, int index) {
  Value value;
  value.at = {1, 1, index};
  if (text.find_first_of("\r\n") != std::string_view::npos) {
    throw RefusedOverride{"the value holds a line break; write it on one line"};
  }
  try {
    value.data = parse_document(fmt::format("value = {}", text), index).front().value.data;
  } catch (const SyntaxError& error) {
    const bool meant_as_toml =
        !text.empty() && std::string_view("[{\"'").find(text[0]) != text.npos;
    if (meant_as_toml)
      throw RefusedOverride{fmt::format("the value cannot be read: {}", error.what())};
    value.data = std::string(text);
  }
  return value;
}

void put(Table& table, const std::string& key, Value value, bool where_it_applies) {
  if (Member* member = find(table, key)) {
    member->value = std::move(value);
  } else {
    const Origin at = value.at;
    table.push_back(
        {.key = key, .at = at, .value = std::move(value), .where_it_applies = where_it_applies});
  }
}

/// The body's key that a path names from its part `first` on: one name, or a table within the body
/// and one of that table's; none when it is neither.
std::optional<std::string> key_at(const std::vector<std::string>& path, std::size_t first) {
  if (first >= path.size()) return std::nullopt;
  const std::size_t parts = path.size() - first;
  const std::string& name = path[first];
  if (!is_body_table(name)) return parts == 1 ? std::optional(name) : std::nullopt;
  if (parts == 1) {
    throw RefusedOverride{fmt::format("{} is a table; set its keys one by one", name)};
  }
  return parts == 2 ? std::optional(name + '.' + path[first + 1]) : std::nullopt;
}

class Override {
 public:
  Override(Table& document, int index)
      : document_(document), index_(index), bodies_(list_of("body")) {}

  void apply(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
      throw RefusedOverride{"expected PATH=VALUE, such as duration=2 or body.k=200"};
    }
    auto path = split(trimmed(text.substr(0, equals)));
    if (is_body_table(path[0])) path.insert(path.begin(), "body");
    if (std::any_of(path.begin(), path.end(), [](const auto& part) { return part.empty(); })) {
      throw RefusedOverride{
          "expected PATH=VALUE, where PATH is names with full stops between them"};
    }
    value_ = parse_value(trimmed(text.substr(equals + 1)), index_);
    if (is_listed(path[0]))
      put_into_list(path);
    else if (path.size() == 1 || is_table(path[0]))
      put_into_table(path);
    else
      put_into_named_body(path);
  }

 private:
  static bool is_table(std::string_view name) {
    return std::find(table_names().begin(), table_names().end(), name) != table_names().end();
  }

  /// "simulation.particles.max_sweeps": as many tables as there are, then one key.
  void put_into_table(const std::vector<std::string>& path) {
    Table* table = &document_;
    std::string walked;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const std::string name = walked.empty() ? path[i] : walked + "." + path[i];
      const bool last = i + 1 == path.size();
      if (!is_table(name)) {
        if (!last) {
          throw RefusedOverride{fmt::format("{} is no table, and has no keys of its own{}",
                                            base::in_quotes(name),
                                            base::suggestion(name, table_names()))};
        }
        put(*table, path[i], value_, false);
        return;
      }
      table = enter(*table, path[i]);
      if (table == nullptr) return;
      walked = name;
    }
    throw RefusedOverride{fmt::format("{} is a table; set its keys one by one", walked)};
  }

  /// The table within a table, made if it is missing; null, for the reader to report, when the
  /// file has something else in its place.
  Table* enter(Table& table, const std::string& name) const {
    if (find(table, name) == nullptr) {
      const Origin at = {1, 1, index_};
      table.push_back({.key = name, .at = at, .value = {at, Table()}});
    }
    return std::get_if<Table>(&find(table, name)->value.data);
  }

  Array* list_of(std::string_view table) {
    Member* list = find(document_, table);
    return list == nullptr ? nullptr : std::get_if<Array>(&list->value.data);
  }

  std::size_t body_count() const { return bodies_ == nullptr ? 0 : bodies_->size(); }

  void put_into_list(const std::vector<std::string>& path) {
    Array* list = list_of(path[0]);
    const std::size_t count = list == nullptr ? 0 : list->size();
    if (const auto key = key_at(path, 1)) {
      for (std::size_t i = 0; i < count; ++i) put_into((*list)[i], *key, true);
      return;
    }
    const auto key = key_at(path, 2);
    if (!key) {
      throw RefusedOverride{fmt::format("expected {0}.KEY=VALUE or {0}.NUMBER.KEY=VALUE", path[0])};
    }
    std::size_t number = 0;
    const char* end = path[1].data() + path[1].size();
    const auto [stop, error] = std::from_chars(path[1].data(), end, number);
    if (error != std::errc() || stop != end || number < 1 || number > count) {
      throw RefusedOverride{
          fmt::format("there is no {} number {}; the scene has {}, counted from 1", path[0],
                      base::in_quotes(path[1]), count)};
    }
    put_into((*list)[number - 1], *key, false);
  }

  void put_into_named_body(const std::vector<std::string>& path) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < body_count(); ++i) names.push_back(body_name(i));
    const auto found = std::find(names.begin(), names.end(), path[0]);
    if (found == names.end()) {
      std::vector<std::string_view> candidates(table_names());
      candidates.push_back("body");
      candidates.insert(candidates.end(), body_tables().begin(), body_tables().end());
      candidates.insert(candidates.end(), names.begin(), names.end());
      constexpr std::size_t most_named = 10;
      const auto end =
          names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most_named));
      throw RefusedOverride{
          fmt::format("there is no table or body {}{}; bodies: {}{}", base::in_quotes(path[0]),
                      base::suggestion(path[0], candidates),
                      base::printable(fmt::format("{}", fmt::join(names.begin(), end, ", "))),
                      names.size() > most_named ? ", ..." : "")};
    }
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (names_copy(index, path)) {
      throw RefusedOverride{
          fmt::format("the copies of {0} cannot be set one by one: {0}.{1} sets it for all of "
                      "them; for one alone write a [[body]] of its own in place of that copy",
                      base::printable(path[0]), fmt::join(path.begin() + 2, path.end(), "."))};
    }
    const auto key = key_at(path, 1);
    if (!key) throw RefusedOverride{"expected NAME.KEY=VALUE"};
    put_into((*bodies_)[index], *key, false);
  }

  /// "ball.2.k", where the body "ball" has copies.
  bool names_copy(std::size_t index, const std::vector<std::string>& path) const {
    if (path.size() < 3 || path[1].find_first_not_of("0123456789") != std::string::npos) {
      return false;
    }
    const auto* table = std::get_if<Table>(&(*bodies_)[index].data);
    return table != nullptr && find(*table, "copies") != nullptr;
  }

  std::string body_name(std::size_t i) const {
    const auto* table = std::get_if<Table>(&(*bodies_)[i].data);
    const Member* name = table == nullptr ? nullptr : find(*table, "name");
    const auto* text = name == nullptr ? nullptr : std::get_if<std::string>(&name->value.data);
    return text == nullptr ? default_name(i) : *text;
  }

  void put_into(Value& item, const std::string& key, bool where_it_applies) {
    if (auto* table = std::get_if<Table>(&item.data)) put(*table, key, value_, where_it_applies);
  }

  Table& document_;
  int index_;
  Array* bodies_;
  Value value_;
};

}  // namespace

void apply_overrides(std::span<const std::string> overrides, Table& document, Report& report) {
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    const int index = static_cast<int>(i);
    try {
      Override(document, index).apply(overrides[i]);
    } catch (const RefusedOverride& refusal) {
      report.add({0, 0, index}, refusal.message);
    }
  }
}

bool is_overridden(std::span<const std::string> overrides, std::string_view path) {
  return std::ranges::any_of(overrides, [&](const std::string& text) {
    return trimmed(std::string_view(text).substr(0, text.find('='))) == path;
  });
}

std::optional<double> number_override(std::span<const std::string> overrides,
                                      std::string_view path) {
  std::optional<double> number;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || trimmed(std::string_view(text).substr(0, equals)) != path) continue;
    number.reset();
    try {
      const Value value = parse_value(trimmed(std::string_view(text).substr(equals + 1)), 0);
      if (const auto* whole = std::get_if<std::int64_t>(&value.data)) {
        number = static_cast<double>(*whole);
      } else if (const auto* real = std::get_if<double>(&value.data)) {
        number = *real;
      }
    } catch (const RefusedOverride&) {  // said when the overrides are applied
    }
  }
  return number;
}

}  // namespace pneuma::scenes
