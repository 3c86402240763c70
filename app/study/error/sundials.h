// SUNDIALS' CVODE and ARKODE behind one small class; its file is the only one that includes them.
//
// Hindmarsh et al., SUNDIALS: Suite of nonlinear and differential/algebraic equation solvers, ACM
// Transactions on Mathematical Software 31 (2005).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace pneuma::app {

enum class SundialsMethod {
  cvode_adams,  // orders 1 to 12, each step's equation solved by fixed-point iteration: not stiff
  cvode_bdf,    // orders 1 to 5, by Newton's method with matrix-free GMRES: stiff
  // Explicit Runge-Kutta methods of one order each, with its own choice of the method.
  arkode_3,
  arkode_5,
  arkode_8,
};
inline constexpr std::array sundials_methods = {SundialsMethod::cvode_adams,
                                                SundialsMethod::cvode_bdf, SundialsMethod::arkode_3,
                                                SundialsMethod::arkode_5, SundialsMethod::arkode_8};
std::string_view to_string(SundialsMethod method);

/// "6.4.1".
std::string sundials_version();

/// Errors are kept below relative * |y| + absolute, per component and step.
struct SundialsTolerances {
  double relative = 1e-6;
  std::vector<double> absolute;  // per component
};

class Sundials {
 public:
  /// Writes dy/dt; false when the state has no meaning, which makes CVODE try a shorter
  /// step, and ARKODE give up.
  using RightHandSide = std::function<bool(const double* state, double* derivative)>;

  /// Starts at time 0. Throws std::runtime_error when SUNDIALS does not take the values.
  Sundials(SundialsMethod method, RightHandSide right_hand_side, std::vector<double> start,
           const SundialsTolerances& tolerances);
  ~Sundials();
  Sundials(Sundials&&) noexcept;
  Sundials& operator=(Sundials&&) noexcept;

  /// CVODE calls it with each state that it accepts, at steps of its own choice.
  using StepDone = std::function<void(const double* state)>;
  void set_step_done(StepDone step_done);

  /// To `time` (s), beyond all times before, with steps of the method's own choice; CVODE
  /// interpolates between them, ARKODE ends one there. False when it gave up.
  [[nodiscard]] bool advance_to(double time);

  const std::vector<double>& state() const;
  /// Of the right-hand side, those for GMRES among them.
  long evaluations() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace pneuma::app
