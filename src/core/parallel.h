// Loops over all threads of the current arena.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define NEPHROID_SANITIZE_THREAD
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define NEPHROID_SANITIZE_THREAD
#endif
#endif

#ifdef NEPHROID_SANITIZE_THREAD
#include <atomic>
#endif

namespace nephroid {

/// Calls `body(i)` for every i in [0, count), from several threads at once, in no order; returns when all are done.
/// What was written before is seen by all bodies, what they write is seen afterwards.
///
/// An exception of a body ends the loop and is thrown here.
template <class Body>
void parallelFor(std::size_t count, const Body& body) {
#ifdef NEPHROID_SANITIZE_THREAD
  // The scheduler orders bodies after what precedes the loop and before what follows it, but in a library that the
  // sanitizer cannot look into. These two say so; races between bodies are still seen.
  std::atomic<bool> begun{false};
  std::atomic<std::size_t> done{0};
  begun.store(true, std::memory_order_release);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    static_cast<void>(begun.load(std::memory_order_acquire));
    body(i);
    done.fetch_add(1, std::memory_order_release);
  });
  static_cast<void>(done.load(std::memory_order_acquire));
#else
  tbb::parallel_for(std::size_t{0}, count, body);
#endif
}

}  // namespace nephroid
