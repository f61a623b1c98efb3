#include "scenery/building.h"

#include <algorithm>
#include <cmath>

#include "scenery/boxes.h"
#include "scenery/directions.h"

namespace kd::bench::scenery {

namespace {

constexpr double kReveal = 0.22;  // how deep windows lie in their walls
constexpr double kFrame = 0.07;   // how wide their frames are
constexpr double kBar = 0.04;     // and half as wide the bars between panes
constexpr double kLedge = 0.16;   // how far ledges stand out

class Mason {
 public:
  Mason(const Style& style, uint64_t seed) : style_(style), random_(seed, 0) {}

  void raise(const std::vector<Tier>& tiers) {
    double y = 0;
    for (size_t i = 0; i < tiers.size(); ++i) {
      const double top = add_walls(tiers[i], y, i == 0);
      const bool last = i + 1 == tiers.size();
      if (last && style_.roof == Roof::gabled) {
        add_gabled_roof(tiers[i], top);
      } else {
        add_flat_roof(tiers[i], top, last);
      }
      y = top;
    }
  }

  ObjMesh mesh;

 private:
  struct Opening {
    double a0, a1, y0, y1;
  };

  static WallFrame centre(double y) { return {{0, y, 0}}; }

  /// A tier's walls, from `y` up; returns where they end.
  double add_walls(const Tier& tier, double y, bool on_ground) {
    const WallFrame walls[] = {{{-tier.width / 2, y, tier.depth / 2}, {1, 0, 0}, {0, 0, 1}},
                               {{tier.width / 2, y, tier.depth / 2}, {0, 0, -1}, {1, 0, 0}},
                               {{tier.width / 2, y, -tier.depth / 2}, {-1, 0, 0}, {0, 0, -1}},
                               {{-tier.width / 2, y, -tier.depth / 2}, {0, 0, 1}, {-1, 0, 0}}};
    double height = 0;
    for (int storey = 0; storey < tier.storeys; ++storey) {
      const bool shops = on_ground && storey == 0;
      const double next = height + style_.storey * (shops ? 1.5 : 1);
      for (int side = 0; side < 4; ++side) {
        const double length = side % 2 == 0 ? tier.width : tier.depth;
        add_storey(walls[side], length, height, next, shops);
      }
      height = next;
    }
    return y + height;
  }

  void add_storey(const WallFrame& wall, double length, double y0, double y1, bool shops) {
    const int bays = std::max(1, static_cast<int>(length / style_.bay));
    const double bay = length / bays;
    const int door = shops ? static_cast<int>(random_.below(static_cast<uint32_t>(bays))) : -1;
    for (int i = 0; i < bays; ++i) {
      const double a0 = i * bay, a1 = (i + 1) * bay;
      if (shops) {
        add_shop(wall, a0, a1, y0, y1, i == door);
      } else {
        add_window_bay(wall, a0, a1, y0, y1);
        if (style_.balcony_every > 0 && i % style_.balcony_every == style_.balcony_every / 2)
          add_balcony(wall, a0, a1, y0);
      }
    }
    const double rise = shops ? 0.35 : 0.12, out = shops ? 1.5 * kLedge : kLedge;
    add_box(mesh, style_.trim, wall, {-out, length + out, y1 - rise, y1, 0, out}, kFront | kTop | kBottom);
  }

  /// The wall of a bay around an opening, and the opening's sides.
  void add_wall_around(const WallFrame& wall, Stuff stuff, double a0, double a1, double y0, double y1,
                       const Opening& o) {
    const auto flat = [&](double from, double to, double low, double high) {
      add_box(mesh, stuff, wall, {from, to, low, high, 0, 0}, kFront);
    };
    flat(a0, a1, y0, o.y0);
    flat(a0, a1, o.y1, y1);
    flat(a0, o.a0, o.y0, o.y1);
    flat(o.a1, a1, o.y0, o.y1);
    // Seen from inside the opening, as a box's own faces would be from outside.
    const auto side = [&](double from, double low, double to, double high) {
      add_face(mesh, stuff, wall.at(from, low, 0), wall.at(to, high, 0), wall.at(to, high, -kReveal),
               wall.at(from, low, -kReveal));
    };
    side(o.a0, o.y0, o.a1, o.y0);
    side(o.a1, o.y0, o.a1, o.y1);
    side(o.a1, o.y1, o.a0, o.y1);
    side(o.a0, o.y1, o.a0, o.y0);
  }

  /// Frame, bars and glass. Every pane leans a little: so the sun glints in some only.
  void add_window(const WallFrame& wall, const Opening& o, int across, int up) {
    const double back = -kReveal, front = back + 0.06;
    const Stuff frame = style_.trim;
    add_box(mesh, frame, wall, {o.a0, o.a0 + kFrame, o.y0, o.y1, back, front}, kFront | kRight);
    add_box(mesh, frame, wall, {o.a1 - kFrame, o.a1, o.y0, o.y1, back, front}, kFront | kLeft);
    add_box(mesh, frame, wall, {o.a0 + kFrame, o.a1 - kFrame, o.y0, o.y0 + kFrame, back, front}, kFront | kTop);
    add_box(mesh, frame, wall, {o.a0 + kFrame, o.a1 - kFrame, o.y1 - kFrame, o.y1, back, front}, kFront | kBottom);
    const double width = (o.a1 - o.a0) / across, height = (o.y1 - o.y0) / up;
    for (int i = 1; i < across; ++i) {
      const double a = o.a0 + i * width;
      add_box(mesh, frame, wall, {a - kBar / 2, a + kBar / 2, o.y0, o.y1, back, front}, kFront | kSides);
    }
    for (int i = 1; i < up; ++i) {
      const double y = o.y0 + i * height;
      add_box(mesh, frame, wall, {o.a0, o.a1, y - kBar / 2, y + kBar / 2, back, front}, kFront | kTop | kBottom);
    }
    for (int i = 0; i < across * up; ++i) {
      const double a = o.a0 + i % across * width, y = o.y0 + i / across * height;
      add_pane(wall, {a, a + width, y, y + height}, back);
    }
  }

  void add_pane(const WallFrame& wall, const Opening& o, double out) {
    const auto glass = static_cast<Stuff>(static_cast<uint32_t>(Stuff::glass) + random_.below(kShades));
    const uint32_t n = mesh.normal(wall.out + any_direction(random_) * 0.03);
    const auto corner = [&](double a, double y) { return Corner{mesh.vertex(wall.at(a, y, out)), n}; };
    const Corner first = corner(o.a0, o.y0), second = corner(o.a1, o.y0), third = corner(o.a1, o.y1);
    mesh.quad(glass, first, second, third, corner(o.a0, o.y1));
  }

  void add_window_bay(const WallFrame& wall, double a0, double a1, double y0, double y1) {
    const double middle = 0.5 * (a0 + a1), half = 0.5 * style_.window_width * (a1 - a0);
    const double low = y0 + 0.28 * (y1 - y0) * (1.6 - style_.window_height);
    const Opening o{middle - half, middle + half, low, low + style_.window_height * (y1 - y0)};
    add_wall_around(wall, style_.wall, a0, a1, y0, y1, o);
    add_window(wall, o, style_.panes_across, style_.panes_up);
    add_box(mesh, style_.trim, wall, {o.a0 - 0.08, o.a1 + 0.08, o.y0 - 0.08, o.y0, 0, 0.12}, kAll & ~kBack);
    if (random_.chance(0.25)) {
      const double down = o.y1 - (o.y1 - o.y0) * random_.real(0.15, 0.6);
      add_box(mesh, Stuff::blind, wall, {o.a0 + kFrame, o.a1 - kFrame, down, o.y1, -kReveal, -kReveal + 0.07},
              kFront | kBottom);
    }
  }

  void add_shop(const WallFrame& wall, double a0, double a1, double y0, double y1, bool door) {
    const double middle = 0.5 * (a0 + a1), half = 0.4 * (a1 - a0), top = y0 + 0.72 * (y1 - y0);
    const Opening o{middle - half, middle + half, y0 + (door ? 0.05 : 0.5), top};
    add_wall_around(wall, style_.foot, a0, a1, y0, y1, o);
    if (door) {
      add_box(mesh, Stuff::bark, wall, {o.a0, o.a1, o.y0, o.y1, -kReveal, -kReveal + 0.05}, kFront);
      for (int i = 0; i < 6; ++i) {
        const double a = o.a0 + 0.12 + i % 2 * half, y = o.y0 + 0.2 + i / 2 * 0.3 * (o.y1 - o.y0);
        add_box(mesh, Stuff::red_bark, wall,
                {a, a + half - 0.24, y, y + 0.22 * (o.y1 - o.y0), -kReveal, -kReveal + 0.09}, kAll & ~kBack);
      }
      return;
    }
    add_window(wall, o, 2, 1);
    if (!random_.chance(0.4)) return;
    const Stuff cloth = random_.chance(0.5) ? Stuff::awning : Stuff::petals;
    add_face(mesh, cloth, wall.at(a0, top - 0.4, 1.1), wall.at(a1, top - 0.4, 1.1), wall.at(a1, top + 0.2, 0),
             wall.at(a0, top + 0.2, 0));
    add_box(mesh, cloth, wall, {a0, a1, top - 0.6, top - 0.4, 1.1, 1.1}, kFront);
  }

  void add_balcony(const WallFrame& wall, double a0, double a1, double y) {
    constexpr double kDepth = 1.2, kRail = 1.05, kApart = 0.16, kPost = 0.015;
    add_box(mesh, style_.trim, wall, {a0, a1, y - 0.16, y, 0, kDepth}, kAll & ~kBack);
    const auto post = [&](double a, double o) {
      add_box(mesh, Stuff::iron, wall, {a - kPost, a + kPost, y, y + kRail, o - kPost, o + kPost}, kUpright);
    };
    const int along = static_cast<int>((a1 - a0) / kApart), out = static_cast<int>(kDepth / kApart);
    for (int i = 0; i <= along; ++i) post(a0 + 0.03 + (a1 - a0 - 0.06) * i / along, kDepth - 0.04);
    for (int i = 0; i < out; ++i) {
      const double o = kDepth * (i + 0.5) / out;
      post(a0 + 0.03, o);
      post(a1 - 0.03, o);
    }
    add_box(mesh, Stuff::iron, wall, {a0, a1, y + kRail, y + kRail + 0.05, kDepth - 0.07, kDepth}, kAll);
    add_box(mesh, Stuff::iron, wall, {a0, a0 + 0.06, y + kRail, y + kRail + 0.05, 0, kDepth - 0.07}, kAll);
    add_box(mesh, Stuff::iron, wall, {a1 - 0.06, a1, y + kRail, y + kRail + 0.05, 0, kDepth - 0.07}, kAll);
  }

  /// A floor within a parapet, with machines on it if nothing else stands there.
  void add_flat_roof(const Tier& tier, double y, bool open) {
    const WallFrame f = centre(y);
    const double x = tier.width / 2 + 0.05, z = tier.depth / 2 + 0.05, high = 0.9, thick = 0.3;
    add_box(mesh, Stuff::gravel, f, {-x, x, 0, 0.05, -z, z}, kTop);
    add_box(mesh, style_.trim, f, {-x, x, 0, high, z - thick, z}, kStanding);
    add_box(mesh, style_.trim, f, {-x, x, 0, high, -z, -z + thick}, kStanding);
    add_box(mesh, style_.trim, f, {-x, -x + thick, 0, high, -z + thick, z - thick}, kStanding);
    add_box(mesh, style_.trim, f, {x - thick, x, 0, high, -z + thick, z - thick}, kStanding);
    if (!open) return;
    const int machines = 2 + static_cast<int>(tier.width * tier.depth / 60);
    for (int i = 0; i < machines; ++i) {
      const double a = random_.real(-0.8, 0.6) * x, o = random_.real(-0.8, 0.6) * z;
      const double width = random_.real(0.8, 2.2), depth = random_.real(0.8, 1.8);
      add_machine({{a, y + 0.05, o}}, width, depth, random_.real(0.7, 1.6));
    }
    const double house = std::min(x, z) * 0.45;
    add_box(mesh, style_.wall, f, {-house, house * 0.4, 0.05, 3, -house, house * 0.5}, kStanding);
    // A mast on towers, whose tops are narrow.
    if (y > 60) add_box(mesh, Stuff::iron, f, {-0.2, 0.2, 3, 3 + 0.1 * y, -0.2, 0.2}, kStanding);
  }

  /// A box with slats on its sides.
  void add_machine(const WallFrame& f, double width, double depth, double height) {
    add_box(mesh, Stuff::steel, f, {0, width, 0, height, 0, depth}, kStanding);
    for (double y = 0.15; y + 0.1 < height; y += 0.18)
      add_box(mesh, Stuff::steel, f, {-0.05, width + 0.05, y, y + 0.06, -0.05, depth + 0.05}, kAll);
  }

  /// Rows of tiles up to a ridge along x, with dormers and chimneys.
  void add_gabled_roof(const Tier& tier, double y) {
    constexpr double kEaves = 0.45;
    constexpr int kRows = 14;
    const double x = tier.width / 2, z = tier.depth / 2 + kEaves, rise = 0.62 * tier.depth / 2;
    const WallFrame sides[] = {{{0, y, 0}}, {{0, y, 0}, {-1, 0, 0}, {0, 0, -1}}};
    for (const WallFrame& side : sides) {
      for (int row = 0; row < kRows; ++row) {
        const double o0 = z * (1 - static_cast<double>(row) / kRows), o1 = z * (1 - (row + 1.0) / kRows);
        const double y0 = rise * row / kRows + 0.08, y1 = rise * (row + 1) / kRows;
        add_face(mesh, Stuff::tiles, side.at(-x, y0, o0), side.at(x, y0, o0), side.at(x, y1, o1), side.at(-x, y1, o1));
        add_face(mesh, Stuff::tiles, side.at(-x, y0 - 0.08, o0), side.at(x, y0 - 0.08, o0), side.at(x, y0, o0),
                 side.at(-x, y0, o0));
      }
      const int dormers = static_cast<int>(tier.width / 4.5);
      for (int i = 0; i < dormers; ++i) {
        const double a = -x + tier.width * (i + 0.5) / dormers;
        add_dormer({side.at(a - 0.8, 0, 0), side.along, side.out}, 0.72 * z, rise * 0.28);
      }
    }
    for (const double hand : {-1.0, 1.0}) {
      const auto corner = [&](double height, double o) { return Corner{mesh.vertex({hand * x, y + height, o}), 0}; };
      const Corner top = corner(rise, 0), left = corner(0, -hand * z);
      mesh.triangle(style_.wall, corner(0, hand * z), left, top);
      const double a = hand * (x - 1.2), o = random_.real(-0.3, 0.3) * z;
      const WallFrame stack{{a, y, o}};
      add_box(mesh, Stuff::brick, stack, {-0.5, 0.5, 0.4 * rise, rise + 1.6, -0.35, 0.35}, kStanding);
      for (const double pot : {-0.35, -0.05, 0.25})
        add_box(mesh, Stuff::tiles, stack, {pot, pot + 0.2, rise + 1.6, rise + 2.1, -0.1, 0.1}, kStanding);
    }
  }

  /// A window of 1.6 m width in a roof, its front `out` from the middle.
  void add_dormer(const WallFrame& f, double out, double y) {
    const WallFrame front{f.at(0, y, out), f.along, f.out};
    constexpr double kWidth = 1.6, kHeight = 1.5;
    const Opening o{0.3, kWidth - 0.3, 0.25, kHeight - 0.15};
    add_wall_around(front, style_.trim, 0, kWidth, 0, kHeight, o);
    add_window(front, o, 2, 2);
    add_box(mesh, style_.wall, front, {0, kWidth, 0, kHeight, -0.7 * out, 0}, kSides);
    add_box(mesh, Stuff::tiles, front, {-0.12, kWidth + 0.12, kHeight, kHeight + 0.1, -0.75 * out, 0.2}, kAll);
  }

  const Style& style_;
  Random random_;
};

}  // namespace

ObjMesh raise_building(const std::vector<Tier>& tiers, const Style& style, uint64_t seed) {
  Mason mason(style, seed);
  mason.raise(tiers);
  return std::move(mason.mesh);
}

}  // namespace kd::bench::scenery
