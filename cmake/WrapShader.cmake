# Writes the words of a SPIR-V module as an array, a constant of its own for every file that includes it.
file(READ ${MODULE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${bytes}")
file(
  WRITE ${HEADER}
  "#pragma once\n\n#include <cstdint>\n\nnamespace nephroid::shaders {\ninline constexpr std::uint32_t ${ARRAY}[] = {\n${words}};\n}  // namespace nephroid::shaders\n"
)
