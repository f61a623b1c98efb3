// kdbench surface: a terrain of so many triangles as a binary PLY, written as it is made, so that its size is bounded
// by the disk alone.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "surface.h"
#include "sys/atomic_file.h"
#include "sys/parallel.h"

namespace kd::bench {

namespace {

struct Options {
  uint64_t triangles = 0;
  std::string output;
};

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

constexpr size_t kVertexBytes = 3 * sizeof(float);
constexpr size_t kFaceBytes = 1 + 3 * sizeof(int32_t);
constexpr uint64_t kChunk = 1 << 18;  // elements made and written at once
constexpr size_t kGrain = 1 << 12;

std::string ply_header(const Surface& surface) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment kdbench surface --triangles {0}\nelement vertex {1}\n"
      "property float x\nproperty float y\nproperty float z\nelement face {0}\n"
      "property list uchar int vertex_indices\nend_header\n",
      surface.triangle_count(), surface.vertex_count());
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Error write_error(const std::string& path) { return {ErrorClass::output, path, "cannot write: is the disk full?"}; }

/// Writes elements 0 to count, of `size` bytes each, that make(i, bytes) lays down from many threads.
template <class Make>
Result<void> write_elements(std::FILE* file, uint64_t count, size_t size, const std::string& path, const Make& make) {
  std::vector<char> bytes;
  for (uint64_t first = 0; first < count; first += kChunk) {
    if (tools::interrupted()) return Error{ErrorClass::interrupted, path, "interrupted"};
    const auto elements = static_cast<size_t>(std::min(kChunk, count - first));
    bytes.resize(elements * size);
    parallel_ranges(elements, kGrain, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) make(first + i, bytes.data() + i * size);
    });
    if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size()) return write_error(path);
  }
  return {};
}

Result<void> write_surface(const Surface& surface, const std::string& path) {
  auto claimed = AtomicFile::create(path);
  if (!claimed) return claimed.error();
  File file(std::fopen(claimed->temporary_path().c_str(), "wb"));
  if (!file) return write_error(path);
  const std::string header = ply_header(surface);
  if (std::fwrite(header.data(), 1, header.size(), file.get()) != header.size()) return write_error(path);
  const auto vertices =
      write_elements(file.get(), surface.vertex_count(), kVertexBytes, path, [&](uint64_t i, char* bytes) {
        const Vec3f v = surface.vertex(i);
        const float values[] = {v.x, v.y, v.z};
        std::memcpy(bytes, values, sizeof values);
      });
  if (!vertices) return vertices;
  const auto faces =
      write_elements(file.get(), surface.triangle_count(), kFaceBytes, path, [&](uint64_t i, char* bytes) {
        const Surface::Corners t = surface.triangle(i);
        const int32_t corners[] = {t.a, t.b, t.c};
        *bytes = 3;
        std::memcpy(bytes + 1, corners, sizeof corners);
      });
  if (!faces) return faces;
  if (std::fclose(file.release()) != 0) return write_error(path);
  return claimed->commit();
}

Result<void> make(const Options& o) {
  tools::catch_interrupts();
  const Surface surface(o.triangles);
  if (auto written = write_surface(surface, o.output); !written) return written;
  fmt::print("{}: {} triangles, {} vertices\n", o.output, surface.triangle_count(), surface.vertex_count());
  return {};
}

}  // namespace

Command surface_command(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* c = app.add_subcommand("surface", "Make a mesh of any size: a rugged terrain, as binary PLY");
  c->add_option("--triangles", o->triangles, "How many, exactly")
      ->required()
      ->check(tools::whole_number(2, 1'000'000'000));
  c->add_option("-o,--output", o->output, "The .ply to write")->required()->check(tools::file_name());
  return {c, [o] {
            const auto done = make(*o);
            return done ? 0 : tools::fail(kKdbench, done.error());
          }};
}

}  // namespace kd::bench
