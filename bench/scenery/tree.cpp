#include "scenery/tree.h"

#include <cmath>
#include <span>

#include "scenery/directions.h"

namespace kd::bench::scenery {

namespace {

/// Trunks reach into the ground, which may fall away from where a tree stands.
constexpr double kRoot = 0.8;

struct Ring {
  Vec3d centre;
  Vec3d along;  // the way the branch goes there
  double radius = 0;
};

/// Cosine and sine of a turn's n-th part, n from 3 to 8.
constexpr double kTurns[][2] = {{-0.5, 0.8660254037844386},
                                {0, 1},
                                {0.30901699437494745, 0.9510565162951535},
                                {0.5, 0.8660254037844386},
                                {0.6234898018587336, 0.7818314824680298},
                                {0.7071067811865476, 0.7071067811865475}};

/// A tube through the rings, open at its ends, with round normals.
void add_tube(ObjMesh& mesh, Stuff stuff, std::span<const Ring> rings, int sides) {
  const auto [cosine, sine] = kTurns[sides - 3];
  Vec3d start = std::fabs(rings[0].along.y) < 0.9 ? kUp : Vec3d{1, 0, 0};
  std::vector<Corner> last, next(static_cast<size_t>(sides));
  for (const Ring& ring : rings) {
    const Vec3d axis = normalised(ring.along);
    start = normalised(start - axis * dot(start, axis));
    Vec3d x = start;
    for (Corner& corner : next) {
      corner = {mesh.vertex(ring.centre + x * ring.radius), mesh.normal(x)};
      x = x * cosine + cross(axis, x) * sine;
    }
    for (size_t i = 0; i < last.size(); ++i) {
      const size_t j = (i + 1) % last.size();
      mesh.quad(stuff, last[i], last[j], next[j], next[i]);
    }
    last = next;
  }
}

/// How a branch of each level is drawn: the trunk, branches, forks, twigs.
struct LevelShape {
  int segments;
  int sides;
  double wiggle;
};
constexpr LevelShape kLevels[] = {{9, 8, 0.07}, {5, 5, 0.16}, {4, 4, 0.22}, {2, 3, 0.25}};
constexpr int kTwig = 3;

class Grower {
 public:
  Grower(const Species& species, uint64_t seed, ObjMesh& mesh)
      : species_(species), random_(seed, 0), mesh_(mesh), crown_{0, 0.5 * (1 + species.bare) * species.height, 0} {}

  void grow(Vec3d foot, Vec3d direction, double length, double radius, int level) {
    const LevelShape& shape = kLevels[level];
    std::vector<Ring> rings{{foot, direction, radius}};
    for (int i = 1; i <= shape.segments; ++i) {
      const double s = static_cast<double>(i) / shape.segments;
      direction = normalised(direction + any_direction(random_) * shape.wiggle + kUp * (0.12 * species_.rise));
      const double thickness = level == 0 ? (1 - s) * (1 - 0.25 * s) + 0.04 : 1 - 0.75 * s;
      rings.push_back({rings.back().centre + direction * (length / shape.segments), direction, radius * thickness});
    }
    add_tube(mesh_, species_.bark, rings, shape.sides);
    if (level == kTwig) return add_leaves(rings);
    add_children(rings, length, level);
  }

 private:
  void add_children(std::span<const Ring> rings, double length, int level) {
    const int counts[] = {species_.branches, species_.forks, species_.twigs};
    const double first = level == 0 ? species_.bare : 0.2;
    for (int i = 0; i < counts[level]; ++i) {
      const double up = (i + random_.unit()) / counts[level];  // along the part that has branches
      const double s = (first + (1 - first) * up) * static_cast<double>(rings.size() - 1) * 0.999;
      const auto segment = static_cast<size_t>(s);
      const Ring &below = rings[segment], &above = rings[segment + 1];
      const double t = s - static_cast<double>(segment);
      const Vec3d foot = below.centre + (above.centre - below.centre) * t;
      const Vec3d out = any_across(below.along, random_);
      const double lean = level == 0 ? 0.15 + 0.9 * up : 0.7;
      const Vec3d direction = normalised(out + below.along * lean + kUp * (0.35 * species_.rise));
      const double share = level == 0
                               ? (0.35 + 2.6 * up * (1 - up)) * (1 - 0.35 * up) * species_.reach * species_.height
                               : (level == 1 ? 0.5 : 0.45) * length * (1.15 - 0.6 * up);
      const double thickness = below.radius + (above.radius - below.radius) * t;
      grow(foot, direction, share * random_.real(0.8, 1.2), thickness * (level == 0 ? 0.5 : 0.6), level + 1);
    }
  }

  void add_leaves(std::span<const Ring> rings) {
    const Vec3d from = rings.front().centre, way = rings.back().centre - from;
    for (int i = 0; i < species_.leaves; ++i) {
      const Vec3d base = from + way * random_.real(0.1, 1.05);
      const Vec3d along = normalised(normalised(way) * 0.6 + any_direction(random_) - kUp * 0.25);
      const Vec3d across = any_across(along, random_);
      Vec3d n = cross(along, across);
      const Vec3d outward = normalised(base - crown_);
      if (dot(n, outward) < 0) n = -n;
      const double size = random_.real(0.7, 1.2);
      const auto shade = static_cast<Stuff>(static_cast<uint32_t>(species_.foliage) + random_.below(kShades));
      mesh_.leaf(shade, base, along * (species_.leaf_length * size), across * (0.5 * species_.leaf_width * size),
                 n + outward * 0.9);
    }
  }

  const Species& species_;
  Random random_;
  ObjMesh& mesh_;
  Vec3d crown_;  // its middle: leaves are shaded as if they faced away from it, so that a crown looks round
};

class SpruceGrower {
 public:
  SpruceGrower(double height, uint64_t seed, ObjMesh& mesh) : height_(height), random_(seed, 0), mesh_(mesh) {}

  void grow() {
    const double radius = height_ / 60;
    const Ring trunk[] = {{{0, -kRoot, 0}, kUp, radius * 1.15},
                          {{0, 0.3 * height_, 0}, kUp, radius * 0.75},
                          {{0, 0.7 * height_, 0}, kUp, radius * 0.35},
                          {{0, height_, 0}, kUp, radius * 0.04}};
    add_tube(mesh_, Stuff::bark, trunk, 7);
    const int whorls = static_cast<int>(height_ * 1.7);
    for (int whorl = 0; whorl < whorls; ++whorl) {
      const double up = (whorl + random_.unit()) / whorls;
      for (int branch = 0; branch < 7; ++branch) add_branch(up);
    }
    for (int i = 0; i < 12; ++i) {
      const Vec3d out = any_across(kUp, random_);
      add_spray({0, height_ * random_.real(0.96, 1.0), 0}, out * 0.15 + kUp * 0.35, 0.04);
    }
  }

 private:
  /// One of a whorl at `up` of the crown, from 0 to 1.
  void add_branch(double up) {
    const Vec3d foot{0, height_ * (0.06 + 0.93 * up), 0};
    const Vec3d out = any_across(kUp, random_), side = cross(out, kUp);
    const double length = (0.18 * height_ * (1 - up) + 0.25) * random_.real(0.75, 1.1);
    const double droop = 0.75 - 0.85 * up;  // low branches hang, high ones climb
    const auto at = [&](double s) { return foot + out * (length * s) - kUp * (length * droop * s * (1 - 0.45 * s)); };
    const Ring rings[] = {
        {at(0), out, height_ / 600 + 0.01 * length}, {at(0.5), out, 0.008 * length}, {at(1), out, 0.002}};
    add_tube(mesh_, Stuff::bark, rings, 3);
    const int steps = static_cast<int>(length / 0.2) + 2;
    for (int step = 0; step < steps; ++step) {
      const double s = (step + 0.5) / steps;
      const double twig = length * 0.34 * (1.15 - s) + 0.12;
      for (const double hand : {-1.0, 1.0}) {
        const double hang = random_.real(0.1, 0.5), size = random_.real(0.8, 1.2);
        const Vec3d along = normalised(side * hand + out * 0.8 - kUp * hang) * (twig * size);
        add_spray(at(s), along, 0.045 + 0.13 * twig);
        add_spray(at(s) + along * 0.3, normalised(along - kUp * (0.7 * twig)) * (0.7 * twig), 0.04 + 0.1 * twig);
      }
    }
    add_spray(at(0.9), out * (0.25 * length + 0.1) + kUp * 0.03, 0.06);
  }

  void add_spray(Vec3d base, Vec3d along, double width) {
    const Vec3d flat = normalised(cross(along, kUp + any_direction(random_) * 0.4));
    const Vec3d outward = normalised(Vec3d{base.x, 0.035 * height_, base.z});
    const auto shade = static_cast<Stuff>(static_cast<uint32_t>(Stuff::spruce) + random_.below(kShades));
    mesh_.leaf(shade, base, along, flat * width, cross(flat, normalised(along)) * 0.6 + outward);
  }

  double height_;
  Random random_;
  ObjMesh& mesh_;
};

}  // namespace

ObjMesh grow_tree(const Species& species, uint64_t seed) {
  ObjMesh mesh;
  Grower grower(species, seed, mesh);
  grower.grow({0, -kRoot, 0}, kUp, species.height + kRoot, species.radius, 0);
  return mesh;
}

ObjMesh grow_shrub(const Species& species, int stems, uint64_t seed) {
  ObjMesh mesh;
  Grower grower(species, seed, mesh);
  Random random(seed, 1);
  for (int i = 0; i < stems; ++i) {
    const double lean = random.real(0.2, 0.9);
    const Vec3d side = any_across(kUp, random);
    grower.grow({0, -0.1, 0}, normalised(kUp + side * lean), species.height * random.real(0.7, 1.1), species.radius, 1);
  }
  return mesh;
}

ObjMesh grow_spruce(double height, uint64_t seed) {
  ObjMesh mesh;
  SpruceGrower(height, seed, mesh).grow();
  return mesh;
}

}  // namespace kd::bench::scenery
