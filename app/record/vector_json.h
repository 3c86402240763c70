// Vectors as JSON has them.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace pneuma::app {

/// JSON has no NaN and no infinity; null says that there is no such number.
template <class Json = nlohmann::json>
Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Three numbers.
template <class Json = nlohmann::json, class Vector>
Json vector_json(const Vector& vector) {
  return Json::array(
      {number_json<Json>(vector[0]), number_json<Json>(vector[1]), number_json<Json>(vector[2])});
}

}  // namespace pneuma::app
