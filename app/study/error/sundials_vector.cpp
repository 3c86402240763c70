#include "app/study/error/sundials_vector.h"

#include <nvector/nvector_serial.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace pneuma::app {
namespace {

using Values = Eigen::Map<Eigen::ArrayXd>;

Values values_of(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<Eigen::Index>(N_VGetLength(vector))};
}

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  values_of(z) = a * values_of(x) + b * values_of(y);
}

void scale(double a, N_Vector x, N_Vector z) { values_of(z) = a * values_of(x); }

void absolute(N_Vector x, N_Vector z) { values_of(z) = values_of(x).abs(); }

void inverse(N_Vector x, N_Vector z) { values_of(z) = values_of(x).inverse(); }

void add_constant(N_Vector x, double b, N_Vector z) { values_of(z) = values_of(x) + b; }

void product(N_Vector x, N_Vector y, N_Vector z) { values_of(z) = values_of(x) * values_of(y); }

double dot(N_Vector x, N_Vector y) { return values_of(x).matrix().dot(values_of(y).matrix()); }

double weighted_root_mean_square(N_Vector x, N_Vector weights) {
  const Values of_x = values_of(x);
  return std::sqrt((of_x * values_of(weights)).square().sum() / static_cast<double>(of_x.size()));
}

/// z may be one of x: so much of each is read before as much of z is written.
int linear_combination(int count, double* factors, N_Vector* x, N_Vector z) {
  constexpr Eigen::Index piece = 128;
  Eigen::Array<double, piece, 1> sum;
  Values result = values_of(z);
  for (Eigen::Index first = 0; first < result.size(); first += piece) {
    const Eigen::Index size = std::min(piece, result.size() - first);
    sum.head(size) = factors[0] * values_of(x[0]).segment(first, size);
    for (int i = 1; i < count; ++i) {
      sum.head(size) += factors[i] * values_of(x[i]).segment(first, size);
    }
    result.segment(first, size) = sum.head(size);
  }
  return 0;
}

int scale_add_each(int count, double* factors, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int i = 0; i < count; ++i) linear_sum(factors[i], x, 1.0, y[i], z[i]);
  return 0;
}

int dot_each(int count, N_Vector x, N_Vector* y, double* products) {
  for (int i = 0; i < count; ++i) products[i] = dot(x, y[i]);
  return 0;
}

}  // namespace

N_Vector make_vector(sunindextype count, double* values, SUNContext context) {
  N_Vector vector = N_VMake_Serial(count, values, context);
  if (vector == nullptr) return nullptr;
  auto& operations = *vector->ops;  // clones take them over
  operations.nvlinearsum = linear_sum;
  operations.nvscale = scale;
  operations.nvabs = absolute;
  operations.nvinv = inverse;
  operations.nvaddconst = add_constant;
  operations.nvprod = product;
  operations.nvdotprod = dot;
  operations.nvwrmsnorm = weighted_root_mean_square;
  operations.nvlinearcombination = linear_combination;
  operations.nvscaleaddmulti = scale_add_each;
  operations.nvdotprodmulti = dot_each;
  return vector;
}

}  // namespace pneuma::app
