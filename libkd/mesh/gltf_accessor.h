// glTF accessors: elements of a buffer, every one of them checked to be there before the first is read.
#pragma once

#include <cstdint>
#include <string>

#include "core/vec.h"
#include "mesh/gltf_file.h"

namespace kd::mesh {

/// Elements of one type at equal distances. No alignment is asked for.
struct GltfElements {
  const std::byte* first = nullptr;  // null: all are zero, and nothing bounds `count`
  uint64_t stride = 0;               // bytes
  uint64_t count = 0;
  int component_type = 0;
  bool normalised = false;  // integers stand for [0, 1] or [-1, 1]

  /// Component `k` of element `i`.
  double component(uint64_t i, int k) const;
};

class GltfAccessor {
 public:
  /// Accessor `number` as vectors of three: floats, or integers of 8 or 16 bits.
  static Result<GltfAccessor> vectors(const GltfFile& file, int number, const std::string& path);
  /// As indices: unsigned integers.
  static Result<GltfAccessor> indices(const GltfFile& file, int number, const std::string& path);

  uint64_t count() const { return elements_.count; }
  Vec3d vector(uint64_t i) const;
  uint32_t index(uint64_t i) const { return static_cast<uint32_t>(find(i).component(0)); }

 private:
  /// Where element `i` is: among the elements or among those that replace some of them.
  struct Place {
    const GltfElements& elements;
    uint64_t i;
    double component(int k) const { return elements.component(i, k); }
  };
  Place find(uint64_t i) const;
  static Result<GltfAccessor> open(const GltfFile& file, int number, int components, const std::string& path);

  GltfElements elements_;
  GltfElements replaced_;      // sparse: numbers of elements, ascending
  GltfElements replacements_;  // sparse: what is there instead, as many
};

}  // namespace kd::mesh
