// Packets against the same rays one by one.
#include <doctest/doctest.h>

#include <cstring>
#include <limits>

#include "core/hierarchy.h"
#include "core/packet_traversal.h"
#include "core/shapes.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr RaySet kAllRays = first_rays(kPacketRays);
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// How many packets were compared, of how many rays, and how many hits.
struct Tally {
  int packets = 0, rays = 0, hits = 0;
};

/// Rays for a packet: aimed each for itself, or beside the first as a camera's are. Some start or end on the way.
PerRay<Ray> random_rays(const Traced& traced, Random& random) {
  const int bits = traced.lattice.bits;
  const double top = lattice_max(bits);
  const PlainRay first = adversarial_ray(traced.shape, bits, random);
  const bool coherent = random.chance(0.6);
  PerRay<Ray> rays;
  for (Ray& ray : rays) {
    PlainRay plain = coherent ? first : adversarial_ray(traced.shape, bits, random);
    if (coherent && random.chance(0.7)) plain.direction = plain.direction + random.vector(length(plain.direction) / 50);
    const double reach = top / std::fmax(length(plain.direction), 1e-30);
    const double t_min = random.chance(0.1) ? random.unit() * reach : 0;
    const double t_max = random.chance(0.1) ? t_min + random.unit() * reach : 1e300;
    ray = {plain.origin, plain.direction, t_min, t_max};
  }
  return rays;
}

/// Takes rays onto the grid together.
RaySet snap(const PerRay<Ray>& rays, int bits, LatticePacket& packet) {
  const BasicRay<PacketDoubles> p = packed(rays, kAllRays);
  return snap_ray(p.origin, p.direction, p.t_min, p.t_max, bits, packet).rays();
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void compare(const Traced& traced, int packets, uint64_t seed, Tally& tally) {
  Random random(seed);
  const ObjectView view = traced.view();
  NoCounter counter;
  for (int n = 0; n < packets; ++n) {
    const PerRay<Ray> rays = random_rays(traced, random);
    PacketQuery query;
    // Sometimes not all take part.
    const RaySet set = snap(rays, view.bits, query.rays) & (random.chance(0.25) ? 0xb5 : kAllRays);
    PerRay<LatticeRay> alone;
    for_each_ray(set, [&](size_t i) {
      REQUIRE(snap_ray(rays[i].origin, rays[i].direction, rays[i].t_min, rays[i].t_max, view.bits, alone[i]));
    });
    alignas(32) PerRay<float> s_limit;
    s_limit.fill(1e30f);
    query.excluded.fill(kNoTriangle);

    const auto compare_closest = [&] {
      query.s_limit = PacketFloats(s_limit);
      PacketAnswer answer;
      traverse<RayMode::closest>(view, query, set, answer);
      for_each_ray(set, [&](size_t i) {
        const uint32_t met = traverse<RayMode::closest>(view, alone[i], s_limit[i], query.excluded[i], counter);
        CHECK(answer.met[i] == met);
        if (met == kNoTriangle) return;
        CHECK(same_bits(answer.hits[i], ExactTest(alone[i]).locate(traced.triangles[met])));
      });
      return answer.met;
    };
    const auto compare_any = [&] {
      PacketAnswer answer;
      traverse<RayMode::any>(view, query, set, answer);
      for_each_ray(set, [&](size_t i) {
        const uint32_t some = traverse<RayMode::any>(view, alone[i], s_limit[i], query.excluded[i], counter);
        CHECK((answer.met[i] == kNoTriangle) == (some == kNoTriangle));
        CHECK((answer.met[i] == kNoTriangle || answer.met[i] != query.excluded[i]));
      });
    };
    const PerRay<uint32_t> first = compare_closest();
    compare_any();
    ++tally.packets;
    for_each_ray(set, [&](size_t i) {
      ++tally.rays;
      tally.hits += first[i] != kNoTriangle;
      // Then without what was met, or only up to there.
      query.excluded[i] = random.chance(0.5) ? first[i] : kNoTriangle;
      s_limit[i] = random.chance(0.5) ? static_cast<float>(random.unit() * lattice_max(view.bits)) : 1e30f;
    });
    compare_closest();
    compare_any();
  }
}

}  // namespace

TEST_CASE("packets: each ray meets what it meets alone") {
  Tally tally;
  for (const int bits : {3, 10, 21, 24}) {
    CAPTURE(bits);
    for (const Soup kind : {Soup::large, Soup::small, Soup::needles, Soup::mixed})
      compare(Traced(soup_shape(bits, 250, kind, 7), bits), 500, 17, tally);
    if (bits == 3) continue;
    compare(Traced(rooms_shape(bits, 3, 1), bits), 1500, 3, tally);
    compare(Traced(stacked_boxes_shape(bits, 3), bits), 1500, 4, tally);
    compare(Traced(sphere_shape(bits, 2), bits), 1500, 5, tally);
    build::BuildSettings deep{{0.01, 1.5, 0.05}, kMaxDepth};
    compare(Traced(rooms_shape(bits, 3, 2), bits, deep), 500, 6, tally);
  }
  CHECK(tally.packets > 20000);
  CHECK(tally.rays > 4 * tally.packets);
  CHECK(tally.hits > tally.rays / 2);
}

TEST_CASE("packets: the compact layout meets the same") {
  const int bits = 21;
  const Traced traced(rooms_shape(bits, 3, 1), bits);
  std::vector<uint32_t> corners;
  for (const auto& t : traced.shape.triangles) corners.insert(corners.end(), {t[0], t[1], t[2]});
  std::vector<VertexWord> vertices(traced.shape.vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) CompactTriangles::pack_narrow(traced.shape.vertices[i], &vertices[i]);
  const ObjectView compact(traced.tree.nodes.data(), traced.tree.references.data(), nullptr, bits,
                           {corners.data(), vertices.data(), true});
  Random random(9);
  for (int n = 0; n < 1000; ++n) {
    PacketQuery query;
    const RaySet set = snap(random_rays(traced, random), bits, query.rays);
    query.s_limit = query.rays.s_max;
    query.excluded.fill(kNoTriangle);
    PacketAnswer answer, expected;
    traverse<RayMode::closest, ExactTest, TriangleLayout::compact>(compact, query, set, answer);
    traverse<RayMode::closest>(traced.view(), query, set, expected);
    for_each_ray(set, [&](size_t i) { CHECK(answer.met[i] == expected.met[i]); });
  }
}

TEST_CASE("packets: a ray is snapped as it is alone") {
  for (const int bits : {1, 10, 21, 24}) {
    CAPTURE(bits);
    const Traced traced(soup_shape(bits, 20, Soup::mixed, 7), bits);
    Random random(11);
    int entering = 0, missing = 0;
    for (int n = 0; n < 4000; ++n) {
      PerRay<Ray> rays = random_rays(traced, random);
      for (Ray& ray : rays) {
        if (random.chance(0.3)) ray.origin = random.vector(std::exp2(random.real(-30, 60)));
        if (random.chance(0.1)) ray.direction = ray.direction * std::exp2(random.real(-1000, 900));
        if (random.chance(0.1)) ray.direction.set(static_cast<int>(random.integer(0, 2)), 0);
        if (random.chance(0.02)) ray.direction = {0, -0.0, 0};
        if (random.chance(0.02)) ray.origin.x = std::numeric_limits<double>::quiet_NaN();
        if (random.chance(0.02)) ray.direction.y = std::numeric_limits<double>::infinity();
        if (random.chance(0.02)) ray.t_max = ray.t_min - 1;
      }
      LatticePacket packet;
      const RaySet set = snap(rays, bits, packet);
      for (size_t i = 0; i < kPacketRays; ++i) {
        LatticeRay alone;
        const bool enters = snap_ray(rays[i].origin, rays[i].direction, rays[i].t_min, rays[i].t_max, bits, alone);
        CHECK(((set & set_of(i)) != kNoRays) == enters);
        ++(enters ? entering : missing);
        if (!enters) continue;
        const LatticeRay together = ray_of(packet, i);
        CHECK(same_bits(together.origin, alone.origin));
        CHECK(same_bits(together.direction, alone.direction));
        CHECK(same_bits(together.inverse, alone.inverse));
        CHECK(together.axis == alone.axis);
        CHECK(same_bits(together.s_min, alone.s_min));
        CHECK(same_bits(together.s_max, alone.s_max));
        CHECK(same_bits(together.s_exit, alone.s_exit));
        CHECK(same_bits(together.t_base, alone.t_base));
        CHECK(same_bits(together.t_scale, alone.t_scale));
      }
    }
    CHECK(entering > 4000);
    CHECK(missing > 4000);
  }
}

TEST_CASE("packets: the way through boxes is computed as a ray's is") {
  Random random(12);
  for (int n = 0; n < 20000; ++n) {
    PerRay<Ray> rays;
    for (Ray& ray : rays) {
      ray = {random.vector(std::exp2(random.real(-20, 20))), random.vector(1), random.chance(0.5) ? 0 : random.unit(),
             1e300};
      if (random.chance(0.2)) ray.direction.set(static_cast<int>(random.integer(0, 2)), 0);
      ray.direction = {std::fabs(ray.direction.x), -std::fabs(ray.direction.y), std::fabs(ray.direction.z)};
      if (ray.direction.y == 0) ray.direction.y = -1;
    }
    const Vec3f lo = vec_cast<float>(random.vector(8)), size = vec_cast<float>(random.vector(4));
    const HierarchyNode node{lo, 0, {lo.x + std::fabs(size.x), lo.y + std::fabs(size.y), lo.z + std::fabs(size.z)}, 1};
    auto together = slabs_of(packed(rays, kAllRays), node);
    together.rising_x = together.rising_z = true;
    together.rising_y = false;
    const Passage<PacketFloats> passage = together.pass(node, 100.0f);
    for (size_t i = 0; i < kPacketRays; ++i) {
      const Passage<float> alone = box_test(rays[i], node).pass(node, 100.0f);
      CHECK(same_bits(passage.enter[i], alone.enter));
      CHECK(same_bits(passage.leave[i], alone.leave));
      CHECK((passage.passes().rays() >> i & 1) == alone.passes());
    }
  }
}

TEST_CASE("packets: numbers are computed as a float's are") {
  Random random(4);
  const std::array<float, 8> special{0, -0.0f, 1, -1, kFloatInfinity, -kFloatInfinity, 0x1p-140f, 3e38f};
  const auto any_float = [&] {
    return random.chance(0.3) ? special[random.integer(0, 7)]
                              : static_cast<float>(random.vector(1).x * std::exp2(random.vector(60).x));
  };
  const auto same = [](float x, float y) { return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y); };
  for (int n = 0; n < 20000; ++n) {
    alignas(32) PerRay<float> a, b, c;
    for (size_t i = 0; i < kPacketRays; ++i) {
      a[i] = any_float();
      b[i] = any_float();
      c[i] = any_float();
    }
    const PacketFloats x(a), y(b), z(c);
    for (size_t i = 0; i < kPacketRays; ++i) {
      const auto of = [i](PacketFloats p) { return p.lanes[i]; };
      const auto holds = [i](PacketTruths p) { return (p.rays() >> i & 1) != 0; };
      const float fused = std::fma(a[i], b[i], c[i]);
      CHECK((same(of(fma(x, y, z)), fused) || std::isnan(fused)));
      CHECK(same(of(least_of(x, y)), least_of(a[i], b[i])));
      CHECK(same(of(largest_of(x, y, z)), largest_of(a[i], b[i], c[i])));
      CHECK(same(of(fabs(x)), std::fabs(a[i])));
      CHECK(same(of(a[0]), a[0]));
      const double wide = static_cast<double>(a[i]) * (1 + 0x1p-30);
      CHECK((same(of(rounded_up(PacketDoubles(x) * (1 + 0x1p-30))), rounded_up(wide)) || std::isnan(wide)));
      CHECK(holds(signs_differ(x, y, z)) == signs_differ(a[i], b[i], c[i]));
      CHECK(holds(x < y) == (a[i] < b[i]));
      CHECK(holds((y <= z) & !(x > y)) == (!(a[i] > b[i]) && b[i] <= c[i]));
      CHECK(holds(x >= y) == (a[i] >= b[i]));
    }
  }
  for (RaySet set = 0; set <= kAllRays; ++set) CHECK(PacketTruths::in(set).rays() == set);
}
