// What is measured of a world, in the one form that all JSON files of the program have.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "app/record/vector_json.h"
#include "sim/inspect/inspect.h"
#include "sim/step/stages/plan.h"

namespace pneuma::app {

/// Of everything below.
inline constexpr std::string_view json_units =
    "metre, kilogram, second, kelvin, mole, joule; the gas energy is -nRT ln(V / 1 m^3), "
    "that of gravity 0 at the origin";

/// "0x0123456789abcdef", of hashes and fingerprints: JSON's numbers do not hold 64 bits everywhere.
inline std::string hex(std::uint64_t value) { return fmt::format("{:#018x}", value); }

template <class Json = nlohmann::json>
Json energy_json(const sim::Energy& energy) {
  return {{"kinetic", number_json<Json>(energy.kinetic)},
          {"spring", number_json<Json>(energy.spring)},
          {"gas", number_json<Json>(energy.gas)},
          {"gravity", number_json<Json>(energy.gravity)},
          {"contact", number_json<Json>(energy.contact)},
          {"total", number_json<Json>(energy.total())}};
}

template <class Json = nlohmann::json>
Json momentum_json(const sim::Momentum& momentum) {
  return {{"linear", vector_json<Json>(momentum.linear)},
          {"angular", vector_json<Json>(momentum.angular)}};
}

/// An object with `value(kind)` for each kind of contact, by its name.
template <class Json = nlohmann::json, class Value>
Json json_by_contact_kind(const Value& value) {
  Json json = Json::object();
  for (int k = 0; k < sim::contact_kind_count; ++k) {
    const auto kind = static_cast<sim::ContactKind>(k);
    json[std::string(sim::to_string(kind))] = value(kind);
  }
  return json;
}

/// An object with `value(stage)` for each stage of a step, by its name.
template <class Json = nlohmann::json, class Value>
Json json_by_stage(const Value& value) {
  Json json = Json::object();
  for (int s = 0; s < sim::stage_count; ++s) {
    const auto stage = static_cast<sim::Stage>(s);
    json[std::string(sim::to_string(stage))] = value(stage);
  }
  return json;
}

}  // namespace pneuma::app
