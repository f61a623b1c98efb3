"""The parts of the cathedral and the small test meshes.

The nave runs along z.  The structural parts model the right-hand side (x > 0);
the left-hand side is the same object with scale [-1, 1, 1].
"""

import math

from . import shapes
from .mesh import Mesh, unit
from .shapes import arch, box, circle, foil, lancet, lathe, plate, rib, sweep, tube

BAY = 5.6            # length of a bay along z
PIER = 5.0           # distance of the piers from the axis
SPAN = 4.6           # half span of the nave vault
SPRING = 10.5        # height of its springing
RISE = 6.2           # and its rise
AISLE = (5.4, 9.6)   # the aisle between the nave wall and the outer wall
AISLE_SPRING, AISLE_RISE = 5.2, 3.0
WALL = ("stone", "stone_b", "stone_c")
WEB = ("web", "web_b", "web_c")

# Name: (Ka, Kd, Ks, Ns).  A Ka above 1 makes flames glow in the ambient light.
MATERIALS = {
    "stone": ((0.62, 0.55, 0.44), None, 0.04, 12),
    "stone_b": ((0.58, 0.51, 0.405), None, 0.04, 12),
    "stone_c": ((0.65, 0.575, 0.465), None, 0.04, 12),
    "shaft": ((0.56, 0.48, 0.375), None, 0.12, 24),
    "trim": ((0.70, 0.635, 0.53), None, 0.06, 16),
    "rib": ((0.50, 0.415, 0.315), None, 0.05, 16),
    "web": ((0.68, 0.63, 0.54), None, 0.02, 8),
    "web_b": ((0.63, 0.58, 0.495), None, 0.02, 8),
    "web_c": ((0.71, 0.66, 0.575), None, 0.02, 8),
    "roof": ((0.16, 0.12, 0.09), None, 0.0, 8),
    "tile_light": ((0.66, 0.61, 0.52), None, 0.12, 40),
    "tile_dark": ((0.37, 0.31, 0.26), None, 0.12, 40),
    "tile_red": ((0.40, 0.20, 0.14), None, 0.14, 40),
    "carpet": ((0.50, 0.035, 0.04), None, 0.0, 8),
    "carpet_edge": ((0.72, 0.50, 0.14), None, 0.05, 12),
    "wood": ((0.30, 0.155, 0.07), None, 0.10, 24),
    "wood_dark": ((0.20, 0.10, 0.045), None, 0.10, 24),
    "brass": ((0.62, 0.42, 0.13), None, 0.55, 50),
    "iron": ((0.10, 0.095, 0.09), None, 0.25, 30),
    "wax": ((0.85, 0.80, 0.66), None, 0.10, 20),
    "flame": ((6.0, 4.3, 1.6), (0.4, 0.3, 0.1), 0.0, 8),
    "cloth": ((0.85, 0.83, 0.78), None, 0.02, 8),
    "robe": ((0.30, 0.18, 0.10), None, 0.02, 8),
    "plain": ((0.70, 0.70, 0.70), None, 0.20, 30),
}


def write_materials(path):
    lines = ["# Materials of the demo meshes", "# written by data/generate.py"]
    for name in sorted(MATERIALS):
        ambient, diffuse, specular, shininess = MATERIALS[name]
        lines += ["", "newmtl %s" % name, "Ka %g %g %g" % ambient,
                  "Kd %g %g %g" % (diffuse or ambient),
                  "Ks %g %g %g" % ((specular,) * 3), "Ns %g" % shininess]
    with open(path, "w", newline="\n") as out:
        out.write("\n".join(lines) + "\n")


# Helpers -----------------------------------------------------------------------

def on_wall(s, t, d):
    """(along z, height, x): the walls beside the nave."""
    return (d, t, s)


def across(s, t, d):
    """(along x, height, z): the end walls."""
    return (s, t, d)


def column(mesh, radius, bottom, top, at, segments=10, ring=None):
    """A round shaft with a moulded base and a flared capital."""
    r, h = radius, top - bottom
    foot, head = min(0.35, 0.12 * h), min(0.5, 0.14 * h)
    profile = [(1.6 * r, bottom), (1.6 * r, bottom + 0.3 * foot), (1.3 * r, bottom + 0.5 * foot),
               (1.35 * r, bottom + 0.75 * foot), (r, bottom + foot)]
    if ring is not None:
        profile += [(r, ring - 0.08), (1.35 * r, ring - 0.05), (1.35 * r, ring + 0.05), (r, ring + 0.08)]
    profile += [(r, top - head), (1.25 * r, top - 0.93 * head), (1.25 * r, top - 0.83 * head),
                (1.02 * r, top - 0.78 * head), (1.15 * r, top - 0.45 * head),
                (1.6 * r, top - 0.12 * head), (1.7 * r, top)]
    lathe(mesh, [(0, bottom)] + profile + [(0, top)], segments, at, start=math.pi / segments)


def vault_path(half_x, half_z, spring, rise, x=0.0, z=0.0, steps=12):
    """Half of an arch from (half_x, half_z) up to (0, 0) in plan, then moved."""
    return [(x + u * half_x, spring + rise * v, z + u * half_z)
            for u, v, _, _ in shapes.vault_curve(steps)]


def window(mesh, place, half, sill, spring, rise, middle):
    """Bar tracery for a pointed opening: two lancets below a sexfoil."""
    light, gap = 0.42 * half, 0.055 * half
    head = spring - 0.12 * rise
    holes = [lancet(light, sill + 0.12, head, 0.42 * rise, 6, sign * (light + gap))
             for sign in (-1, 1)]
    holes.append(foil(0, spring + 0.44 * rise, 0.375 * half, 6, steps=5))
    mesh.material = "trim"
    plate(mesh, lancet(half + 0.04, sill - 0.04, spring, rise + 0.04, 12), holes, place,
          middle - 0.09, middle + 0.09)


def archivolt(mesh, place, half, spring, rise, depth, radius, normal, low=None, steps=10):
    """A roll moulding round a pointed opening, down to `low`."""
    path = arch(half, spring, rise, steps)
    if low is not None:
        path = [(half, low)] + path + [(-half, low)]
    tube(mesh, [place(s, t, depth) for s, t in path], normal, radius)


# Structure ---------------------------------------------------------------------

def pier():
    """Everything that stands between two bays, from the floor to the vaults."""
    m = Mesh("cathedral_pier", "Clustered pier, wall shafts and transverse ribs")
    centre = (PIER, 0.0, 0.0)
    turn = math.pi / 8
    m.material = "trim"
    lathe(m, [(0, -0.02), (1.12, -0.02), (1.12, 0.3), (1.02, 0.42), (0, 0.42)], 8, centre, False, turn)
    lathe(m, [(0, 4.98), (0.98, 4.98), (1.08, 5.08), (1.08, 5.2), (0, 5.2)], 8, centre, False, turn)
    m.material = "stone"
    lathe(m, [(0, 0.42), (0.72, 0.42), (0.72, 0.5), (0.6, 0.6), (0.6, 4.4), (0.66, 4.43), (0.66, 4.5),
              (0.6, 4.53), (0.66, 4.75), (0.88, 4.98), (0, 4.98)], 24, centre)
    m.material = "shaft"
    for k in range(8):
        a = k * math.pi / 4
        r, far = (0.2, 0.62) if k % 2 == 0 else (0.13, 0.64)
        column(m, r, 0.42, 4.98, (PIER + far * math.cos(a), 0, far * math.sin(a)), 12 - 2 * (k % 2), 2.6)
    m.material = "trim"
    for k in range(16):  # crockets: buds under the abacus
        a = (k + 0.5) * math.pi / 8
        at = (PIER + 0.9 * math.cos(a), 4.84, 0.9 * math.sin(a))
        lathe(m, [(0, -0.13), (0.06, -0.06), (0.085, 0.03), (0.05, 0.11), (0, 0.13)], 6, at)
    # Three shafts carry the nave vault; one with two companions the aisle vault.
    m.material = "shaft"
    for r, x, z in ((0.16, 4.47, 0.0), (0.11, 4.53, 0.27), (0.11, 4.53, -0.27)):
        column(m, r, 5.2, SPRING, (x, 0, z), 10, 8.75)
    for r, x, z in ((0.2, 9.56, 0.0), (0.13, 9.6, 0.32), (0.13, 9.6, -0.32)):
        column(m, r, 0.3, AISLE_SPRING, (x, 0, z), 10, 2.6)
    m.material = "trim"
    box(m, (4.2, SPRING, -0.45), (4.7, SPRING + 0.12, 0.45))
    box(m, (9.2, AISLE_SPRING, -0.5), (9.75, AISLE_SPRING + 0.12, 0.5))
    box(m, (9.2, -0.02, -0.55), (9.75, 0.3, 0.55))
    m.material = "rib"
    rib(m, vault_path(SPAN, 0, SPRING, RISE, steps=16), 0.46, 0.36)
    middle, half = 0.5 * sum(AISLE), 0.5 * (AISLE[1] - AISLE[0])
    for side in (-half, half):
        rib(m, vault_path(side, 0, AISLE_SPRING, AISLE_RISE, middle), 0.36, 0.28)
    return m


def bay():
    """Arcade, triforium, clerestory and half the nave vault of one bay."""
    m = Mesh("cathedral_bay", "One bay of the nave: wall and half of its ribbed vault")
    h = 0.5 * BAY
    outline = [(-h, AISLE_SPRING)] + arch(2.1, AISLE_SPRING, 3.05)[::-1] + [
        (h, AISLE_SPRING), (h, 17.3), (-h, 17.3)]
    lights = [lancet(0.36, 9.05, 9.75, 0.55, 5, -1.5 + k) for k in range(4)]
    clerestory = (1.7, 11.1, 13.2, 2.6)
    plate(m, outline, lights + [lancet(*clerestory, steps=12)], on_wall, 4.55, 5.45, 0.42, WALL)
    window(m, on_wall, *clerestory, middle=5.1)
    # The inner order of the arcade: a ring of thinner wall within the arch.
    m.material = "trim"
    ring = arch(2.14, AISLE_SPRING, 3.09) + arch(1.84, AISLE_SPRING, 2.7)[::-1]
    plate(m, ring, [], on_wall, 4.75, 5.25)
    m.material = "shaft"
    for x in (4.56, 5.44):
        archivolt(m, on_wall, 2.16, AISLE_SPRING, 3.12, x, 0.085, (1, 0, 0))
    for x in (4.76, 5.24):
        archivolt(m, on_wall, 1.87, AISLE_SPRING, 2.74, x, 0.07, (1, 0, 0))
    m.material = "trim"
    archivolt(m, on_wall, 2.42, AISLE_SPRING, 3.42, 4.53, 0.06, (1, 0, 0))
    # Triforium: colonnettes between the lights, and a roll over each.
    m.material = "shaft"
    for k in range(5):
        column(m, 0.075, 8.98, 9.8, (4.5, 0, -2.0 + k), 8)
    m.material = "trim"
    for k in range(4):
        path = [on_wall(s, t, 4.52) for s, t in arch(0.45, 9.8, 0.62, 5, -1.5 + k)]
        tube(m, path, (1, 0, 0), 0.05, 6)
    for y in (8.75, 10.75):  # string courses
        profile = [(0.1, y - 0.05), (0.1, y + 0.08), (-0.1, y + 0.16), (-0.1, y - 0.16)]
        points = [(4.5 - a, b) for a, b in profile]
        plate(m, points, [], lambda s, t, d: (s, t, d), -h, h)
    archivolt(m, on_wall, 1.74, 13.2, 2.65, 4.55, 0.07, (1, 0, 0), 11.15)
    # The vault: webs, then diagonal, ridge and wall ribs, then the boss.
    for flip in (1, -1):
        shapes.vault_quarter(m, SPAN, h, SPRING, RISE,
                             lambda p, f=flip: (p[0], p[1], f * p[2]), WEB)
    m.material = "rib"
    for flip in (1, -1):
        rib(m, vault_path(SPAN, flip * h, SPRING, RISE), 0.3, 0.3)
        rib(m, [(SPAN - 0.05,) + p[1:] for p in vault_path(0, flip * h, SPRING, RISE)], 0.16, 0.14)
    crown = SPRING + RISE
    ridge = [(0.0, -0.12), (0.07, -0.04), (0.07, 0.05), (-0.07, 0.05), (-0.07, -0.04)]
    plate(m, ridge, [], lambda s, t, d: (s, crown + t, d), -h, h)
    plate(m, ridge, [], lambda s, t, d: (d, crown + t, s), 0.0, SPAN)
    m.material = "brass"
    lathe(m, [(0, -0.46), (0.12, -0.42), (0.3, -0.34), (0.36, -0.24), (0.3, -0.12), (0.3, 0.05)], 16,
          (0, crown, 0))
    return m


def aisle():
    """Side aisle of one bay: outer wall, window, vault and lean-to roof."""
    m = Mesh("cathedral_aisle", "One bay of the side aisle: outer wall, vault and roof")
    h = 0.5 * BAY
    opening = (1.55, 1.9, 4.7, 2.3)
    plate(m, [(-h, -0.02), (h, -0.02), (h, 8.9), (-h, 8.9)], [lancet(*opening, steps=12)],
          on_wall, 9.6, 10.4, 0.42, WALL)
    window(m, on_wall, *opening, middle=10.05)
    archivolt(m, on_wall, 1.6, 4.7, 2.35, 9.6, 0.07, (1, 0, 0), 1.9)
    box(m, (9.15, -0.02, -h), (9.6, 0.42, h))        # stone bench
    plate(m, [(9.45, 1.62), (9.6, 1.52), (9.6, 1.8), (9.45, 1.72)], [],
          lambda s, t, d: (s, t, d), -h, h)          # string course below the window
    middle, half = 0.5 * sum(AISLE), 0.5 * (AISLE[1] - AISLE[0])
    for sx in (1, -1):
        for sz in (1, -1):
            shapes.vault_quarter(m, half, h, AISLE_SPRING, AISLE_RISE,
                                 lambda p, a=sx, b=sz: (middle + a * p[0], p[1], b * p[2]), WEB, 8)
    m.material = "rib"
    for sx in (1, -1):
        for sz in (1, -1):
            rib(m, vault_path(sx * half, sz * h, AISLE_SPRING, AISLE_RISE, middle, steps=8), 0.24, 0.22)
    m.material = "brass"
    lathe(m, [(0, -0.32), (0.2, -0.24), (0.24, -0.16), (0.2, 0.0)], 12,
          (middle, AISLE_SPRING + AISLE_RISE, 0))
    m.material = "roof"
    plate(m, [(5.45, 10.75), (10.6, 8.85), (10.6, 9.0), (5.45, 10.9)], [],
          lambda s, t, d: (s, t, d), -h, h)
    return m


def end_wall():
    """The flat end of the church: a rose window above five lancets.

    The inner face is at z = 0 and looks along +z.
    """
    m = Mesh("cathedral_rose_wall", "End wall with a rose window and lancets")
    rose = (0.0, 11.55)
    radius = 3.55
    lights = [(x, 0.58, 2.6, 6.1 - 0.22 * abs(k), 1.0)
              for k, x in ((k, 1.6 * k) for k in range(-2, 3))]
    sides = [(x, 1.1, 2.2, 5.0, 1.7) for x in (-7.5, 7.5)]
    outline = [(-10.4, -0.02), (10.4, -0.02), (10.4, 9.2), (5.5, 11.0), (5.5, 17.3),
               (-5.5, 17.3), (-5.5, 11.0), (-10.4, 9.2)]
    holes = [circle(rose[0], rose[1], radius, 60)]
    holes += [lancet(w, sill, spring, rise, 8, x) for x, w, sill, spring, rise in lights + sides]
    plate(m, outline, holes, lambda s, t, d: (s, t, -d), 0.0, 0.9, 0.42, WALL)
    # Rose: an octofoil eye, twelve petals, twelve sexfoils.
    m.material = "trim"

    def polar(r, a):
        return (rose[0] + r * math.cos(a), rose[1] + r * math.sin(a))

    holes = [foil(rose[0], rose[1], 0.66, 8, steps=5)]
    for k in range(12):
        middle = math.pi / 2 + k * math.pi / 6
        petal = [(1.0, -0.155), (1.0, 0.155)]
        petal += [(x, y) for y, x in arch(0.44, 1.95, 0.62, 5)]  # (r, half width) pairs
        points = []
        for r, s in petal:
            c, d = math.cos(middle), math.sin(middle)
            points.append((rose[0] + r * c - s * d, rose[1] + r * d + s * c))
        holes.append(points)
        holes.append(foil(*polar(2.83, middle + math.pi / 12), 0.52, 6, middle + math.pi / 12, 4))
        holes.append(circle(*polar(3.1, middle), 0.2, 10, middle))
    plate(m, circle(rose[0], rose[1], radius + 0.04, 60), holes, across, -0.5, -0.28)
    m.material = "shaft"
    for r, bar, z, n in ((radius + 0.05, 0.12, 0.0, 48), (radius - 0.06, 0.09, -0.24, 48),
                         (radius + 0.42, 0.07, 0.02, 48), (0.84, 0.07, -0.26, 24)):
        tube(m, [(x, y, z) for x, y in circle(rose[0], rose[1], r, n)], (0, 0, 1), bar, 6, True)
    for k in range(12):  # spokes
        a = math.pi / 2 + (k + 0.5) * math.pi / 6
        tube(m, [polar(0.9, a) + (-0.26,), polar(2.2, a) + (-0.26,)], (0, 0, 1), 0.065, 6)
    m.material = "trim"
    for x, w, sill, spring, rise in sides:
        window(m, lambda s, t, d, x=x: (x + s, t, d), w, sill, spring, rise, -0.45)
    for x, w, sill, spring, rise in lights:
        archivolt(m, lambda s, t, d, x=x: (x + s, t, d), w + 0.03, spring, rise + 0.04, 0.0, 0.06,
                  (0, 0, 1))
    m.material = "shaft"
    for k in range(6):  # colonnettes between the lancets
        x = -4.0 + 1.6 * k
        top = min(v[3] for v in lights if abs(v[0] - x) < 0.9)
        column(m, 0.1, 2.5, top + 0.05, (x, 0, 0.06), 8)
    m.material = "trim"
    plate(m, [(0.14, 2.4), (0.14, 2.5), (-0.02, 2.56), (-0.02, 2.26)], [],
          lambda s, t, d: (d, t, s), -4.55, 4.55)
    return m


def floor():
    """The floor of one bay, wall to wall: tiles in two colours, red border tiles."""
    m = Mesh("cathedral_floor", "Tiled floor of one bay")
    tile, count = BAY / 8, 28
    for i in range(count):
        x0, x1 = (i - count / 2) * tile, (i + 1 - count / 2) * tile
        for k in range(8):
            z0, z1 = (k - 4) * tile, (k - 3) * tile
            m.material = ("tile_light", "tile_dark")[(i + k) % 2]
            if i in (7, 20):
                m.material = "tile_red"
            m.face([(x0, 0, z1), (x1, 0, z1), (x1, 0, z0), (x0, 0, z0)])
    return m


# Furniture ---------------------------------------------------------------------

def carpet():
    m = Mesh("carpet", "One bay of carpet with a gilt edge")
    h = 0.5 * BAY
    m.material = "carpet"
    box(m, (-0.95, -0.01, -h), (0.95, 0.018, h))
    m.material = "carpet_edge"
    for x in (-0.86, 0.8):
        box(m, (x, -0.01, -h), (x + 0.06, 0.02, h))
    return m


def pew():
    m = Mesh("pew", "Wooden pew, looking along -z")
    m.material = "wood"
    box(m, (-1.3, 0.42, -0.3), (1.3, 0.47, 0.12))
    back = [(0.14, 0.45), (0.19, 0.45), (0.27, 1.0), (0.22, 1.0)]
    plate(m, back, [], lambda s, t, d: (d, t, s), -1.3, 1.3)
    m.material = "wood_dark"
    box(m, (-1.34, 0.98, 0.18), (1.34, 1.03, 0.31))
    box(m, (-1.3, 0.12, -0.34), (1.3, 0.16, -0.16))
    side = [(-0.34, 0.0), (0.34, 0.0), (0.36, 0.1), (0.3, 0.18), (0.3, 0.55), (0.36, 1.0), (0.36, 1.12),
            (0.26, 1.2), (0.16, 1.12), (0.12, 0.74), (-0.22, 0.68), (-0.32, 0.6), (-0.34, 0.1)]
    for x in (-1.4, 1.34):
        plate(m, side, [], lambda s, t, d: (d, t, s), x, x + 0.06)
    return m


def candle(mesh, x, y, z, height, radius=0.03):
    mesh.material = "wax"
    lathe(mesh, [(0, 0), (radius, 0), (radius, height), (0.3 * radius, height), (0, height - 0.002)], 8,
          (x, y, z))
    mesh.material = "flame"
    f = radius / 0.03
    lathe(mesh, [(0, 0.0), (0.016 * f, 0.03 * f), (0.012 * f, 0.06 * f), (0, 0.11 * f)], 6,
          (x, y + height + 0.005, z))


def candle_stand():
    m = Mesh("candle_stand", "Tall candle stand", 4)
    m.material = "brass"
    lathe(m, [(0, 0), (0.26, 0), (0.26, 0.04), (0.14, 0.09), (0.06, 0.14), (0.035, 0.3), (0.03, 0.62),
              (0.07, 0.66), (0.07, 0.72), (0.03, 0.76), (0.026, 1.2), (0.07, 1.27), (0.16, 1.31),
              (0.17, 1.34), (0, 1.34)], 16)
    candle(m, 0, 1.34, 0, 0.34, 0.045)
    return m


def chandelier():
    """Two hoops of candles on rods; the origin is the middle of the lower hoop."""
    m = Mesh("chandelier", "Hanging chandelier of two hoops")
    for radius, y, count in ((1.15, 0.0, 16), (0.62, 0.6, 8)):
        m.material = "brass"
        hoop = [(x, y, -z) for x, z in circle(0, 0, radius, 32)]
        sweep(m, hoop, (0, 1, 0), [(0.025, -0.07), (0.025, 0.07), (-0.025, 0.07), (-0.025, -0.07)], True)
        for k in range(count):
            a = 2 * math.pi * k / count
            x, z = radius * math.cos(a), radius * math.sin(a)
            m.material = "brass"
            lathe(m, [(0, 0.05), (0.03, 0.06), (0.09, 0.12), (0, 0.12)], 8, (x, y, z))
            candle(m, x, y + 0.12, z, 0.22, 0.032)
    m.material = "iron"
    for k in range(4):
        a = math.pi * (k / 2.0 + 0.125)
        c, s = math.cos(a), math.sin(a)
        for r, y in ((1.15, 0.0), (0.62, 0.6)):
            tube(m, [(r * c, y, r * s), (0.03 * c, 1.9, 0.03 * s)], (-s, 0, c), 0.018, 4)
    m.material = "brass"
    lathe(m, [(0, 1.76), (0.06, 1.8), (0.1, 1.9), (0.06, 2.0), (0, 2.04)], 10)
    m.material = "iron"
    lathe(m, [(0, 2.0), (0.018, 2.0), (0.018, 11.0), (0, 11.0)], 5)
    return m


def altar():
    m = Mesh("altar", "Altar with cloth, cross and candles", 4)
    m.material = "trim"
    box(m, (-1.5, 0, -0.5), (1.5, 0.1, 0.5))
    box(m, (-1.55, 0.92, -0.55), (1.55, 1.02, 0.55))
    m.material = "stone"
    box(m, (-1.3, 0.1, -0.36), (1.3, 0.92, 0.36))
    ring = [(-1.4, 0.1), (1.4, 0.1), (1.4, 0.92), (-1.4, 0.92)]
    holes = [lancet(0.19, 0.18, 0.6, 0.24, 5, -1.1 + 0.44 * k) for k in range(6)]
    m.material = "trim"
    plate(m, ring, holes, across, 0.36, 0.44)
    m.material = "cloth"
    box(m, (-0.75, 1.02, -0.57), (0.75, 1.03, 0.57))
    fringe = [(-0.75, 1.03), (-0.75, 0.62)] + [
        (-0.75 + 0.125 * (k + 0.5), 0.62 - 0.1 * (1 - k % 2)) for k in range(12)] + [(0.75, 0.62), (0.75, 1.03)]
    plate(m, fringe, [], across, 0.56, 0.57)
    m.material = "brass"
    lathe(m, [(0, 1.03), (0.16, 1.03), (0.12, 1.09), (0.04, 1.13), (0.03, 1.2), (0, 1.2)], 12)
    w, l = 0.035, 0.3
    cross_outline = [(-w, 1.18), (w, 1.18), (w, 1.85), (l, 1.85), (l, 1.92), (w, 1.92), (w, 2.2),
                     (-w, 2.2), (-w, 1.92), (-l, 1.92), (-l, 1.85), (-w, 1.85)]
    plate(m, cross_outline, [], across, -0.02, 0.02)
    for x in (-1.2, -0.95, 0.95, 1.2):
        m.material = "brass"
        lathe(m, [(0, 1.02), (0.09, 1.02), (0.03, 1.08), (0.02, 1.25), (0.07, 1.3), (0, 1.3)], 10, (x, 0, 0))
        candle(m, x, 1.3, 0, 0.3)
    return m


def plinth():
    m = Mesh("plinth", "Octagonal plinth")
    m.material = "trim"
    lathe(m, [(0, 0), (0.5, 0), (0.5, 0.12), (0.4, 0.2), (0.36, 0.24), (0.36, 0.8), (0.44, 0.88),
              (0.44, 0.96), (0, 0.96)], 8, smooth=False, start=math.pi / 8)
    return m


# The figure: parts in one common frame, feet at the origin, looking along -z ----

def robe():
    m = Mesh("figure_robe", "Robe of the figure")
    m.material = "robe"
    rows = []
    for y, r, fold in ((0.0, 0.34, 0.045), (0.25, 0.305, 0.04), (0.55, 0.255, 0.028), (0.85, 0.21, 0.012),
                       (0.98, 0.195, 0.004), (1.02, 0.195, 0.004), (1.15, 0.205, 0.002),
                       (1.3, 0.215, 0.0), (1.4, 0.19, 0.0), (1.47, 0.11, 0.0), (1.5, 0.07, 0.0)):
        row = []
        for i in range(40):
            a = 2 * math.pi * i / 40
            q = r + fold * math.cos(10 * a)
            row.append((1.08 * q * math.cos(a), y, 0.8 * q * math.sin(a)))
        rows.append(row)
    shapes.surface(m, rows)
    m.material = "carpet_edge"
    belt = [(0.212 * 1.08 * math.cos(a), 1.0, -0.212 * 0.8 * math.sin(a))
            for a in (2 * math.pi * i / 32 for i in range(32))]
    tube(m, belt, (0, 1, 0), 0.02, 6, True)
    return m


def hood():
    m = Mesh("figure_hood", "Hood of the figure")
    m.material = "robe"
    rows = []
    for y, r, back in ((1.36, 0.2, 0.0), (1.42, 0.19, 0.01), (1.48, 0.14, 0.015), (1.56, 0.135, 0.02),
                       (1.66, 0.145, 0.025), (1.74, 0.125, 0.04), (1.8, 0.075, 0.06), (1.83, 0.02, 0.08)):
        rows.append([(r * math.cos(a), y, back + 1.02 * r * math.sin(a))
                     for a in (2 * math.pi * i / 24 for i in range(24))])
    shapes.surface(m, rows)
    return m


def arm():
    """A sleeve along -y from the shoulder at the origin."""
    m = Mesh("figure_arm", "Sleeve and hand of the figure")
    m.material = "robe"
    lathe(m, [(0, -0.5), (0.105, -0.52), (0.09, -0.38), (0.075, -0.2), (0.085, -0.05), (0.06, 0.04), (0, 0.07)], 16)
    m.material = "wax"
    lathe(m, [(0, -0.62), (0.035, -0.59), (0.04, -0.53), (0.03, -0.48), (0, -0.48)], 8)
    return m


def staff():
    m = Mesh("figure_staff", "Staff with a cross")
    m.material = "wood"
    lathe(m, [(0, 0), (0.02, 0), (0.018, 1.9), (0, 1.9)], 8)
    m.material = "brass"
    lathe(m, [(0, 1.86), (0.03, 1.88), (0.045, 1.93), (0.03, 1.98), (0, 2.0)], 8)
    box(m, (-0.018, 1.98, -0.018), (0.018, 2.3, 0.018))
    box(m, (-0.11, 2.14, -0.017), (0.11, 2.18, 0.017))
    return m


# Test meshes ---------------------------------------------------------------------

def cube():
    m = Mesh("cube", "Unit cube from (0, 0, 0) to (1, 1, 1)")
    m.material = "plain"
    box(m, (0, 0, 0), (1, 1, 1))
    for material, points, _ in m.faces[:]:
        m.faces.remove((material, points, None))
        m.face(points[:3])
        m.face([points[0], points[2], points[3]])
    return m


def quad():
    m = Mesh("quad", "Unit square in the plane y = 0, two triangles, looking up")
    m.material = "plain"
    m.face([(-0.5, 0, 0.5), (0.5, 0, 0.5), (0.5, 0, -0.5)])
    m.face([(-0.5, 0, 0.5), (0.5, 0, -0.5), (-0.5, 0, -0.5)])
    return m


def icosphere(levels=3):
    """Points and triangles of a subdivided icosahedron of radius 1."""
    g = (1 + math.sqrt(5)) / 2
    points = [unit(p) for p in (
        (-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
        (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1))]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
                 (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
                 (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(points)
                points.append(unit(tuple(points[i][c] + points[j][c] for c in range(3))))
            return middles[key]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return points, triangles


MESHES = (pier, bay, aisle, end_wall, floor, carpet, pew, candle_stand, chandelier, altar, plinth,
          robe, hood, arm, staff, cube, quad)
