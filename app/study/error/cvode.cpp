#include "app/study/error/cvode.h"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace pneuma::app {
namespace {

/// From one sample to the next. More than any motion here takes; where the state loses its meaning
/// CVODE would creep towards that moment for ever.
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

// Debian 12 has SUNDIALS 6, Debian 13 has 7: they name "no MPI" differently, and say differently
// that what fails is reported by us alone.
#if SUNDIALS_VERSION_MAJOR >= 7

SUNContext make_context() {
  SUNContext context = nullptr;
  require(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
  require(SUNContext_ClearErrHandlers(context), "SUNContext_ClearErrHandlers");
  return context;
}

void silence(void* /*solver*/) {}  // its errors go to the handlers of its context

#else

SUNContext make_context() {
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
  return context;
}

void silence(void* solver) { require(CVodeSetErrFile(solver, nullptr), "CVodeSetErrFile"); }

#endif

}  // namespace

std::string_view to_string(CvodeMethod method) {
  return method == CvodeMethod::adams ? "cvode_adams" : "cvode_bdf";
}

std::string sundials_version() {
  std::array<char, 32> text = {};
  require(SUNDIALSGetVersion(text.data(), static_cast<int>(text.size())), "SUNDIALSGetVersion");
  return text.data();
}

struct Cvode::Memory {
  Memory(RightHandSide given, std::vector<double> start)
      : right_hand_side(std::move(given)), values(std::move(start)) {}
  ~Memory() {
    CVodeFree(&solver);
    if (linear != nullptr) SUNLinSolFree(linear);
    if (nonlinear != nullptr) SUNNonlinSolFree(nonlinear);
    if (state != nullptr) N_VDestroy(state);
    if (context != nullptr) SUNContext_Free(&context);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  void set_up(CvodeMethod method, const CvodeTolerances& tolerances);
  void set_up_solver(CvodeMethod method);
  static int evaluate(sunrealtype time, N_Vector state, N_Vector derivative, void* memory);

  RightHandSide right_hand_side;
  std::vector<double> values;  // where `state` keeps its numbers
  SUNContext context = nullptr;
  N_Vector state = nullptr;
  SUNNonlinearSolver nonlinear = nullptr;
  SUNLinearSolver linear = nullptr;
  void* solver = nullptr;
};

int Cvode::Memory::evaluate(sunrealtype, N_Vector state, N_Vector derivative, void* memory) {
  const auto& self = *static_cast<const Memory*>(memory);
  const bool sound =
      self.right_hand_side(N_VGetArrayPointer(state), N_VGetArrayPointer(derivative));
  return sound ? 0 : 1;  // above zero: recoverable
}

void Cvode::Memory::set_up(CvodeMethod method, const CvodeTolerances& tolerances) {
  context = make_context();
  const auto count = static_cast<sunindextype>(values.size());
  state = require(N_VMake_Serial(count, values.data(), context), "N_VMake_Serial");
  const int kind = method == CvodeMethod::adams ? CV_ADAMS : CV_BDF;
  solver = require(CVodeCreate(kind, context), "CVodeCreate");
  silence(solver);
  require(CVodeInit(solver, evaluate, 0.0, state), "CVodeInit");
  require(CVodeSetUserData(solver, this), "CVodeSetUserData");
  require(CVodeSetMaxNumSteps(solver, most_steps), "CVodeSetMaxNumSteps");

  if (tolerances.absolute.size() != values.size()) {
    throw std::invalid_argument("CVODE needs an absolute tolerance per component");
  }
  auto absolute = tolerances.absolute;
  N_Vector vector = require(N_VMake_Serial(count, absolute.data(), context), "N_VMake_Serial");
  const int flag = CVodeSVtolerances(solver, tolerances.relative, vector);  // copies them
  N_VDestroy(vector);
  require(flag, "CVodeSVtolerances");
  set_up_solver(method);
}

void Cvode::Memory::set_up_solver(CvodeMethod method) {
  if (method == CvodeMethod::adams) {
    nonlinear = require(SUNNonlinSol_FixedPoint(state, 0, context), "SUNNonlinSol_FixedPoint");
    require(CVodeSetNonlinearSolver(solver, nonlinear), "CVodeSetNonlinearSolver");
    return;
  }
  linear = require(SUNLinSol_SPGMR(state, SUN_PREC_NONE, 0, context), "SUNLinSol_SPGMR");
  require(CVodeSetLinearSolver(solver, linear, nullptr), "CVodeSetLinearSolver");
}

Cvode::Cvode(CvodeMethod method, RightHandSide right_hand_side, std::vector<double> start,
             const CvodeTolerances& tolerances)
    : memory_(std::make_unique<Memory>(std::move(right_hand_side), std::move(start))) {
  memory_->set_up(method, tolerances);
}
Cvode::~Cvode() = default;
Cvode::Cvode(Cvode&&) noexcept = default;
Cvode& Cvode::operator=(Cvode&&) noexcept = default;

bool Cvode::advance_to(double time) {
  sunrealtype reached = 0.0;
  return CVode(memory_->solver, time, memory_->state, &reached, CV_NORMAL) >= 0;
}

const std::vector<double>& Cvode::state() const { return memory_->values; }

long Cvode::evaluations() const {
  long direct = 0, for_solver = 0;
  require(CVodeGetNumRhsEvals(memory_->solver, &direct), "CVodeGetNumRhsEvals");
  if (memory_->linear != nullptr) {
    require(CVodeGetNumLinRhsEvals(memory_->solver, &for_solver), "CVodeGetNumLinRhsEvals");
  }
  return direct + for_solver;
}

}  // namespace pneuma::app
