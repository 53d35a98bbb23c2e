# Warnings, sanitizers and code generation, as an interface target that our own targets use and nothing exports.
add_library(nephroid_options INTERFACE)
target_compile_features(nephroid_options INTERFACE cxx_std_20)
target_compile_options(
  nephroid_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers
            # Contraction would let the compiler fuse differently per call site: results must not depend on inlining.
            -ffp-contract=off
            $<$<BOOL:${NEPHROID_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  # Once std::string comes from a precompiled header, GCC forgets that it is the system's and warns of its insides.
  target_compile_options(nephroid_options INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
                                                    -Wno-stringop-overread)
endif()
if(NEPHROID_ASSERTIONS)
  target_compile_definitions(nephroid_options INTERFACE NEPHROID_ASSERTIONS)
endif()
if(NEPHROID_SANITIZE)
  # -O1: at -O2 the instrumented build takes three times as long, for tests that are not much faster. GCC sees values that
  # may not be set where its own instrumentation put branches, in <regex> for one.
  target_compile_options(nephroid_options INTERFACE -O1 -g1 -fsanitize=${NEPHROID_SANITIZE} -fno-omit-frame-pointer
                                                    -fno-sanitize-recover=all -Wno-maybe-uninitialized)
  target_link_options(nephroid_options INTERFACE -fsanitize=${NEPHROID_SANITIZE})
endif()
if(NEPHROID_BUILD_FUZZ)
  # The library has to count its branches too, or the fuzzer mutates blindly; only fuzz targets get libFuzzer's main().
  target_compile_options(nephroid_options INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(nephroid_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
