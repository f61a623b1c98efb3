// Files cut off anywhere and files with any byte changed: opening says no, or what it gives can be traversed.
#include <doctest/doctest.h>

#include "object_bytes.h"

using namespace kd;
using namespace kd::test;

namespace {

/// Touches all that a render would: expands every triangle and traverses rays from several sides.
void use(const nkd::ObjectFile& file) {
  const nkd::Geometry& g = file.geometry();
  const int bits = file.summary().lattice.bits;
  std::vector<TriangleVertices> triangles(g.triangle_count());
  for (size_t i = 0; i < triangles.size(); ++i) {
    g.packed().expand(i, triangles[i]);
  }
  const ObjectView view{g.nodes.data(), g.references.data(), triangles.data(), bits};
  Random random(1);
  const double top = lattice_max(bits);
  for (int i = 0; i < 6; ++i) {
    LatticeRay ray;
    const Vec3d target = vec_cast<double>(random.point(lattice_max(bits))), d = random.vector(1);
    if (!snap_ray(target - d * (4 * top), d, 0, 1e300, bits, ray)) continue;
    NoCounter counter;
    const uint32_t hit = traverse<RayMode::closest>(view, ray, 1e30f, kNoTriangle, counter);
    CHECK((hit == kNoTriangle || hit < triangles.size()));
  }
  if (const auto normals = file.normals()) {
    for (uint32_t n : normals->indices) REQUIRE((n == 0xffffffffu || n < normals->values.size()));
  }
  if (const auto materials = file.materials()) {
    for (uint16_t m : materials->ids) REQUIRE(m < materials->values.size());
  }
  if (const auto sources = file.source_primitives()) REQUIRE((sources->empty() || sources->size() == triangles.size()));
}

}  // namespace

TEST_CASE("nkd: cut off at any length") {
  const TempFolder folder;
  const Contents c(soup_shape(12, 12, Soup::mixed, 2), 12);
  const std::string good = read_bytes(c.write(folder.file("a.nkd")));
  for (size_t length = 0; length < good.size(); ++length) {
    const auto file = nkd::ObjectFile::open(folder.write("b.nkd", good.substr(0, length)));
    // What follows the last attribute section is padding, and nothing that is read.
    if (file) {
      CAPTURE(length);
      CHECK(length + 16 > good.size());
      CHECK(file->check_attributes().empty());
      continue;
    }
    REQUIRE(file.error().error_class == ErrorClass::object);
    REQUIRE(file.error().what.substr(0, 3) == "NKD");
  }
}

TEST_CASE("nkd: larger than a FlatBuffer can be") {
  const TempFolder folder;
  const Contents c(soup_shape(12, 12, Soup::mixed, 2), 12);
  const std::string path = c.write(folder.file("a.nkd"));
  std::filesystem::resize_file(path, uint64_t{1} << 31);  // a hole behind the object
  const auto file = nkd::ObjectFile::open(path);
  if (file) CHECK(file->check_attributes().empty());
}

TEST_CASE("nkd: any byte changed") {
  const TempFolder folder;
  for (const auto& [bits, floats] : {std::pair{12, false}, std::pair{24, false}, std::pair{24, true}}) {
    Contents c(soup_shape(bits, 12, Soup::mixed, 2), bits);
    if (floats) c.store_floats(1);
    const std::string good = read_bytes(c.write(folder.file("a.nkd")));
    Random random(static_cast<uint64_t>(bits + floats));
    int opened = 0;
    for (int i = 0; i < 10000; ++i) {
      std::string bad = good;
      // The header, where the offsets are, as often as all the rest.
      const auto last = static_cast<uint32_t>(good.size() - 1);
      const size_t at = random.integer(0, random.chance(0.5) ? 700 : last);
      bad[at] = static_cast<char>(random.chance(0.5) ? bad[at] ^ (1 << random.integer(0, 7))
                                                     : static_cast<int>(random.integer(0, 255)));
      const auto file = nkd::ObjectFile::open(folder.write("b.nkd", bad));
      if (!file) continue;
      ++opened;
      use(*file);
      nkd::validate(*file);
    }
    CHECK(opened > 100);
  }
}

TEST_CASE("nkd: changed contents behind checksums that match") {
  // What a forger can do: any number of words of the sections changed, and the file written anew.
  const TempFolder folder;
  Random random(3);
  const Shape shape = soup_shape(12, 30, Soup::mixed, 2);
  const Contents good(shape, 12);
  int opened = 0;
  for (int i = 0; i < 400; ++i) {
    Contents c = good;
    const auto spoil = [&](auto& word) {
      using Word = std::decay_t<decltype(word)>;
      const uint32_t bit = 1u << random.integer(0, 8 * sizeof(Word) - 1);
      word = static_cast<Word>(random.chance(0.5) ? word ^ bit : random.integer(0, 64));
    };
    const auto pick = [&](auto& v) -> auto& { return v[random.integer(0, static_cast<uint32_t>(v.size() - 1))]; };
    for (uint32_t n = random.integer(1, 3); n > 0; --n) {
      switch (random.integer(0, 4)) {
        case 0:
          spoil(pick(c.nodes).word);
          break;
        case 1:
          spoil(pick(c.nodes).link);
          break;
        case 2:
          spoil(pick(c.references));
          break;
        case 3:
          spoil(pick(c.triangles));
          break;
        default:
          spoil(pick(c.vertices));
      }
    }
    const auto file = nkd::ObjectFile::open(c.write(folder.file("b.nkd")));
    if (!file) continue;
    ++opened;
    use(*file);
    nkd::validate(*file);
  }
  CHECK(opened > 20);
}
