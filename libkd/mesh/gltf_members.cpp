// The members of glTF's objects that are read, as tables, and the check that values are of the kinds these say. What
// glTF calls an integer is written without a fraction or an exponent (glTF 2.0, 2.7 "JSON Encoding").
#include <limits>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mesh/gltf_json.h"

namespace kd::mesh {
namespace {

using Json = nlohmann::json;

constexpr uint64_t kMostIndex = std::numeric_limits<int32_t>::max();
constexpr uint64_t kMostBytes = uint64_t{1} << 53;

enum class Kind : uint8_t { text, number, boolean, index, bytes, object };

constexpr int kOne = 0;    // not an array
constexpr int kMany = -1;  // an array of any length

struct Member {
  std::string_view name;  // "*": any
  Kind kind = Kind::text;
  int count = kOne;  // or kMany, or the length of an array
  std::span<const Member> members = {};
};

using enum Kind;

constexpr Member kSparseIndices[] = {{"bufferView", index}, {"byteOffset", index}, {"componentType", index}};
constexpr Member kSparseValues[] = {{"bufferView", index}, {"byteOffset", index}};
// tinygltf keeps the count and the offsets of sparse accessors in 32 bits.
constexpr Member kSparse[] = {
    {"count", index}, {"indices", object, kOne, kSparseIndices}, {"values", object, kOne, kSparseValues}};
constexpr Member kAccessor[] = {{"bufferView", index}, {"byteOffset", bytes},   {"componentType", index},
                                {"count", bytes},      {"normalized", boolean}, {"sparse", object, kOne, kSparse},
                                {"type", text}};
constexpr Member kBufferView[] = {
    {"buffer", index}, {"byteLength", bytes}, {"byteOffset", bytes}, {"byteStride", bytes}};
constexpr Member kBuffer[] = {{"byteLength", bytes}, {"uri", text}};

constexpr Member kAttributes[] = {{"*", index}};
constexpr Member kPrimitiveExtensions[] = {{"KHR_draco_mesh_compression", object}};
constexpr Member kPrimitive[] = {{"attributes", object, kOne, kAttributes},
                                 {"extensions", object, kOne, kPrimitiveExtensions},
                                 {"indices", index},
                                 {"material", index},
                                 {"mode", index},
                                 {"targets", object, kMany, kAttributes}};
constexpr Member kMesh[] = {{"name", text}, {"primitives", object, kMany, kPrimitive}};

constexpr Member kPbr[] = {{"baseColorFactor", number, 4}, {"metallicFactor", number}, {"roughnessFactor", number}};
constexpr Member kTexture[] = {{"index", index}};
constexpr Member kEmissiveStrength[] = {{"emissiveStrength", number}};
constexpr Member kMaterialExtensions[] = {{"KHR_materials_emissive_strength", object, kOne, kEmissiveStrength}};
constexpr Member kMaterial[] = {{"emissiveFactor", number, 3},
                                {"emissiveTexture", object, kOne, kTexture},
                                {"extensions", object, kOne, kMaterialExtensions},
                                {"name", text},
                                {"pbrMetallicRoughness", object, kOne, kPbr}};

constexpr Member kPerspective[] = {{"aspectRatio", number}, {"yfov", number}, {"zfar", number}, {"znear", number}};
constexpr Member kOrthographic[] = {{"xmag", number}, {"ymag", number}, {"zfar", number}, {"znear", number}};
constexpr Member kCamera[] = {
    {"orthographic", object, kOne, kOrthographic}, {"perspective", object, kOne, kPerspective}, {"type", text}};

constexpr Member kSpot[] = {{"innerConeAngle", number}, {"outerConeAngle", number}};
constexpr Member kLight[] = {
    {"color", number, 3}, {"intensity", number}, {"spot", object, kOne, kSpot}, {"type", text}};
constexpr Member kLights[] = {{"lights", object, kMany, kLight}};
constexpr Member kExtensions[] = {{"KHR_lights_punctual", object, kOne, kLights}};

constexpr Member kNodeLight[] = {{"light", index}};
constexpr Member kNodeExtensions[] = {{"KHR_lights_punctual", object, kOne, kNodeLight}};
constexpr Member kNode[] = {{"camera", index},
                            {"children", index, kMany},
                            {"extensions", object, kOne, kNodeExtensions},
                            {"matrix", number, 16},
                            {"mesh", index},
                            {"name", text},
                            {"rotation", number, 4},
                            {"scale", number, 3},
                            {"translation", number, 3}};
constexpr Member kScene[] = {{"nodes", index, kMany}};

constexpr Member kAsset[] = {{"version", text}};
constexpr Member kRoot[] = {{"accessors", object, kMany, kAccessor},
                            {"asset", object, kOne, kAsset},
                            {"bufferViews", object, kMany, kBufferView},
                            {"buffers", object, kMany, kBuffer},
                            {"cameras", object, kMany, kCamera},
                            {"extensions", object, kOne, kExtensions},
                            {"extensionsRequired", text, kMany},
                            {"materials", object, kMany, kMaterial},
                            {"meshes", object, kMany, kMesh},
                            {"nodes", object, kMany, kNode},
                            {"scene", index},
                            {"scenes", object, kMany, kScene}};

const Member* find(std::span<const Member> members, std::string_view name) {
  for (const Member& member : members) {
    if (member.name == name || member.name == "*") return &member;
  }
  return nullptr;
}

bool is_of(const Json& value, Kind kind) {
  switch (kind) {
    case text:
      return value.is_string();
    case number:
      return value.is_number();
    case boolean:
      return value.is_boolean();
    case index:
      return value.is_number_unsigned() && value.get<uint64_t>() <= kMostIndex;
    case bytes:
      return value.is_number_unsigned() && value.get<uint64_t>() <= kMostBytes;
    case object:
      return value.is_object();
  }
  return false;
}

std::string name_of(Kind kind) {
  switch (kind) {
    case text:
      return "a string";
    case number:
      return "a number";
    case boolean:
      return "true or false";
    case index:
      return fmt::format("a whole number from 0 to {}", kMostIndex);
    case bytes:
      return fmt::format("a whole number from 0 to {}", kMostBytes);
    case object:
      return "an object";
  }
  return "";
}

/// A member's name in a JSON pointer.
std::string escaped(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c == '~') out += "~0";
    if (c == '/') out += "~1";
    if (c != '~' && c != '/') out += c;
  }
  return out;
}

/// Goes through the values that tables name, no deeper than these, and drops the others. Ends at the first fault.
class Keeper {
 public:
  std::string fault;

  void keep(Json& object, std::span<const Member> members) {
    for (auto entry = object.begin(); entry != object.end() && fault.empty();) {
      const Member* member = find(members, entry.key());
      if (!member) {
        entry = object.erase(entry);
        continue;
      }
      const size_t length = at_.size();
      at_ += '/' + escaped(entry.key());
      check(*entry, *member);
      at_.resize(length);
      ++entry;
    }
  }

 private:
  void check(Json& value, const Member& member) {
    if (member.count == kOne) return check_one(value, member);
    if (!value.is_array()) return refuse("an array");
    if (member.count != kMany && value.size() != static_cast<size_t>(member.count)) {
      return refuse(fmt::format("an array of {} numbers", member.count));
    }
    const size_t length = at_.size();
    for (size_t i = 0; i < value.size() && fault.empty(); ++i) {
      at_ += fmt::format("/{}", i);
      check_one(value[i], member);
      at_.resize(length);
    }
  }

  void check_one(Json& value, const Member& member) {
    if (!is_of(value, member.kind)) return refuse(name_of(member.kind));
    if (member.kind == object) keep(value, member.members);
  }

  void refuse(const std::string& wanted) { fault = fmt::format("'{}' must be {}", at_, wanted); }

  std::string at_;  // the JSON pointer of what is looked at
};

}  // namespace

std::string keep_what_is_read(Json& root) {
  Keeper keeper;
  keeper.keep(root, kRoot);
  return keeper.fault;
}

}  // namespace kd::mesh
