# Runs the passes over a SPIR-V module and writes its words as an array, a constant of its own for every file that
# includes it.
execute_process(
  COMMAND ${OPTIMIZER} --target-env=vulkan1.3 --scalar-block-layout ${PASSES} ${PLAIN} -o ${MODULE}
  RESULT_VARIABLE result
  OUTPUT_VARIABLE messages
  ERROR_VARIABLE messages)
# Else it only tells which functions stay functions.
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${OPTIMIZER} ended with ${result}: ${messages}")
endif()
file(READ ${MODULE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${bytes}")
file(
  WRITE ${HEADER}
  "#pragma once\n\n#include <cstdint>\n\nnamespace nephroid::shaders {\ninline constexpr std::uint32_t ${ARRAY}[] = {\n${words}};\n}  // namespace nephroid::shaders\n"
)
