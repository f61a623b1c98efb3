// tinyobjloader as Debian builds it for double precision; the macro must be the same wherever its header is seen.
#pragma once

#ifndef TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_USE_DOUBLE
#endif
#include <tiny_obj_loader.h>
