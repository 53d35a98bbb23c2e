// Assertions for our own mistakes: they print both expressions and both values, then abort.
//
// On in debug builds, in tests and in fuzzing (NEPHROID_ASSERTIONS); off in release, where the check costs nothing.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace nephroid::detail {

template <class A, class B>
[[noreturn]] void failComparison(const char* file, int line, const char* text, const A& a, const B& b) {
  std::ostringstream values;
  values << a << " and " << b;
  std::fprintf(stderr, "%s:%d: assertion failed: %s, with values %s\n", file, line, text, values.str().c_str());
  std::abort();
}

}  // namespace nephroid::detail

#ifdef NEPHROID_ASSERTIONS
#define NEPHROID_ASSERT_COMPARE_(a, op, b)                                                                 \
  do {                                                                                                     \
    const auto& nephroid_a_ = (a);                                                                         \
    const auto& nephroid_b_ = (b);                                                                         \
    if (!(nephroid_a_ op nephroid_b_))                                                                     \
      ::nephroid::detail::failComparison(__FILE__, __LINE__, #a " " #op " " #b, nephroid_a_, nephroid_b_); \
  } while (false)
#else
#define NEPHROID_ASSERT_COMPARE_(a, op, b) static_cast<void>(0)
#endif

#define NEPHROID_ASSERT_LT(a, b) NEPHROID_ASSERT_COMPARE_(a, <, b)
#define NEPHROID_ASSERT_LE(a, b) NEPHROID_ASSERT_COMPARE_(a, <=, b)
#define NEPHROID_ASSERT_GT(a, b) NEPHROID_ASSERT_COMPARE_(a, >, b)
#define NEPHROID_ASSERT_GE(a, b) NEPHROID_ASSERT_COMPARE_(a, >=, b)
#define NEPHROID_ASSERT_EQ(a, b) NEPHROID_ASSERT_COMPARE_(a, ==, b)
