// The one translation unit that holds tinygltf's code.
#include <fstream>  // tinygltf leaves it out together with file access, but writes through it

#define TINYGLTF_IMPLEMENTATION
#include "scene/import/tinygltf.h"
