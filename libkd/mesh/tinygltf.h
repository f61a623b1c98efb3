// tinygltf as it is used here: it turns JSON into structs, and reads neither files nor images. Its functions are
// compiled in gltf_file.cpp, rather than taken from Debian's library, which does both.
#pragma once

#include <fstream>  // its writer needs it, and does not include it under TINYGLTF_NO_FS

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>
