// The code of tinygltf, which its header holds.
#include <fstream>  // its writers, which nothing calls, need it
#include <sstream>

#define TINYGLTF_IMPLEMENTATION
#include "io/gltf/tiny_gltf.h"
