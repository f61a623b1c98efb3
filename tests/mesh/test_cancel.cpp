// Reading that is cancelled: in time, with one error, from wherever the reader is.
#include <doctest/doctest.h>

#include <ctime>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "gltf_texts.h"
#include "mesh/asset.h"
#include "mesh/dependencies.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::mesh;
using namespace kd::test;

namespace {

/// Seconds of processor time of this thread: a busy machine does not count.
double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seconds of work between two questions: 0.1 on a core of its own; sanitizers, and neighbours on the core, take
/// longer.
#if defined(__SANITIZE_ADDRESS__)
constexpr double kLongest = 0.4;
#else
constexpr double kLongest = 0.2;
#endif

/// A rugged sheet of 2 side^2 triangles, in every format. Its file's name.
class Sheet {
 public:
  Sheet(const TempFolder& folder, size_t side) : folder_(folder), side_(side) {
    for (size_t y = 0; y <= side; ++y) {
      for (size_t x = 0; x <= side; ++x) {
        const auto u = static_cast<float>(x), v = static_cast<float>(y);
        points_.push_back({u, v, std::round(1000 * std::sin(u * v)) / 1000});
      }
    }
    for (uint32_t y = 0; y < side; ++y) {
      for (uint32_t x = 0; x < side; ++x) {
        const auto row = static_cast<uint32_t>(side) + 1, a = y * row + x;
        triangles_.push_back({a, a + 1, a + row + 1});
        triangles_.push_back({a, a + row + 1, a + row});
      }
    }
  }

  std::string write(const std::string& name) const {
    const std::string kind = std::filesystem::path(name).extension().string();
    if (kind == ".obj") return folder_.write(name, "mtllib none.mtl\n" + lines("v ", "f ", 1));
    if (kind == ".off")
      return folder_.write(name, fmt::format("OFF\n{} {} 0\n", points_.size(), triangles_.size()) + lines("", "3 ", 0));
    if (kind == ".stl") return folder_.write(name, stl());
    if (kind == ".glb") return folder_.write(name, glb(gltf(""), arrays()));
    if (kind == ".gltf") return folder_.write(name, gltf(fmt::format(R"(, "uri": "{}")", data_uri(arrays()))));
    const bool text = name.starts_with("text");
    std::string ply = fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty {} x\nproperty float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        text ? "ascii" : "binary_little_endian", points_.size(), text ? "double" : "float", triangles_.size());
    return folder_.write(name, ply + (text ? lines("", "3 ", 0) : binary_elements()));
  }

 private:
  std::string lines(const char* point, const char* face, uint32_t first) const {
    std::string text;
    for (const auto& p : points_) text += fmt::format("{}{} {} {}\n", point, p[0], p[1], p[2]);
    for (const auto& t : triangles_)
      text += fmt::format("{}{} {} {}\n", face, t[0] + first, t[1] + first, t[2] + first);
    return text;
  }
  template <class T>
  static void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string arrays() const {
    std::string bytes;
    for (const auto& p : points_) append(bytes, p);
    for (const auto& t : triangles_) append(bytes, t);
    return bytes;
  }
  std::string binary_elements() const {
    std::string bytes;
    for (const auto& p : points_) append(bytes, p);
    for (const auto& t : triangles_) {
      bytes += '\3';
      append(bytes, t);
    }
    return bytes;
  }
  std::string stl() const {
    std::string bytes(80, ' ');
    append(bytes, static_cast<uint32_t>(triangles_.size()));
    for (const auto& t : triangles_) {
      bytes.append(12, '\0');
      for (const uint32_t v : t) append(bytes, points_[v]);
      bytes.append(2, '\0');
    }
    return bytes;
  }
  std::string gltf(const std::string& buffer) const {
    const size_t points = 12 * points_.size(), corners = 12 * triangles_.size();
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}{}}}],
"bufferViews": [{{"buffer": 0, "byteLength": {}}}, {{"buffer": 0, "byteOffset": {}, "byteLength": {}}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3"}},
 {{"bufferView": 1, "componentType": 5125, "count": {}, "type": "SCALAR"}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}]}})",
        points + corners, buffer, points, points, corners, points_.size(), 3 * triangles_.size());
  }

  const TempFolder& folder_;
  size_t side_;
  std::vector<std::array<float, 3>> points_;
  std::vector<std::array<uint32_t, 3>> triangles_;
};

constexpr const char* kNames[] = {"a.obj", "a.ply", "text.ply", "a.stl", "a.off", "a.glb", "a.gltf"};

}  // namespace

TEST_CASE("reading asks every 100 ms at most whether to go on, in every format") {
  const TempFolder folder;
  const Sheet sheet(folder, 700);  // about a million triangles
  for (const char* name : kNames) {
    CAPTURE(name);
    const std::string path = sheet.write(name);
    double last = cpu_seconds(), longest = 0;
    const double start = last;
    const auto ask = [&](double share) {
      CHECK(share == 0);
      longest = std::max(longest, cpu_seconds() - last);
      last = cpu_seconds();
      return true;
    };
    const auto asset = read_asset(path, {false, ask}, Split::none);
    REQUIRE(asset);
    longest = std::max(longest, cpu_seconds() - last);
    CHECK(asset->meshes[0].mesh.triangles.size() == 980'000);
    CHECK_MESSAGE(longest < kLongest, std::string(name) << ": " << longest << " of " << cpu_seconds() - start << " s");
    std::filesystem::remove(path);
  }
}

TEST_CASE("reading ends where it is told to, with the class of an interruption") {
  const TempFolder folder;
  const Sheet sheet(folder, 400);
  int interrupted = 0;  // a fast machine reads the binary formats before it first asks
  for (const char* name : kNames) {
    CAPTURE(name);
    const std::string path = sheet.write(name);
    for (const int last : {1, 2, 4}) {
      int asked = 0;
      const auto asset = read_asset(path, {false, [&](double) { return ++asked < last; }}, Split::none);
      CHECK(asked <= last);
      if (asked < last) continue;  // all was read by then
      REQUIRE_FALSE(asset);
      ++interrupted;
      CHECK(asset.error().error_class == ErrorClass::interrupted);
      CHECK(asset.error().line().find(path) == 0);
    }
  }
  CHECK(interrupted > 0);
}

TEST_CASE("looking for dependencies can be cancelled") {
  std::string text;
  for (int i = 0; i < 3'000'000; ++i) text += "v 1 2 3 4 5 6 7\n";
  const auto files = dependencies(std::as_bytes(std::span(text)), "a.obj", [](double) { return false; });
  REQUIRE_FALSE(files);
  CHECK(files.error().error_class == ErrorClass::interrupted);
}
