// The only file that includes toml++. Header-only, because the settings below are made when it is
// compiled, and the packaged library was built with others.
#include "scenes/loader/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "scenes/loader/guard.h"
#include "scenes/loader/text_checks.h"
#include "sim/base/nearest.h"

namespace {
/// toml++ asserts its own state while it parses, and not every text keeps it (guard.h). Its checks
/// are on in every build, and this is what they call.
[[noreturn]] void throw_broken_state(const char* condition) { throw std::logic_error(condition); }
}  // namespace
#define TOML_ASSERT(condition) \
  (static_cast<bool>(condition) ? void() : throw_broken_state(#condition))
#define TOML_HEADER_ONLY 1
#define TOML_MAX_NESTED_VALUES 16
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace pneuma::scenes {
namespace {

Origin origin_of(const toml::source_region& source, int override_index) {
  return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column),
          override_index};
}

/// Turns toml++'s nodes into ours.
class Converter {
 public:
  explicit Converter(int override_index) : override_index_(override_index) {}

  Table table(const toml::table& source) const {
    Table result;
    result.reserve(source.size());
    for (const auto& [key, node] : source) {
      result.push_back({.key = std::string(key.str()),
                        .at = origin_of(key.source(), override_index_),
                        .value = value(node)});
    }
    // toml++ sorts by name; the file's order is what people see.
    std::stable_sort(result.begin(), result.end(), [](const Member& a, const Member& b) {
      return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
    });
    return result;
  }

 private:
  Value value(const toml::node& node) const {
    Value result;
    result.at = origin_of(node.source(), override_index_);
    if (const auto* flag = node.as_boolean()) {
      result.data = flag->get();
    } else if (const auto* integer = node.as_integer()) {
      result.data = integer->get();
    } else if (const auto* number = node.as_floating_point()) {
      result.data = number->get();
    } else if (const auto* text = node.as_string()) {
      result.data = text->get();
    } else if (const auto* members = node.as_table()) {
      result.data = table(*members);
    } else if (const auto* elements = node.as_array()) {
      Array array;
      array.reserve(elements->size());
      for (const toml::node& element : *elements) array.push_back(value(element));
      result.data = std::move(array);
    } else {
      result.data = Moment{};
    }
    return result;
  }

  int override_index_;
};

template <class Members>
auto* find_member(Members& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Member& member) { return member.key == key; });
  return found == table.end() ? nullptr : &*found;
}

/// The value in an array or behind an equals sign in which the place is.
std::string_view value_around(std::string_view text, const toml::source_position& place) {
  for (toml::source_index line = 1; line < place.line; ++line) {
    text.remove_prefix(std::min(text.size(), text.find('\n')) + (text.find('\n') < text.size()));
  }
  text = text.substr(0, text.find_first_of("\r\n"));
  const std::size_t at = std::min(text.size(), std::size_t{place.column} - 1);
  const std::size_t begin = text.substr(0, at).find_last_of("=[,") + 1;
  text = text.substr(begin, text.find_first_of(",]}#", at) - begin);
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

struct Describe {
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t integer) const { return fmt::format("integer {}", integer); }
  std::string operator()(double number) const { return fmt::format("number {}", number); }
  std::string operator()(const std::string& text) const {
    const std::string result = base::in_quotes(text);
    return fmt::format("string \"{}\"", result.substr(1, result.size() - 2));
  }
  std::string operator()(Moment) const { return "a date or time"; }
  std::string operator()(const Array& array) const {
    return fmt::format("an array of {}", array.size());
  }
  std::string operator()(const Table&) const { return "a table"; }
};

}  // namespace

Member* find(Table& table, std::string_view key) { return find_member(table, key); }
const Member* find(const Table& table, std::string_view key) { return find_member(table, key); }

bool holds_tables(const Value& value) {
  if (std::holds_alternative<Table>(value.data)) return true;
  const auto* array = std::get_if<Array>(&value.data);
  return array != nullptr && !array->empty() && std::ranges::all_of(*array, holds_tables);
}

std::string describe(const Value& value) { return std::visit(Describe{}, value.data); }

Table parse_document(std::string_view text, int override_index) {
  const std::string ascii = guarded(text, override_index);
  try {
    return Converter(override_index).table(toml::parse(ascii));
  } catch (const toml::parse_error& error) {
    throw SyntaxError(origin_of(error.source(), override_index),
                      base::printable(error.description()) +
                          number_hint(value_around(ascii, error.source().begin)));
  } catch (const std::logic_error&) {
    throw SyntaxError({1, 1, override_index}, "this is not TOML, and the parser cannot tell where");
  }
}

}  // namespace pneuma::scenes
