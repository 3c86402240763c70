// Threads that share a range of independent pieces of work in a fixed partition, so that what each
// piece computes, and hence the result, does not depend on their number.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace pneuma::sim {

class Workers {
 public:
  /// `threads` >= 1, the calling one among them: 1 starts none.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Calls work(begin, end, thread) once per thread on consecutive blocks of 0..count, none of them
  /// empty, and returns when all are done. `work` must not throw. A single piece is done by the
  /// calling thread: to wake another takes some 50 us.
  void for_blocks(int count, const std::function<void(int begin, int end, int thread)>& work);

 private:
  void help(int thread);
  void run_block(int thread) const;

  std::vector<std::thread> helpers_;
  const std::function<void(int, int, int)>* work_ = nullptr;
  int count_ = 0;
  std::atomic<std::uint32_t> round_ = 0;  // a new value starts the helpers
  std::atomic<int> busy_ = 0;
  bool stopping_ = false;
};

}  // namespace pneuma::sim
