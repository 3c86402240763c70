// SUNDIALS' serial vector with the sums that methods spend their time on written for the
// processor's vector units, as ours are: Debian compiles its own for any x86-64, number by number.
#pragma once

#include <sundials/sundials_nvector.h>

namespace pneuma::app {

/// Numbers that the caller keeps; clones own theirs. Null when there is no memory.
N_Vector make_vector(sunindextype count, double* values, SUNContext context);

}  // namespace pneuma::app
