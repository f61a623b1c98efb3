// glTF files changed at random: a mesh or an error, and nothing else.
#include <doctest/doctest.h>

#include <cstdlib>
#include <iterator>

#include "gltf_texts.h"
#include "mesh/asset.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;
using namespace kd::test;

namespace {

/// A generator that gives the same numbers everywhere.
struct Mutator {
  uint64_t state;
  uint64_t next(uint64_t below) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return (state >> 33) % below;
  }
  std::string mutated(std::string bytes) {
    static const std::string words[] = {"0",  "-1",   "4294967295", "1e308", "null", "[", "]", "{", "}",
                                        "\"", "5125", "[0]",        "{}",    "VEC3", ",", ":", "9", "2147483648"};
    for (uint64_t edits = 1 + next(4); edits-- > 0 && !bytes.empty();) {
      const size_t at = next(bytes.size());
      switch (next(5)) {
        case 0:
          bytes[at] = static_cast<char>(next(256));
          break;
        case 1:
          bytes.erase(at, 1 + next(8));
          break;
        case 2:
          bytes.insert(at, words[next(std::size(words))]);
          break;
        case 3: {  // a number for another
          const size_t digit = bytes.find_first_of("0123456789", at);
          if (digit != std::string::npos) bytes[digit] = static_cast<char>('0' + next(10));
          break;
        }
        default:
          bytes.insert(at, bytes.substr(next(bytes.size()), next(40)));
      }
    }
    return bytes;
  }
};

}  // namespace

TEST_CASE("gltf: mutated files give a mesh or an error") {
  // KD_FUZZ in the environment: how many, instead of what a test run has time for.
  const char* wanted = std::getenv("KD_FUZZ");
  const int rounds = wanted ? std::atoi(wanted) : 4000;
  const std::string nodes = R"("nodes": [{"mesh": 0, "children": [1]}, {"camera": 0, "scale": [1, 2, 3]},
{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}], "scenes": [{"nodes": [0, 2]}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}], "materials": [{"name": "m"}],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "color": [1, 0.5, 0], "intensity": 8}]}})";
  const auto full = [&](const std::string& buffer) {
    return replaced(square_json(buffer), R"("nodes": [{"mesh": 0}])", nodes);
  };
  const std::string seeds[] = {full(fmt::format(R"(, "uri": "{}")", data_uri(square_bytes()))),
                               glb(full(""), square_bytes())};
  const TempFolder folder;
  int meshes = 0, errors = 0;
  for (int i = 0; i < rounds; ++i) {
    Mutator mutator{static_cast<uint64_t>(i)};
    const bool binary = i % 2;
    const std::string path = folder.write(binary ? "a.glb" : "a.gltf", mutator.mutated(seeds[binary]));
    const auto asset = read_asset(path, {}, Split::none);
    if (!asset) {
      ++errors;
      const bool is_plain = asset.error().line().find('\n') == std::string::npos;
      if (!is_plain) FAIL(asset.error().line());
      continue;
    }
    ++meshes;
    for (const NamedMesh& m : asset->meshes) {
      for (const auto& t : m.mesh.triangles) {
        for (const uint32_t v : t) {
          if (v >= m.mesh.positions.size()) FAIL("a vertex that is not there");
        }
      }
    }
    for (const MeshInstance& instance : asset->instances) {
      if (instance.mesh >= asset->meshes.size()) FAIL("a mesh that is not there");
    }
  }
  CHECK(meshes > rounds / 50);
  CHECK(errors > rounds / 50);
}
