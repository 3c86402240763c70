// SUNDIALS CVODE behind one small class; the only file that includes it.
//
// Hindmarsh et al., SUNDIALS: Suite of nonlinear and differential/algebraic equation solvers, ACM
// Transactions on Mathematical Software 31 (2005).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace pneuma::app {

enum class CvodeMethod {
  adams,  // orders 1 to 12, each step's equation solved by fixed-point iteration: not stiff
  bdf,    // orders 1 to 5, by Newton's method with matrix-free GMRES: stiff
};
std::string_view to_string(CvodeMethod method);

/// "6.4.1".
std::string sundials_version();

/// Errors are kept below relative * |y| + absolute, per component and step.
struct CvodeTolerances {
  double relative = 1e-6;
  std::vector<double> absolute;  // per component
};

class Cvode {
 public:
  /// Writes dy/dt; false when the state has no meaning, which makes CVODE try a shorter step.
  using RightHandSide = std::function<bool(const double* state, double* derivative)>;

  /// Starts at time 0. Throws std::runtime_error when CVODE does not take the values.
  Cvode(CvodeMethod method, RightHandSide right_hand_side, std::vector<double> start,
        const CvodeTolerances& tolerances);
  ~Cvode();
  Cvode(Cvode&&) noexcept;
  Cvode& operator=(Cvode&&) noexcept;

  /// To `time` (s), beyond all times before, with steps of CVODE's own choice; the state is
  /// interpolated between them. False when CVODE gave up.
  [[nodiscard]] bool advance_to(double time);

  const std::vector<double>& state() const;
  /// Of the right-hand side, those for GMRES among them.
  long evaluations() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace pneuma::app
