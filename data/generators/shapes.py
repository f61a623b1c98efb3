"""Building blocks: arches, foils, plates with openings, sweeps, lathes, vaults."""

import math

from .mesh import add, cross, mul, sub, triangulate, unit

UP = (0.0, 1.0, 0.0)


# Outlines in the plane -------------------------------------------------------

def arch(half, spring, rise, steps=10, centre=0.0):
    """A pointed arch from right to left: two arcs centred on the springing line."""
    c = (rise * rise - half * half) / (2.0 * half)
    radius = half + c
    top = math.atan2(rise, c)
    right = [(-c + radius * math.cos(top * i / steps), radius * math.sin(top * i / steps))
             for i in range(steps + 1)]
    right[-1] = (0.0, rise)
    left = [(-x, y) for x, y in reversed(right[:-1])]
    return [(centre + x, spring + y) for x, y in right + left]


def lancet(half, sill, spring, rise, steps=8, centre=0.0):
    """A pointed window opening, counter-clockwise."""
    return [(centre - half, sill), (centre + half, sill)] + arch(half, spring, rise, steps, centre)


def circle(x, y, radius, count, start=0.0):
    return [(x + radius * math.cos(start + 2 * math.pi * i / count),
             y + radius * math.sin(start + 2 * math.pi * i / count)) for i in range(count)]


def foil(x, y, radius, lobes, start=math.pi / 2, steps=6):
    """A flower of round lobes (quatrefoil, sexfoil, ...) with cusps between them."""
    half = math.pi / lobes
    d = 0.93 * radius / (1.0 + math.sin(half))
    lobe = radius - d
    cusp = d * math.cos(half) + math.sqrt(lobe * lobe - (d * math.sin(half)) ** 2)
    reach = math.atan2(cusp * math.sin(half), cusp * math.cos(half) - d)
    points = []
    for k in range(lobes):
        angle = start + 2 * half * k
        cx, cy = x + d * math.cos(angle), y + d * math.sin(angle)
        for i in range(steps):
            a = angle - reach + 2 * reach * i / steps
            points.append((cx + lobe * math.cos(a), cy + lobe * math.sin(a)))
    return points


def shuffle(k, count):
    """Which of `count` tones the k-th course of stones has: no plain stripes."""
    return k * 7 % 5 % count


# Solids ----------------------------------------------------------------------

def plate(mesh, outer, holes, place, d0, d1, courses=0.0, tones=None):
    """A slab with openings: an outline in (s, t), from depth d0 to d1.

    `place(s, t, d)` maps to space.  With `courses` the flat side at d0
    is cut into horizontal courses of that height, coloured by the tones in turn.
    """
    ccw = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outer, outer[1:] + outer[:1])) > 0
    outer = outer if ccw else outer[::-1]
    if courses:  # the outlines get corners there too, so that no cracks open
        outer, holes = notch(outer, courses), [notch(h, courses) for h in holes]
    o = place(0, 0, 0)
    e = [sub(place(*p), o) for p in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    mirrored = sum(cross(e[0], e[1])[i] * e[2][i] for i in range(3)) < 0
    base = mesh.material

    def emit(points):
        mesh.face(points[::-1] if mirrored else points)

    pieces = triangulate(outer, holes)
    for triangle in pieces:
        emit([place(s, t, d1) for s, t in triangle])
    if courses:
        cut = []
        for triangle in pieces:
            low = int(math.floor(min(p[1] for p in triangle) / courses))
            high = int(math.ceil(max(p[1] for p in triangle) / courses))
            for k in range(low, high):
                part = band(triangle, k * courses, (k + 1) * courses)
                tone = tones[shuffle(k, len(tones))]
                for i in range(1, len(part) - 1):
                    cut.append((tone, [part[0], part[i], part[i + 1]]))
    else:
        cut = [(base, triangle) for triangle in pieces]
    for tone, part in cut:
        mesh.material = tone
        emit([place(s, t, d0) for s, t in reversed(part)])
    mesh.material = base
    for ring, outward in [(outer, True)] + [(h, False) for h in holes]:
        clockwise = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1])) < 0
        ring = ring[::-1] if clockwise == outward else ring
        for i, b in enumerate(ring):
            a = ring[i - 1]
            emit([place(a[0], a[1], d0), place(b[0], b[1], d0),
                  place(b[0], b[1], d1), place(a[0], a[1], d1)])


def notch(ring, step):
    """The same outline with extra points at every multiple of a height."""
    result = []
    for a, b in zip(ring, ring[1:] + ring[:1]):
        result.append(a)
        low, high = sorted((a[1] / step, b[1] / step))
        cuts = [k * step for k in range(int(math.floor(low)) + 1, int(math.ceil(high)))
                if low + 1e-3 < k < high - 1e-3]
        for y in cuts if b[1] > a[1] else cuts[::-1]:
            result.append((a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]), y))
    return result


def band(polygon, low, high):
    """The part of a convex polygon with low <= y <= high."""
    for sign, limit in ((1, low), (-1, high)):
        result = []
        for i, b in enumerate(polygon):
            a = polygon[i - 1]
            da, db = sign * (a[1] - limit), sign * (b[1] - limit)
            if (da < 0) != (db < 0):
                f = da / (da - db)
                result.append((a[0] + f * (b[0] - a[0]), limit))
            if db >= 0:
                result.append(b)
        polygon = result
    return polygon


def box(mesh, low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    p = [(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
    for quad in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
        mesh.face([p[i] for i in quad])


def sweep(mesh, path, plane, profile, closed=False, smooth=False):
    """Sweep a counter-clockwise profile (a, b) along a path in a plane.

    b runs along the plane's normal, a along normal x tangent.  The shading is
    smooth along the path, and around the profile too when `smooth`.
    """
    plane = unit(plane)
    count, sides = len(path), len(profile)
    edge = []
    for j in range(sides):
        da = profile[(j + 1) % sides][0] - profile[j][0]
        db = profile[(j + 1) % sides][1] - profile[j][1]
        length = math.hypot(da, db)
        edge.append((db / length, -da / length))
    rings, frames = [], []
    for k, point in enumerate(path):
        before = unit(sub(point, path[k - 1])) if k or closed else None
        after = unit(sub(path[(k + 1) % count], point)) if k + 1 < count or closed else None
        tangent = unit(add(before, after)) if before and after else (before or after)
        side = cross(plane, tangent)
        cosine = sum(tangent[i] * (after or before)[i] for i in range(3))
        stretch = min(1.0 / max(cosine, 0.3), 2.0)
        rings.append([add(point, add(mul(side, a * stretch), mul(plane, b))) for a, b in profile])
        frames.append(side)

    def shade(k, j, edge_index):
        a, b = edge[edge_index]
        if smooth:
            a, b = edge[j - 1][0] + edge[j % sides][0], edge[j - 1][1] + edge[j % sides][1]
        return unit(add(mul(frames[k], a), mul(plane, b)))

    for k in range(count if closed else count - 1):
        n = (k + 1) % count
        for j in range(sides):
            i = (j + 1) % sides
            mesh.face([rings[k][j], rings[k][i], rings[n][i], rings[n][j]],
                      [shade(k, j, j), shade(k, i, j), shade(n, i, j), shade(n, j, j)])
    if not closed:
        for ring in (rings[0][::-1], rings[-1]):
            for i in range(1, sides - 1):
                mesh.face([ring[0], ring[i], ring[i + 1]])


def tube(mesh, path, plane, radius, sides=8, closed=False):
    """A round bar along a planar path."""
    sweep(mesh, path, plane, circle(0, 0, radius, sides, math.pi / sides), closed, True)


def lathe(mesh, profile, segments, at=(0.0, 0.0, 0.0), smooth=True, start=0.0):
    """Turn a profile of (radius, height), bottom to top, about a vertical axis.

    Edges of the profile that meet below 50 degrees are shaded as one curve.
    """
    edges = []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length = math.hypot(r1 - r0, y1 - y0)
        edges.append(((y1 - y0) / length, (r0 - r1) / length))

    def shade(k, other):
        a = edges[k]
        if 0 <= other < len(edges):
            b = edges[other]
            if a[0] * b[0] + a[1] * b[1] > 0.64:
                return (a[0] + b[0], a[1] + b[1])
        return a

    def spin(i):
        angle = start + 2 * math.pi * (i % segments) / segments
        return math.cos(angle), math.sin(angle)

    for k, ((r0, y0), (r1, y1)) in enumerate(zip(profile, profile[1:])):
        n0, n1 = shade(k, k - 1), shade(k, k + 1)
        for i in range(segments):
            (c0, s0), (c1, s1) = spin(i), spin(i + 1)
            points, normals = [], []
            for r, y, n, c, s in ((r0, y0, n0, c0, s0), (r1, y1, n1, c0, s0),
                                  (r1, y1, n1, c1, s1), (r0, y0, n0, c1, s1)):
                point = add(at, (r * c, y, r * s))
                if r == 0 and points and points[-1] == point:
                    continue
                if r == 0 and points and points[0] == point:
                    continue
                points.append(point)
                normals.append((n[0] * c, n[1], n[0] * s))
            flat = not smooth or (edges[k][0] == 0)
            mesh.face(points, None if flat else normals)


def surface(mesh, rows):
    """A smooth skin over rows of points, each row a closed ring, bottom to top."""
    count = len(rows[0])

    def normal(k, i):
        up = sub(rows[min(k + 1, len(rows) - 1)][i], rows[max(k - 1, 0)][i])
        along = sub(rows[k][(i + 1) % count], rows[k][i - 1])
        return unit(cross(up, along))

    for k in range(len(rows) - 1):
        for i in range(count):
            j = (i + 1) % count
            mesh.face([rows[k][i], rows[k + 1][i], rows[k + 1][j], rows[k][j]],
                      [normal(k, i), normal(k + 1, i), normal(k + 1, j), normal(k, j)])
    for k, order in ((0, 1), (len(rows) - 1, -1)):
        centre = mul(tuple(sum(p[c] for p in rows[k]) for c in range(3)), 1.0 / count)
        for i in range(count):
            pair = (rows[k][i], rows[k][(i + 1) % count])
            mesh.face((centre,) + pair[::order])


# Vaults ----------------------------------------------------------------------

def vault_curve(steps, sharp=0.6):
    """A unit pointed half-arch, springing to crown: (u, v, du, dv) samples.

    u is the distance from the middle (1 at the springing), v the height (1 at
    the crown); (du, dv) is the tangent.
    """
    radius, height = 1.0 + sharp, math.sqrt(1.0 + 2.0 * sharp)
    top = math.acos(sharp / radius)
    samples = []
    for i in range(steps + 1):
        a = top * i / steps
        samples.append((max(radius * math.cos(a) - sharp, 0.0) if i < steps else 0.0,
                        radius * math.sin(a) / height,
                        -radius * math.sin(a), radius * math.cos(a) / height))
    return samples


def vault_quarter(mesh, half_x, half_z, spring, height, move, tones, steps=12):
    """A quarter of a four-part vault, x and z from 0 (crown) to the half spans.

    Each course of stones is a straight strip, coloured by the tones in turn.
    """
    samples = vault_curve(steps)
    for k in range(steps):
        mesh.material = tones[shuffle(k, len(tones))]
        (u0, v0, a0, b0), (u1, v1, a1, b1) = samples[k], samples[k + 1]
        y0, y1 = spring + height * v0, spring + height * v1
        for swap in (False, True):
            across, along = (half_x, half_z) if not swap else (half_z, half_x)
            # Heights depend on `along` only; the strip runs `across`, rib to wall.
            points = [(u0 * across, y0, u0 * along), (across, y0, u0 * along),
                      (across, y1, u1 * along), (u1 * across, y1, u1 * along)]
            n0 = unit((0, along * a0, -height * b0))
            n1 = unit((0, along * a1, -height * b1))
            normals = [n0, n0, n1, n1]
            if swap:
                points = [p[::-1] for p in points]
                normals = [n[::-1] for n in normals]
            moved = [move(p) for p in points]
            o = move((0, 0, 0))
            turned = [sub(move(n), o) for n in normals]
            # Face down, into the room.
            g = cross(sub(moved[2], moved[0]), sub(moved[3], moved[1]))
            if sum(g[i] * turned[2][i] for i in range(3)) < 0:
                moved.reverse()
                turned.reverse()
            mesh.face(moved, turned)


def rib_profile(width, depth):
    """A chamfered rib below a vault: a < 0 hangs into the room."""
    w = 0.5 * width
    return [(0.05, w), (-0.55 * depth, w), (-0.75 * depth, 0.55 * w), (-depth, 0.4 * w),
            (-depth, -0.4 * w), (-0.75 * depth, -0.55 * w), (-0.55 * depth, -w), (0.05, -w)]


def rib(mesh, path, width, depth):
    """A rib along a half-arch from its springing up to the crown."""
    outward = unit((path[0][0] - path[-1][0], 0.0, path[0][2] - path[-1][2]))
    sweep(mesh, path, cross(UP, outward), rib_profile(width, depth))
