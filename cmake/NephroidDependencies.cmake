# Everything that Nephroid stands on, all from Debian; see docs/architecture.md for what each is for.
# Under add_subdirectory the project above links them too, and would not see targets of this folder only.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED)
endif()
find_package(TBB REQUIRED)
find_package(glm REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(assimp REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(WebP REQUIRED IMPORTED_TARGET GLOBAL libwebp)
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
if(NEPHROID_VULKAN)
  # Headers only: the loader is opened at run time.
  find_path(VULKAN_INCLUDE_DIR vulkan/vulkan.h REQUIRED)
endif()

add_library(nephroid_dependencies INTERFACE)
target_link_libraries(
  nephroid_dependencies
  INTERFACE embree TBB::tbb glm::glm OpenEXR::OpenEXR ZLIB::ZLIB PNG::PNG JPEG::JPEG assimp::assimp draco::draco
            meshoptimizer::meshoptimizer nlohmann_json::nlohmann_json fmt::fmt PkgConfig::WebP ${CMAKE_DL_LIBS})
# As system headers: their warnings are not ours. Only for building: an installed library needs its dependencies to link.
target_include_directories(nephroid_dependencies SYSTEM INTERFACE $<BUILD_INTERFACE:${STB_INCLUDE_DIR}>)
target_compile_definitions(nephroid_dependencies
                           INTERFACE $<BUILD_INTERFACE:NEPHROID_EMBREE_MAJOR=${EMBREE_VERSION_MAJOR}>)
