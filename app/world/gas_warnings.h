// What to say of bodies that do not keep about the size that they are given.
#pragma once

#include <string>

#include "app/world/gas_advice.h"

namespace pneuma::app {

/// "27.7 m^3 at the start, 94.1 m^3 (3.4 times) at rest without weight".
std::string volumes_text(const GasAdvice& advice);

/// A line about a body that is blown up, with what keeps its size.
std::string gas_warning(const GasAdvice& advice);

/// A line about a body that its springs do not hold, with what would.
std::string shape_warning(const GasAdvice& advice);

/// A line about a body that starts so far from rest that its shape is lost.
std::string start_warning(const GasAdvice& advice);

/// A line about a body that its weight crushes, with what would carry it.
std::string weight_warning(const GasAdvice& advice);

}  // namespace pneuma::app
