#include "tests/support/count_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

// Under a sanitizer operator new is the sanitizer's, which does not link beside another (thread),
// or whose checks another would take away (address): there its own hooks count.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PNEUMA_COUNT_BY_SANITIZER
#include <sanitizer/allocator_interface.h>
#endif
#endif

namespace {
std::atomic<long> allocations = 0;
}  // namespace

extern "C" void* __real_malloc(std::size_t size);

#ifdef PNEUMA_COUNT_BY_SANITIZER

namespace {
void count_allocation(const volatile void*, std::size_t) { ++allocations; }
void ignore_release(const volatile void*) {}
const int hooks = __sanitizer_install_malloc_and_free_hooks(count_allocation, ignore_release);
}  // namespace

extern "C" void* __wrap_malloc(std::size_t size) { return __real_malloc(size); }

#else

extern "C" void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = __real_malloc(size)) return memory;
  throw std::bad_alloc();
}
// Of what is aligned more than malloc does, such as vectors of Vec4d.
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto to = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(to, (size + to - 1) / to * to)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#endif

namespace pneuma {
long allocation_count() { return allocations; }
}  // namespace pneuma
