# Shaders are compiled when the library is built and embedded in it: nothing is looked for at run time.
find_program(NEPHROID_GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_program(NEPHROID_SPIRV_OPT spirv-opt REQUIRED)

# Functions inlined and variables turned into values, once for all who make pipelines of a shader: on a CPU device that
# is most of the work of making one. What a driver does next depends on constants that are known to it alone. Functions
# with several ends are left as they are: merged into one end (--merge-return) they cost drivers more than calls do.
set(NEPHROID_SPIRV_PASSES
    --inline-entry-points-exhaustive
    --eliminate-dead-functions
    --private-to-local
    --eliminate-local-single-block
    --eliminate-local-single-store
    --eliminate-dead-code-aggressive
    --scalar-replacement=100
    --ssa-rewrite
    --eliminate-dead-code-aggressive)

# nephroid_embed_shaders(TARGET shaders…): NAME.STAGE.glsl becomes <shaders/FOLDER/NAME.STAGE.h>, FOLDER relative to
# src/ (or to the project), with an array of words NAME_STAGE in namespace nephroid::shaders.
function(nephroid_embed_shaders target)
  foreach(shader ${ARGN})
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/${shader})
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
    string(REGEX REPLACE "^src/" "" folder ${folder})
    get_filename_component(name ${shader} NAME)
    string(REGEX REPLACE "\\.glsl$" "" name ${name})
    string(REPLACE "." "_" array ${name})
    string(REGEX REPLACE "^.*\\.([a-z]+)$" "\\1" stage ${name})
    set(plain ${PROJECT_BINARY_DIR}/generated/shaders/${folder}/${name}.plain.spv)
    set(module ${PROJECT_BINARY_DIR}/generated/shaders/${folder}/${name}.spv)
    set(header ${PROJECT_BINARY_DIR}/generated/shaders/${folder}/${name}.h)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/generated/shaders/${folder})
    add_custom_command(
      OUTPUT ${plain}
      COMMAND ${NEPHROID_GLSLANG_VALIDATOR} --quiet --target-env vulkan1.3 -S ${stage} -I${PROJECT_SOURCE_DIR}/src
              --depfile ${plain}.d -o ${plain} ${source}
      DEPENDS ${source}
      DEPFILE ${plain}.d
      COMMENT "Compiling ${folder}/${shader}"
      VERBATIM)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${CMAKE_COMMAND} -DPLAIN=${plain} -DMODULE=${module} -DHEADER=${header} -DARRAY=${array}
              -DOPTIMIZER=${NEPHROID_SPIRV_OPT} "-DPASSES=${NEPHROID_SPIRV_PASSES}" -P
              ${PROJECT_SOURCE_DIR}/cmake/WrapShader.cmake
      DEPENDS ${plain} ${PROJECT_SOURCE_DIR}/cmake/WrapShader.cmake
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  # The target may belong to another folder, where these commands are not known: a target of their own is.
  string(REPLACE "/" "_" shaders ${target}_shaders_${folder})
  add_custom_target(${shaders} DEPENDS ${headers})
  add_dependencies(${target} ${shaders})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated)
endfunction()
