// A processor without the instructions that the program was compiled for would end it with "illegal
// instruction" and no word of why.
#include <unistd.h>

#include "app/host/exit_code.h"

namespace {

#ifdef __AVX2__

/// Before the constructors of all static objects (priorities up to 100 are the compiler's own),
/// because they are compiled for the same processor.
__attribute__((constructor(101))) void check_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2")) {
    return;
  }
  constexpr char message[] =
      "pneuma: this processor has no AVX2, FMA or BMI2, for which the program was compiled; build "
      "it "
      "with -DPNEUMA_ARCH=x86-64\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, sizeof message - 1);
  _exit(static_cast<int>(pneuma::app::ExitCode::check_failed));
}

#endif

}  // namespace
