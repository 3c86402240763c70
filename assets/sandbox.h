// Runs code that cannot be trusted with its input in a process of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace pneuma::assets {

struct ApartLimits {
  std::size_t memory = std::size_t{2} << 30;  // bytes, beyond what the program has already
  std::size_t answer = std::size_t{1} << 28;  // bytes
  int seconds = 60;                           // of the processor
};

/// Calls `work` in a copy of this process and returns the text that it made. Whatever happens there
/// leaves this process as it is: a crash, memory or time without end, an exception. Each becomes a
/// ModelError, the exception with its text. Nothing that `work` writes to standard output or to
/// standard error is seen, and nothing that it changes in memory.
/// Call it while the program has one thread: the copy has only that.
std::string run_in_sandbox(const std::function<std::string()>& work,
                           const ApartLimits& limits = {});

}  // namespace pneuma::assets
