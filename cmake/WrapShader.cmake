# Puts the array that glslang wrote into a namespace, as a constant of its own for every file that includes it.
file(READ ${WORDS} text)
string(REGEX REPLACE "#pragma once\n" "" text "${text}")
string(REGEX REPLACE "const uint32_t " "inline constexpr std::uint32_t " text "${text}")
file(WRITE ${HEADER} "#pragma once\n\n#include <cstdint>\n\nnamespace nephroid::shaders {\n${text}\n}  // namespace nephroid::shaders\n")
