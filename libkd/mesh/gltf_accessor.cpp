#include "mesh/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace kd::mesh {
namespace {

/// 0 for what is no type of glTF's.
uint64_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <class T>
double load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

/// Points `elements` to where a buffer view has them; returns what is wrong, if something is.
std::string place(const GltfFile& file, int view_number, uint64_t offset, int components, GltfElements& elements) {
  const auto& views = file.model.bufferViews;
  if (view_number < 0 || static_cast<size_t>(view_number) >= views.size()) {
    return fmt::format("uses buffer view {}, but there are {}", view_number, views.size());
  }
  const tinygltf::BufferView& view = views[static_cast<size_t>(view_number)];
  if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= file.buffers.size()) {
    return fmt::format("uses buffer {}, but there are {}", view.buffer, file.buffers.size());
  }
  const Bytes buffer = file.buffers[static_cast<size_t>(view.buffer)];
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    return fmt::format("uses buffer view {}, which ends behind its buffer's {} bytes", view_number, buffer.size());
  }
  const uint64_t size = component_size(elements.component_type) * static_cast<uint64_t>(components);
  elements.stride = view.byteStride > 0 ? view.byteStride : size;
  if (elements.stride < size) return fmt::format("has elements of {} bytes, but {} apart", size, elements.stride);
  const bool fits = elements.count == 0 || (offset <= view.byteLength && size <= view.byteLength - offset &&
                                            elements.count - 1 <= (view.byteLength - offset - size) / elements.stride);
  if (!fits) {
    return fmt::format("has {} elements of {} bytes, which end behind buffer view {} of {} bytes", elements.count, size,
                       view_number, view.byteLength);
  }
  elements.first = buffer.data() + view.byteOffset + (elements.count > 0 ? offset : 0);
  return "";
}

/// Whether the numbers of the elements that a sparse accessor replaces ascend and are below `count`.
bool ascends(const GltfElements& replaced, uint64_t count) {
  double last = -1;
  for (uint64_t i = 0; i < replaced.count; ++i) {
    const double number = replaced.component(i, 0);
    if (number <= last || number >= static_cast<double>(count)) return false;
    last = number;
  }
  return true;
}

}  // namespace

double GltfElements::component(uint64_t i, int k) const {
  if (!first) return 0;
  const std::byte* from = first + i * stride + static_cast<uint64_t>(k) * component_size(component_type);
  const auto scaled = [&](double value, double most) { return normalised ? std::max(value / most, -1.0) : value; };
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<int8_t>(from), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(load<uint8_t>(from), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<int16_t>(from), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<uint16_t>(from), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<uint32_t>(from);
    default:
      return load<float>(from);
  }
}

Result<GltfAccessor> GltfAccessor::open(const GltfFile& file, int number, int components, const std::string& path) {
  const auto failed = [&](const std::string& what) {
    return Error{ErrorClass::mesh, path, fmt::format("accessor {} {}; export the mesh again", number, what)};
  };
  const auto& accessors = file.model.accessors;
  if (number < 0 || static_cast<size_t>(number) >= accessors.size()) {
    return failed(fmt::format("is used, but there are {}", accessors.size()));
  }
  const tinygltf::Accessor& source = accessors[static_cast<size_t>(number)];
  if (source.type != (components == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR)) {
    return failed(fmt::format("is not of {}, as its use asks for", components == 3 ? "vectors of three" : "scalars"));
  }
  GltfAccessor accessor;
  GltfElements& elements = accessor.elements_;
  elements.count = source.count;
  elements.component_type = source.componentType;
  elements.normalised = source.normalized;
  if (component_size(elements.component_type) == 0) {
    return failed(fmt::format("is of component type {}, which is none of glTF's", source.componentType));
  }
  if (source.bufferView >= 0) {
    const std::string fault = place(file, source.bufferView, source.byteOffset, components, elements);
    if (!fault.empty()) return failed(fault);
  }
  if (!source.sparse.isSparse) return accessor;

  GltfElements &replaced = accessor.replaced_, &replacements = accessor.replacements_;
  replacements = elements;
  replaced.count = replacements.count = static_cast<uint64_t>(source.sparse.count);
  replaced.component_type = source.sparse.indices.componentType;
  if (component_size(replaced.component_type) == 0) return failed("is sparse with numbers of no type of glTF's");
  const auto& numbers = source.sparse.indices;
  const auto& values = source.sparse.values;
  std::string fault = place(file, numbers.bufferView, static_cast<uint64_t>(numbers.byteOffset), 1, replaced);
  if (fault.empty()) {
    fault = place(file, values.bufferView, static_cast<uint64_t>(values.byteOffset), components, replacements);
  }
  if (!fault.empty()) return failed("is sparse and " + fault);
  if (!ascends(replaced, elements.count)) {
    return failed(fmt::format("is sparse, and the elements that it replaces do not ascend below {}", elements.count));
  }
  return accessor;
}

Result<GltfAccessor> GltfAccessor::vectors(const GltfFile& file, int number, const std::string& path) {
  Result<GltfAccessor> accessor = open(file, number, 3, path);
  if (accessor && accessor->elements_.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    return Error{ErrorClass::mesh, path,
                 fmt::format("accessor {} has vectors of 32-bit integers; export the mesh again", number)};
  }
  return accessor;
}

Result<GltfAccessor> GltfAccessor::indices(const GltfFile& file, int number, const std::string& path) {
  Result<GltfAccessor> accessor = open(file, number, 1, path);
  if (!accessor) return accessor;
  const GltfElements& elements = accessor->elements_;
  const bool is_unsigned = elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!is_unsigned || elements.normalised) {
    return Error{ErrorClass::mesh, path,
                 fmt::format("accessor {} has indices that are no unsigned integers; export the mesh again", number)};
  }
  return accessor;
}

GltfAccessor::Place GltfAccessor::find(uint64_t i) const {
  uint64_t low = 0, high = replaced_.count;
  while (low < high) {
    const uint64_t middle = low + (high - low) / 2;
    if (replaced_.component(middle, 0) < static_cast<double>(i)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low < replaced_.count && replaced_.component(low, 0) == static_cast<double>(i)) return {replacements_, low};
  return {elements_, i};
}

Vec3d GltfAccessor::vector(uint64_t i) const {
  const Place place = find(i);
  return {place.component(0), place.component(1), place.component(2)};
}

}  // namespace kd::mesh
