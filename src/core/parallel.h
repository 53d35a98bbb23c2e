// Work on several threads.
#pragma once

#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define NEPHROID_SANITIZE_THREAD
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define NEPHROID_SANITIZE_THREAD
#endif
#endif

#ifdef NEPHROID_SANITIZE_THREAD
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#else
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace nephroid {

#ifdef NEPHROID_SANITIZE_THREAD

// The scheduler of TBB is a library that the sanitizer cannot look into: it would report every loop and see nothing of
// what matters. Threads that it does see run the same bodies instead.

namespace detail {
/// Of the loops that this thread starts.
inline thread_local std::size_t thread_count = std::max(std::thread::hardware_concurrency(), 2U);
}  // namespace detail

inline int availableThreads() { return static_cast<int>(detail::thread_count); }

template <class Work>
void runWithThreads(int threads, Work&& work) {
  // Put back however the work ends.
  struct Restore {
    std::size_t before = detail::thread_count;
    ~Restore() { detail::thread_count = before; }
  };
  const Restore restore;
  detail::thread_count = static_cast<std::size_t>(std::max(threads, 1));
  work();
}

template <class Body>
void parallelFor(std::size_t count, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_guard;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        body(i);
      } catch (...) {
        const std::lock_guard lock(failure_guard);
        failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t t = 1; t < detail::thread_count; ++t) threads.emplace_back(run);
  run();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

#else

/// How many threads a loop may use here.
inline int availableThreads() { return tbb::this_task_arena::max_concurrency(); }

/// Calls `work()`; its loops use up to `threads` threads, also more than the machine has.
template <class Work>
void runWithThreads(int threads, Work&& work) {
  const int count = threads > 1 ? threads : 1;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  arena.execute(work);
}

/// Calls `body(i)` for every i in [0, count), from several threads at once, in no order; returns when all are done.
/// What was written before is seen by all bodies, what they write is seen afterwards. An exception of a body ends the
/// loop and is thrown here.
template <class Body>
void parallelFor(std::size_t count, const Body& body) {
  tbb::parallel_for(std::size_t{0}, count, body);
}

#endif

}  // namespace nephroid
