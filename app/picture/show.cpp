#include "app/picture/show.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/host/errors.h"

namespace pneuma::app {
namespace {

using ShowName = std::pair<std::string_view, bool Show::*>;
constexpr std::array<ShowName, 7> show_names = {
    ShowName{"wireframe", &Show::wireframe}, ShowName{"particles", &Show::particles},
    ShowName{"contacts", &Show::contacts},   ShowName{"impulses", &Show::impulses},
    ShowName{"ghost", &Show::ghost},         ShowName{"labels", &Show::labels},
    ShowName{"scale", &Show::scale}};

using FieldName = std::pair<std::string_view, ColourField>;
constexpr std::array<FieldName, 3> field_names = {FieldName{"strain", ColourField::strain},
                                                  FieldName{"velocity", ColourField::velocity},
                                                  FieldName{"pressure", ColourField::pressure}};

double parse_number(const std::string& option, const std::string& item, std::string_view text,
                    std::string_view wrong) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value) ||
      value <= 0.0) {
    throw UsageError(fmt::format("{}: '{}' {}", option, item, wrong));
  }
  return value;
}

void add_field(const std::string& option, const std::string& item, Show& show) {
  const std::size_t sign = std::min(item.find('='), item.size());
  const auto known =
      std::ranges::find(field_names, std::string_view(item).substr(0, sign), &FieldName::first);
  if (known == field_names.end()) {
    throw UsageError(
        fmt::format("{}: '{}' is not known; allowed are wireframe, particles, contacts, impulses, "
                    "ghost, labels, "
                    "scale, strain, velocity and pressure",
                    option, item));
  }
  if (show.field != ColourField::none) {
    throw UsageError(fmt::format(
        "{}: '{}' is a second way to colour surfaces; allowed is one of strain, velocity and "
        "pressure",
        option, item));
  }
  show.field = known->second;
  if (sign < item.size()) {
    show.field_end =
        parse_number(option, item, std::string_view(item).substr(sign + 1),
                     "ends its colours nowhere; write a number above zero, as velocity=5");
  }
}

constexpr std::string_view impulses_equal = "impulses=";

}  // namespace

std::vector<std::string> shown_names(const Show& show) {
  std::vector<std::string> names;
  for (const auto& [name, member] : show_names) {
    if (!(show.*member)) continue;
    const bool has_scale = member == &Show::impulses && show.arrow_scale;
    names.push_back(has_scale ? fmt::format("{}{}", impulses_equal, *show.arrow_scale)
                              : std::string(name));
  }
  for (const auto& [name, field] : field_names) {
    if (show.field != field) continue;
    names.push_back(show.field_end ? fmt::format("{}={}", name, *show.field_end)
                                   : std::string(name));
  }
  return names;
}

std::string field_name(ColourField field) {
  const auto found = std::ranges::find(field_names, field, &FieldName::second);
  return found == field_names.end() ? "" : std::string(found->first);
}

Show parse_show(const std::string& option, const std::string& list) {
  Show show;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string item = list.substr(begin, end - begin);
    const auto known = std::ranges::find(show_names, item, &ShowName::first);
    if (item.starts_with(impulses_equal)) {
      show.impulses = true;
      show.arrow_scale = parse_number(
          option, item, std::string_view(item).substr(impulses_equal.size()),
          "gives arrows no length; write the N s of one metre, above zero, as impulses=0.5");
    } else if (known == show_names.end()) {
      add_field(option, item, show);
    } else {
      show.*known->second = true;
    }
    begin = end + 1;
  }
  return show;
}

}  // namespace pneuma::app
