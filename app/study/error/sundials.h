// SUNDIALS' CVODE and ARKODE behind one small class; its file and that of their vector are the only
// ones that include them.
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
  // Orders 1 to 5, by Newton's method with matrix-free GMRES: stiff. GMRES alone, and with each of
  // the preconditioners of body_preconditioner.h.
  cvode_bdf,
  cvode_bdf_blocks,
  cvode_bdf_factors,
  // Explicit Runge-Kutta methods of one order each, of ARKODE's own choice, or Dormand and Prince's
  // of order 5. Steps end at each sample; of those named dense, samples are interpolated.
  arkode_3,
  arkode_4,
  arkode_5,
  arkode_dp5,
  arkode_8,
  arkode_3_dense,
  arkode_dp5_dense,
};
inline constexpr std::array sundials_methods = {
    SundialsMethod::cvode_adams,      SundialsMethod::cvode_bdf,
    SundialsMethod::cvode_bdf_blocks, SundialsMethod::cvode_bdf_factors,
    SundialsMethod::arkode_3,         SundialsMethod::arkode_4,
    SundialsMethod::arkode_5,         SundialsMethod::arkode_dp5,
    SundialsMethod::arkode_8,         SundialsMethod::arkode_3_dense,
    SundialsMethod::arkode_dp5_dense};
std::string_view to_string(SundialsMethod method);

inline bool is_preconditioned(SundialsMethod method) {
  return method == SundialsMethod::cvode_bdf_blocks || method == SundialsMethod::cvode_bdf_factors;
}

/// "6.4.1".
std::string sundials_version();

/// Errors are kept below relative * |y| + absolute, per component and step.
struct SundialsTolerances {
  double relative = 1e-6;
  std::vector<double> absolute;  // per component
};

class Sundials {
 public:
  /// Writes dy/dt at a time in s; false when the state has no meaning, which makes CVODE try a
  /// shorter step, and ARKODE give up.
  using RightHandSide = std::function<bool(double time, const double* state, double* derivative)>;

  /// For BDF: M approximates I - gamma df/dy.
  struct Preconditioner {
    virtual ~Preconditioner() = default;
    /// False when there is no M at this state, which makes CVODE try a shorter step.
    [[nodiscard]] virtual bool set_up(const double* state, double gamma) = 0;
    /// Writes z with M z = r.
    virtual void solve(const double* r, double* z) = 0;
  };

  /// Starts at time 0. Throws std::runtime_error when SUNDIALS does not take the values.
  Sundials(SundialsMethod method, RightHandSide right_hand_side, std::vector<double> start,
           const SundialsTolerances& tolerances,
           std::unique_ptr<Preconditioner> preconditioner = nullptr);
  ~Sundials();
  Sundials(Sundials&&) noexcept;
  Sundials& operator=(Sundials&&) noexcept;

  /// CVODE calls it with each state that it accepts, at steps of its own choice.
  using StepDone = std::function<void(double time, const double* state)>;
  void set_step_done(StepDone step_done);

  /// To `time` (s), beyond all times before, with steps of the method's own choice; CVODE and dense
  /// methods interpolate between them, other ARKODE ones end one there. False when it gave up.
  [[nodiscard]] bool advance_to(double time);

  const std::vector<double>& state() const;
  /// Of the right-hand side, those for GMRES among them.
  long evaluations() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace pneuma::app
