// tinygltf, compiled by us under a namespace of our own (tinygltf.cpp), without file access, images or stb.
//
// Debian's libdraco exports an older tinygltf of its own, whose structures have another layout; with libtinygltf in the
// same program the linker's order would decide which of the two parses into our structures. Another name ends that.
#pragma once

#include <nlohmann/json.hpp>

#define tinygltf nephroid_tinygltf
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
