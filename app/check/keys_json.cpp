#include "app/check/keys_json.h"

#include <fmt/format.h>

#include "scenes/loader/sections.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

json list(const scenes::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// A member's value as JSON.
struct ValueJson {
  json operator()(std::monostate) const { return nullptr; }
  template <class T>
  json operator()(const T* value) const {
    return *value;
  }
  json operator()(const scenes::Vec3* value) const { return list(*value); }
  json operator()(const std::optional<int>* value) const { return *value ? json(**value) : json(); }
  json operator()(const std::optional<double>* value) const {
    return *value ? json(**value) : json();
  }
  json operator()(const std::optional<scenes::Vec3>* value) const {
    return *value ? list(**value) : json();
  }
  json operator()(const std::optional<sim::ContactMaterial>* value) const {
    return value->has_value();
  }
  json operator()(const scenes::Word& word) const { return word.words[word.get()]; }
};

json text_or_null(std::string_view text) { return text.empty() ? json() : json(text); }

json key_json(std::string_view table, const scenes::Key& key) {
  const auto* word = std::get_if<scenes::Word>(&key.slot);
  return {{"path", table.empty() ? std::string(key.name) : fmt::format("{}.{}", table, key.name)},
          {"takes", scenes::type_text(key.slot)},
          {"words", word == nullptr ? json() : json(word->words)},
          {"range", text_or_null(key.range.text(key.name))},
          {"unit", text_or_null(scenes::units_text(key))},
          {"default", std::visit(ValueJson{}, key.slot)},
          {"only_for", text_or_null(key.only_for)},
          {"set_by_paper_method", key.of_method},
          {"meaning", key.meaning}};
}

}  // namespace

json keys_json() {
  json keys = json::array();
  for (const scenes::Section& section : scenes::default_sections()) {
    for (const scenes::Key& key : section.keys) keys.push_back(key_json(section.table, key));
  }
  return keys;
}

}  // namespace pneuma::app
