// Threads that share a range of independent pieces of work in a fixed partition, so that what each
// piece computes, and hence the result, does not depend on their number.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace pneuma::base {

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
  /// calling thread, because waking another takes longer. Allocates nothing.
  template <class Work>
  void for_blocks(int count, const Work& work) {
    run({&work, [](const void* known, int begin, int end,
                   int thread) { (*static_cast<const Work*>(known))(begin, end, thread); }},
        count);
  }

 private:
  /// Refers to a callable of any type.
  struct AnyWork {
    const void* work = nullptr;
    void (*call)(const void* work, int begin, int end, int thread) = nullptr;
  };

  void run(const AnyWork& work, int count);
  void help(int thread);
  void run_block(int thread) const;

  std::vector<std::thread> helpers_;
  AnyWork work_;
  int count_ = 0;
  std::atomic<std::uint32_t> round_ = 0;  // a new value starts the helpers
  std::atomic<int> busy_ = 0;
  bool stopping_ = false;
};

}  // namespace pneuma::base
