// The triangles of an object by their numbers in the source mesh, with the vertices that the object stores.
#pragma once

#include <cstdint>
#include <vector>

#include "core/traversal.h"
#include "corners.h"
#include "nkd/object_file.h"

namespace kd::bench {

class ObjectTriangles {
 public:
  /// `object` outlives this. An object whose source numbers are unsound is one that has none.
  explicit ObjectTriangles(const nkd::ObjectFile& object);

  /// The object's own number for it, or kNoTriangle if it was dropped.
  uint32_t index_of(int64_t primitive) const {
    return primitive < static_cast<int64_t>(map_.size()) ? map_[static_cast<size_t>(primitive)] : kNoTriangle;
  }
  /// Of a primitive that was not dropped; model space.
  Corners corners(int64_t primitive) const;

 private:
  const Lattice& lattice_;
  PackedTriangles packed_;
  std::vector<uint32_t> map_;
};

}  // namespace kd::bench
