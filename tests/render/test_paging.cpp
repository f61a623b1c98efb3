// Sections that a render does not use are never read from disk: the page cache tells, after it has forgotten the file.
#include <doctest/doctest.h>

#include <filesystem>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "sys/mapped_file.h"
#include "worlds.h"

using namespace kd;
using namespace kd::test;

namespace {

/// A field of hills of so many squares a side, as a height map.
Shape hills(uint32_t side, uint32_t top) {
  Shape shape;
  const auto at = [&](uint32_t x, uint32_t y) {
    return Vec3u{x * top / side, y * top / side, (x * x + 3 * y * y) % 97 * top / 97};
  };
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      shape.add_triangle(at(x, y), at(x + 1, y), at(x, y + 1));
      shape.add_triangle(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
    }
  }
  return shape;
}

/// An object on a disk, which tests' other files are not.
class ObjectOnDisk {
 public:
  ObjectOnDisk()
      : contents_(hills(70, lattice_max(16)), 16),
        path_(std::string(KD_BINARY_DIR) + "/paging-" + std::to_string(getpid()) + ".nkd") {
    // Random enough not to be found elsewhere in the file.
    Random random(3);
    contents_.normals.clear();
    for (int i = 0; i < 30000; ++i) contents_.normals.push_back(vec_cast<float>(normalised(random.vector(1))));
    for (uint32_t& index : contents_.normal_indices) index = random.integer(0, 29999);
    for (uint32_t& source : contents_.source_primitives) source = random.integer(0, 1u << 30);
    for (uint16_t& material : contents_.material_ids) material = static_cast<uint16_t>(random.integer(0, 1));
    contents_.write(path_);
    bytes_ = read_bytes(path_);
  }
  ~ObjectOnDisk() { std::filesystem::remove(path_); }
  ObjectOnDisk(const ObjectOnDisk&) = delete;
  ObjectOnDisk& operator=(const ObjectOnDisk&) = delete;

  const std::string& path() const { return path_; }
  const Contents& contents() const { return contents_; }

  /// Makes the page cache forget the file; false if it does not.
  bool evict() const {
    const int descriptor = ::open(path_.c_str(), O_RDONLY);
    fsync(descriptor);
    posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
    ::close(descriptor);
    const auto resident = pages();
    return std::count(resident.begin(), resident.end(), 1) == 0;
  }

  struct Pages {
    int64_t all = 0;
    int64_t resident = 0;
  };
  /// Of those that hold nothing but this section.
  template <class T>
  Pages pages_within(const std::vector<T>& section) {
    const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    const auto begin = static_cast<size_t>(bytes_of(bytes_, section) - bytes_.data());
    const size_t first = begin / page + 1, last = (begin + section.size() * sizeof(T)) / page;
    const std::vector<unsigned char> resident = pages();
    REQUIRE(first < last);
    return {static_cast<int64_t>(last - first), std::count(resident.begin() + static_cast<ptrdiff_t>(first),
                                                           resident.begin() + static_cast<ptrdiff_t>(last), 1)};
  }

 private:
  /// 1 for each page that is in memory.
  std::vector<unsigned char> pages() const {
    const int descriptor = ::open(path_.c_str(), O_RDONLY);
    const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    const size_t size = std::filesystem::file_size(path_);
    void* const address = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    REQUIRE(address != MAP_FAILED);
    std::vector<unsigned char> resident((size + page - 1) / page);
    REQUIRE(mincore(address, size, resident.data()) == 0);
    munmap(address, size);
    for (unsigned char& r : resident) r &= 1;
    return resident;
  }

  Contents contents_;
  std::string path_;
  std::string bytes_;
};

/// What is in memory of each section, after the scene was rendered from disk.
struct Residence {
  ObjectOnDisk::Pages vertices, source_primitives, normals, normal_indices, material_ids;

  Residence(ObjectOnDisk& object, const scene::Scene& scene, const render::RenderSettings& settings) {
    const Rendered rendered(scene, settings);
    CHECK((scene.lights.empty() || rendered.frame.stats.shadow_rays > 0));
    const Contents& c = object.contents();
    vertices = object.pages_within(c.vertices);
    source_primitives = object.pages_within(c.source_primitives);
    normals = object.pages_within(c.normals);
    normal_indices = object.pages_within(c.normal_indices);
    material_ids = object.pages_within(c.material_ids);
  }
};

}  // namespace

TEST_CASE("paging: sections that nobody reads stay on disk") {
  ObjectOnDisk object;
  scene::Scene s = scene_of({object.path()}, {part(0, scene::BoxPlacement{})});
  const auto evicted = [&] {
    if (object.evict()) return true;
    MESSAGE("skipped: the file system of " << object.path() << " keeps what it is told to forget");
    return false;
  };

  if (!evicted()) return;
  const Residence bare(object, s, {});
  CHECK(bare.vertices.resident == bare.vertices.all);
  for (const auto& pages : {bare.source_primitives, bare.normals, bare.normal_indices, bare.material_ids}) {
    CHECK(pages.all >= 3);
    CHECK(pages.resident == 0);
  }

  if (!evicted()) return;
  render::RenderSettings settings;
  settings.aovs = {image::Aov::primitive};
  s.ambient = {1, 1, 1};
  const Residence ambient(object, s, settings);
  CHECK(ambient.source_primitives.resident == ambient.source_primitives.all);
  CHECK(ambient.material_ids.resident == ambient.material_ids.all);
  CHECK(ambient.normals.resident == 0);
  CHECK(ambient.normal_indices.resident == 0);

  if (!evicted()) return;
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction = {0, 0, -1};
  s.lights = {sun};
  const Residence lit(object, s, {});
  CHECK(lit.normals.resident == lit.normals.all);
  CHECK(lit.normal_indices.resident == lit.normal_indices.all);
  CHECK(lit.source_primitives.resident == 0);

  // Behind the camera its header is all that is read.
  if (!evicted()) return;
  s.camera.target = {0.5, 0.5, 10};
  s.lights.clear();
  const Residence unseen(object, s, {});
  CHECK(unseen.vertices.resident == 0);
  CHECK(unseen.normals.resident == 0);
}
