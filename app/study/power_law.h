// Straight lines through measured points, also in double logarithmic diagrams.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace pneuma::app {

/// y = start + slope * x.
struct Line {
  double slope = 0.0;
  double start = 0.0;
};

/// Least squares, of as many y as x, of which not all are equal.
Line fit_line(std::span<const double> x, std::span<const double> y);

/// y = factor * x^exponent.
struct PowerLaw {
  double exponent = 0.0;
  double factor = 1.0;
};

/// Least squares in the logarithms. Throws std::invalid_argument unless there are as many y as x,
/// at least two, all finite and above zero, and not all x equal.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

/// ln(y1 / y0) / ln(x1 / x0) of each two neighbours: one fewer than points. Throws as fit_power_law
/// does, also for two neighbours of one x.
std::vector<double> local_exponents(std::span<const double> x, std::span<const double> y);

/// Points first .. last of a series, last among them.
struct PointRange {
  std::size_t first = 0;
  std::size_t last = 0;

  std::size_t count() const { return last - first + 1; }
};

/// The longest run of at least three neighbouring points whose local exponents all lie within
/// `band` of each other: where a power law is reached. Of several, the last. Nothing when there is
/// none. It does not ask what the exponent is, so that a fit in it can contradict a theory.
std::optional<PointRange> power_law_range(std::span<const double> x, std::span<const double> y,
                                          double band);

}  // namespace pneuma::app
