# Debian packages, found once. Each room links only what it uses.
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(Flatbuffers REQUIRED NAMES flatbuffers Flatbuffers FlatBuffers)
set(CMAKE_MESSAGE_LOG_LEVEL ERROR)  # Debian's Imath names a Python library that is in a package of its own, and says so at length
find_package(OpenEXR REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_program(KD_FLATC flatc REQUIRED)

find_path(KD_OPENMESH_INCLUDE OpenMesh/Core/IO/MeshIO.hh REQUIRED)
find_library(KD_OPENMESH_CORE OpenMeshCore REQUIRED)
add_library(kd_openmesh INTERFACE)
target_include_directories(kd_openmesh SYSTEM INTERFACE ${KD_OPENMESH_INCLUDE})
target_link_libraries(kd_openmesh INTERFACE ${KD_OPENMESH_CORE})

# The header alone: what we use of it is compiled into libkd.
find_path(KD_TINYGLTF_INCLUDE tiny_gltf.h REQUIRED)
add_library(kd_tinygltf INTERFACE)
target_include_directories(kd_tinygltf SYSTEM INTERFACE ${KD_TINYGLTF_INCLUDE})
target_link_libraries(kd_tinygltf INTERFACE nlohmann_json::nlohmann_json)

find_path(KD_XXHASH_INCLUDE xxhash.h REQUIRED)
find_library(KD_XXHASH xxhash REQUIRED)
add_library(kd_xxhash INTERFACE)
target_include_directories(kd_xxhash SYSTEM INTERFACE ${KD_XXHASH_INCLUDE})
target_link_libraries(kd_xxhash INTERFACE ${KD_XXHASH})

find_path(KD_STB_INCLUDE stb/stb_image_write.h REQUIRED)
