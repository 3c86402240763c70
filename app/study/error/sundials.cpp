#include "app/study/error/sundials.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "app/study/error/sundials_vector.h"
#include "sim/base/enum_name.h"

namespace pneuma::app {
namespace {

/// From one sample to the next. More than any motion here takes; where the state loses its meaning
/// a method would creep towards that moment for ever.
constexpr long most_steps = 100'000;

void require(int flag, const char* call) {
  if (flag >= 0) return;
  throw std::runtime_error(fmt::format("SUNDIALS: {} failed with {}", call, flag));
}

template <class Pointer>
Pointer require(Pointer pointer, const char* call) {
  if (pointer != nullptr) return pointer;
  throw std::runtime_error(fmt::format("SUNDIALS: {} failed", call));
}

// Debian 12 has SUNDIALS 6, Debian 13 has 7: they name "no MPI" differently, say differently that
// what fails is reported by us alone, and 7 has one set of names for all of ARKODE's methods.
#if SUNDIALS_VERSION_MAJOR >= 7

SUNContext make_context() {
  SUNContext context = nullptr;
  require(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
  require(SUNContext_ClearErrHandlers(context), "SUNContext_ClearErrHandlers");
  return context;
}

// Errors go to the handlers of the context.
void silence_cvode(void* /*solver*/) {}
void silence_arkode(void* /*solver*/) {}

constexpr auto set_arkode_data = ARKodeSetUserData;
constexpr auto set_arkode_steps = ARKodeSetMaxNumSteps;
constexpr auto set_arkode_order = ARKodeSetOrder;
constexpr auto set_arkode_tolerances = ARKodeSVtolerances;
constexpr auto stop_arkode_at = ARKodeSetStopTime;
constexpr auto set_arkode_degree = ARKodeSetInterpolantDegree;
constexpr auto evolve_arkode = ARKodeEvolve;
constexpr auto free_arkode = ARKodeFree;

#else

SUNContext make_context() {
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
  return context;
}

void silence_cvode(void* solver) { require(CVodeSetErrFile(solver, nullptr), "CVodeSetErrFile"); }
void silence_arkode(void* solver) {
  require(ERKStepSetErrFile(solver, nullptr), "ERKStepSetErrFile");
}

constexpr auto set_arkode_data = ERKStepSetUserData;
constexpr auto set_arkode_steps = ERKStepSetMaxNumSteps;
constexpr auto set_arkode_order = ERKStepSetOrder;
constexpr auto set_arkode_tolerances = ERKStepSVtolerances;
constexpr auto stop_arkode_at = ERKStepSetStopTime;
constexpr auto set_arkode_degree = ERKStepSetInterpolantDegree;
constexpr auto evolve_arkode = ERKStepEvolve;
constexpr auto free_arkode = ERKStepFree;

#endif

/// An explicit Runge-Kutta method of ARKODE's.
struct RungeKutta {
  int order = 0;  // 0: it is none
  bool is_dense = false;
  ARKODE_ERKTableID table = ARKODE_ERK_NONE;  // none: ARKODE's own choice
};

RungeKutta runge_kutta(SundialsMethod method) {
  using enum SundialsMethod;
  switch (method) {
    case arkode_3:
      return {3};
    case arkode_4:
      return {4};
    case arkode_5:
      return {5};
    case arkode_dp5:
      return {5, false, ARKODE_DORMAND_PRINCE_7_4_5};
    case arkode_8:
      return {8};
    case arkode_3_dense:
      return {3, true};
    case arkode_dp5_dense:
      return {5, true, ARKODE_DORMAND_PRINCE_7_4_5};
    default:
      return {};
  }
}

// Cubic, from the states and derivatives at both ends of a step. One degree more takes another
// evaluation in each step.
constexpr int dense_degree = 3;

}  // namespace

std::string_view to_string(SundialsMethod method) {
  static constexpr auto names = std::to_array<std::string_view>(
      {"cvode_adams", "cvode_bdf", "cvode_bdf_blocks", "cvode_bdf_factors", "arkode_3", "arkode_4",
       "arkode_5", "arkode_dp5", "arkode_8", "arkode_3_dense", "arkode_dp5_dense"});
  return base::enum_name(names, method);
}

std::string sundials_version() {
  std::array<char, 32> text = {};
  require(SUNDIALSGetVersion(text.data(), static_cast<int>(text.size())), "SUNDIALSGetVersion");
  return text.data();
}

struct Sundials::Memory {
  Memory(RightHandSide given, std::vector<double> start, std::unique_ptr<Preconditioner> own)
      : right_hand_side(std::move(given)),
        preconditioner(std::move(own)),
        values(std::move(start)) {}
  ~Memory() {
    if (is_arkode) {
      free_arkode(&solver);
    } else {
      CVodeFree(&solver);
    }
    if (linear != nullptr) SUNLinSolFree(linear);
    if (nonlinear != nullptr) SUNNonlinSolFree(nonlinear);
    if (state != nullptr) N_VDestroy(state);
    if (context != nullptr) SUNContext_Free(&context);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  void set_up(SundialsMethod method, const SundialsTolerances& tolerances);
  void set_up_cvode(SundialsMethod method);
  void set_up_arkode(const RungeKutta& method);
  static int evaluate(sunrealtype time, N_Vector state, N_Vector derivative, void* memory);
  static int set_up_preconditioner(sunrealtype time, N_Vector state, N_Vector derivative,
                                   sunbooleantype is_same_state, sunbooleantype* is_new,
                                   sunrealtype gamma, void* memory);
  static int precondition(sunrealtype time, N_Vector state, N_Vector derivative, N_Vector r,
                          N_Vector z, sunrealtype gamma, sunrealtype delta, int side, void* memory);

  bool advance_step_by_step(double time);

  RightHandSide right_hand_side;
  std::unique_ptr<Preconditioner> preconditioner;
  StepDone step_done;
  double reached = 0.0;        // s, by the last step, if each is told of
  std::vector<double> values;  // where `state` keeps its numbers
  SUNContext context = nullptr;
  N_Vector state = nullptr;
  SUNNonlinearSolver nonlinear = nullptr;
  SUNLinearSolver linear = nullptr;
  bool is_arkode = false;
  bool is_dense = false;
  void* solver = nullptr;
};

int Sundials::Memory::evaluate(sunrealtype time, N_Vector state, N_Vector derivative,
                               void* memory) {
  const auto& self = *static_cast<const Memory*>(memory);
  const bool sound =
      self.right_hand_side(time, N_VGetArrayPointer(state), N_VGetArrayPointer(derivative));
  return sound ? 0 : 1;  // above zero: recoverable
}

int Sundials::Memory::set_up_preconditioner(sunrealtype, N_Vector state, N_Vector, sunbooleantype,
                                            sunbooleantype* is_new, sunrealtype gamma,
                                            void* memory) {
  *is_new = SUNTRUE;
  const auto& self = *static_cast<const Memory*>(memory);
  return self.preconditioner->set_up(N_VGetArrayPointer(state), gamma) ? 0 : 1;
}

int Sundials::Memory::precondition(sunrealtype, N_Vector, N_Vector, N_Vector r, N_Vector z,
                                   sunrealtype, sunrealtype, int, void* memory) {
  const auto& self = *static_cast<const Memory*>(memory);
  self.preconditioner->solve(N_VGetArrayPointer(r), N_VGetArrayPointer(z));
  return 0;
}

void Sundials::Memory::set_up(SundialsMethod method, const SundialsTolerances& tolerances) {
  if (tolerances.absolute.size() != values.size()) {
    throw std::invalid_argument("SUNDIALS needs an absolute tolerance per component");
  }
  context = make_context();
  const auto count = static_cast<sunindextype>(values.size());
  state = require(make_vector(count, values.data(), context), "N_VMake_Serial");
  is_arkode = runge_kutta(method).order > 0;
  if (is_arkode) {
    set_up_arkode(runge_kutta(method));
  } else {
    set_up_cvode(method);
  }
  auto absolute = tolerances.absolute;
  N_Vector vector = require(make_vector(count, absolute.data(), context), "N_VMake_Serial");
  const auto set_tolerances = is_arkode ? set_arkode_tolerances : CVodeSVtolerances;
  const int flag = set_tolerances(solver, tolerances.relative, vector);  // copies them
  N_VDestroy(vector);
  require(flag, "SVtolerances");
}

void Sundials::Memory::set_up_cvode(SundialsMethod method) {
  const bool is_adams = method == SundialsMethod::cvode_adams;
  solver = require(CVodeCreate(is_adams ? CV_ADAMS : CV_BDF, context), "CVodeCreate");
  silence_cvode(solver);
  require(CVodeInit(solver, evaluate, 0.0, state), "CVodeInit");
  require(CVodeSetUserData(solver, this), "CVodeSetUserData");
  require(CVodeSetMaxNumSteps(solver, most_steps), "CVodeSetMaxNumSteps");
  if (is_adams) {
    nonlinear = require(SUNNonlinSol_FixedPoint(state, 0, context), "SUNNonlinSol_FixedPoint");
    require(CVodeSetNonlinearSolver(solver, nonlinear), "CVodeSetNonlinearSolver");
    return;
  }
  const int side = preconditioner ? SUN_PREC_LEFT : SUN_PREC_NONE;
  linear = require(SUNLinSol_SPGMR(state, side, 0, context), "SUNLinSol_SPGMR");
  require(CVodeSetLinearSolver(solver, linear, nullptr), "CVodeSetLinearSolver");
  if (!preconditioner) return;
  require(CVodeSetPreconditioner(solver, set_up_preconditioner, precondition),
          "CVodeSetPreconditioner");
}

void Sundials::Memory::set_up_arkode(const RungeKutta& method) {
  solver = require(ERKStepCreate(evaluate, 0.0, state, context), "ERKStepCreate");
  silence_arkode(solver);
  require(set_arkode_data(solver, this), "SetUserData");
  require(set_arkode_steps(solver, most_steps), "SetMaxNumSteps");
  require(set_arkode_order(solver, method.order), "SetOrder");
  if (method.table != ARKODE_ERK_NONE) {
    require(ERKStepSetTableNum(solver, method.table), "ERKStepSetTableNum");
  }
  is_dense = method.is_dense;
  if (is_dense) require(set_arkode_degree(solver, dense_degree), "SetInterpolantDegree");
}

Sundials::Sundials(SundialsMethod method, RightHandSide right_hand_side, std::vector<double> start,
                   const SundialsTolerances& tolerances,
                   std::unique_ptr<Preconditioner> preconditioner)
    : memory_(std::make_unique<Memory>(std::move(right_hand_side), std::move(start),
                                       std::move(preconditioner))) {
  memory_->set_up(method, tolerances);
}
Sundials::~Sundials() = default;
Sundials::Sundials(Sundials&&) noexcept = default;
Sundials& Sundials::operator=(Sundials&&) noexcept = default;

void Sundials::set_step_done(StepDone step_done) { memory_->step_done = std::move(step_done); }

bool Sundials::Memory::advance_step_by_step(double time) {
  while (reached < time) {
    if (CVode(solver, time, state, &reached, CV_ONE_STEP) < 0) return false;
    step_done(reached, values.data());
  }
  return CVodeGetDky(solver, time, 0, state) >= 0;
}

bool Sundials::advance_to(double time) {
  sunrealtype reached = 0.0;
  Memory& m = *memory_;
  if (m.is_arkode) {
    // Its interpolation is of an order below that of most methods.
    if (!m.is_dense) require(stop_arkode_at(m.solver, time), "SetStopTime");
    return evolve_arkode(m.solver, time, m.state, &reached, ARK_NORMAL) >= 0;
  }
  if (m.step_done) return m.advance_step_by_step(time);
  return CVode(m.solver, time, m.state, &reached, CV_NORMAL) >= 0;
}

const std::vector<double>& Sundials::state() const { return memory_->values; }

long Sundials::evaluations() const {
  long direct = 0, for_solver = 0;
  if (memory_->is_arkode) {
    require(ERKStepGetNumRhsEvals(memory_->solver, &direct), "ERKStepGetNumRhsEvals");
    return direct;
  }
  require(CVodeGetNumRhsEvals(memory_->solver, &direct), "CVodeGetNumRhsEvals");
  if (memory_->linear != nullptr) {
    require(CVodeGetNumLinRhsEvals(memory_->solver, &for_solver), "CVodeGetNumLinRhsEvals");
  }
  return direct + for_solver;
}

}  // namespace pneuma::app
