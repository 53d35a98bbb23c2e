# Shaders are compiled when the library is built and embedded in it: nothing is looked for at run time.
find_program(NEPHROID_GLSLANG_VALIDATOR glslangValidator REQUIRED)

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
    set(words ${PROJECT_BINARY_DIR}/generated/shaders/${folder}/${name}.words)
    set(header ${PROJECT_BINARY_DIR}/generated/shaders/${folder}/${name}.h)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/generated/shaders/${folder})
    add_custom_command(
      OUTPUT ${words}
      COMMAND ${NEPHROID_GLSLANG_VALIDATOR} --quiet --target-env vulkan1.3 -S ${stage} -I${PROJECT_SOURCE_DIR}/src
              --depfile ${words}.d --vn ${array} -o ${words} ${source}
      DEPENDS ${source}
      DEPFILE ${words}.d
      COMMENT "Compiling ${folder}/${shader}"
      VERBATIM)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${CMAKE_COMMAND} -DWORDS=${words} -DHEADER=${header} -P ${PROJECT_SOURCE_DIR}/cmake/WrapShader.cmake
      DEPENDS ${words} ${PROJECT_SOURCE_DIR}/cmake/WrapShader.cmake
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  # The target may belong to another folder, where these commands are not known: a target of their own is.
  string(REPLACE "/" "_" shaders ${target}_shaders_${folder})
  add_custom_target(${shaders} DEPENDS ${headers})
  add_dependencies(${target} ${shaders})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated)
endfunction()
