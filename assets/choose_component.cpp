#include "assets/choose_component.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace pneuma::assets {
namespace {

constexpr std::size_t most_listed = 20;

std::string list(const std::vector<Component>& components) {
  std::string text;
  for (std::size_t i = 0; i < components.size() && i < most_listed; ++i) {
    const Component& component = components[i];
    text +=
        fmt::format("\n  {}{}: {} vertices, {} triangles, {:.4g} x {:.4g} x {:.4g}, {}", i + 1,
                    component.name.empty() ? "" : fmt::format(" '{}'", component.name),
                    component.vertices, component.triangles, component.size.x(), component.size.y(),
                    component.size.z(), component.closed() ? "closed" : "not closed");
  }
  if (components.size() > most_listed) {
    text += fmt::format("\n  and {} more", components.size() - most_listed);
  }
  return text;
}

std::vector<int> named(const std::vector<Component>& components, const std::string& name) {
  std::vector<int> result;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (components[i].name == name) result.push_back(static_cast<int>(i));
  }
  return result;
}

/// Counted from 1; none when it is not a number, or not one of a component.
std::optional<int> numbered(const std::vector<Component>& components, const std::string& text) {
  std::size_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || number < 1 || number > components.size()) {
    return std::nullopt;
  }
  return static_cast<int>(number) - 1;
}

int find_wanted(const std::vector<Component>& components, const std::string& wanted) {
  const std::vector<int> with_name = named(components, wanted);
  if (with_name.size() == 1) return with_name.front();
  if (with_name.size() > 1) {
    throw ModelError(fmt::format("{} components are called '{}'; name one by its number:{}",
                                 with_name.size(), wanted, list(components)));
  }
  if (const auto number = numbered(components, wanted)) return *number;
  throw ModelError(
      fmt::format("the model has no component '{}'; it has:{}", wanted, list(components)));
}

}  // namespace

int choose_component(const std::vector<Component>& components, const std::string& wanted) {
  if (!wanted.empty()) return find_wanted(components, wanted);
  if (components.size() == 1) return 0;
  const auto closed = [](const Component& component) { return component.closed(); };
  const auto count = std::count_if(components.begin(), components.end(), closed);
  if (count == 1) {
    return static_cast<int>(std::find_if(components.begin(), components.end(), closed) -
                            components.begin());
  }
  throw ModelError(fmt::format(
      "the model has {} components, {} closed; a soft body is one, so name it by number or name "
      "with --component (in a scene model.component):{}",
      components.size(), count == 0 ? "none of them" : fmt::format("{} of them", count),
      list(components)));
}

}  // namespace pneuma::assets
