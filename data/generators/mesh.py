"""A polygon collector with OBJ, MTL and PLY writers, and polygon triangulation.

Nothing here knows about cathedrals.  All lengths are metres, y points up.
"""

import math
import struct


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return mul(a, 1.0 / length) if length > 0 else a


def number(value, digits):
    """The shortest decimal text of a value rounded to some digits."""
    text = "%.*f" % (digits, value)
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


class Mesh:
    """Faces with a material each; vertices are shared when the mesh is written."""

    def __init__(self, name, note, digits=3):
        self.name = name
        self.note = note
        self.digits = digits
        self.faces = []  # (material, points, normals or None)
        self.material = "stone"

    def face(self, points, normals=None):
        """One triangle or convex quad, counter-clockwise seen from outside."""
        self.faces.append((self.material, list(points), list(normals) if normals else None))

    def indexed(self):
        """(vertices, normals, faces by material), rounded, merged and cleaned."""
        vertices, vertex_ids, normals, normal_ids = [], {}, [], {}
        groups, seen = {}, set()

        def share(value, digits, table, ids):
            key = tuple(number(c, digits) for c in value)
            if key not in ids:
                ids[key] = len(table)
                table.append(key)
            return ids[key]

        for material, points, shading in self.faces:
            corners = []
            for i, point in enumerate(points):
                key = tuple(number(c, self.digits) for c in point)
                if any(key == c[0] for c in corners):
                    continue  # rounding made two corners one
                corners.append((key, shading[i] if shading else None))
            pieces = [corners]
            if len(corners) == 4:  # a quad with three corners in a line: two triangles
                flat = [[float(c) for c in corner[0]] for corner in corners]
                for i in range(4):
                    a, b, c = flat[i - 1], flat[i], flat[(i + 1) % 4]
                    if dot(cross(sub(b, a), sub(c, a)), cross(sub(b, a), sub(c, a))) < 1e-14:
                        pieces = [[corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]],
                                  [corners[i], corners[(i + 2) % 4], corners[i - 1]]]
            for piece in pieces:
                if len(piece) < 3:
                    continue
                p = [[float(c) for c in corner[0]] for corner in piece]
                normal = cross(sub(p[1], p[0]), sub(p[2], p[0]))
                if dot(normal, normal) < 1e-14:
                    continue  # no area
                identity = tuple(sorted(corner[0] for corner in piece))
                if identity in seen:
                    continue
                seen.add(identity)
                face = []
                for corner in piece:
                    v = share([float(c) for c in corner[0]], self.digits, vertices, vertex_ids)
                    n = None
                    if corner[1] is not None:
                        n = share(unit(corner[1]), 2, normals, normal_ids)
                    face.append((v, n))
                groups.setdefault(material, []).append(face)
        return vertices, normals, groups

    def write_obj(self, path, library):
        """Write the mesh; returns its number of triangles."""
        vertices, normals, groups = self.indexed()
        lines = ["# %s" % self.note, "# written by data/generate.py"]
        if library:
            lines.append("mtllib %s" % library)
        lines.append("o %s" % self.name)
        lines += ["v " + " ".join(v) for v in vertices]
        lines += ["vn " + " ".join(n) for n in normals]
        triangles = 0
        for material in sorted(groups):
            lines.append("usemtl %s" % material)
            for face in groups[material]:
                triangles += len(face) - 2
                lines.append("f " + " ".join(
                    str(v + 1) if n is None else "%d//%d" % (v + 1, n + 1) for v, n in face))
        with open(path, "w", newline="\n") as out:
            out.write("\n".join(lines) + "\n")
        return triangles


def write_ply(path, note, points, triangles):
    """A binary little-endian PLY file of float vertices and triangles."""
    header = ("ply\nformat binary_little_endian 1.0\ncomment %s\n"
              "element vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
              "element face %d\nproperty list uchar int vertex_indices\nend_header\n"
              % (note, len(points), len(triangles)))
    with open(path, "wb") as out:
        out.write(header.encode("ascii"))
        for p in points:
            out.write(struct.pack("<3f", *p))
        for t in triangles:
            out.write(struct.pack("<B3i", 3, *t))
    return len(triangles)


# Polygons in the plane ------------------------------------------------------

def area(polygon):
    """Signed area: positive for counter-clockwise."""
    return 0.5 * sum(polygon[i - 1][0] * p[1] - p[0] * polygon[i - 1][1]
                     for i, p in enumerate(polygon))


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def triangulate(outer, holes):
    """Triangles (counter-clockwise point triples) of a polygon with holes.

    Each hole is joined to the loop by its shortest free bridge, then ears
    with the shortest chords are cut off, then edges are flipped towards
    Delaunay, which removes most of the slivers.
    """
    loop = list(outer) if area(outer) > 0 else list(reversed(outer))
    rest = [list(h) if area(h) < 0 else list(reversed(h)) for h in holes]

    def blocked(a, b, loops):
        for ring in loops:
            for i in range(len(ring)):
                c, d = ring[i - 1], ring[i]
                if a in (c, d) or b in (c, d):
                    continue
                if turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0:
                    return True
        return False

    # The hole that reaches farthest right always sees the loop made so far.
    rest.sort(key=lambda hole: max(hole))
    while rest:
        hole = rest.pop()
        choices = sorted(((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2, j, i)
                         for j, q in enumerate(hole) for i, p in enumerate(loop))
        for _, j, i in choices:
            if not blocked(loop[i], hole[j], [loop, hole] + rest):
                loop = loop[:i + 1] + hole[j:] + hole[:j + 1] + loop[i:]
                break
        else:
            raise ValueError("a hole lies outside its polygon")

    def is_ear(k):
        a, b, c = loop[k - 1], loop[k], loop[(k + 1) % len(loop)]
        if turn(a, b, c) <= 1e-12:
            return False
        for p in loop:
            if p in (a, b, c):
                continue
            if turn(a, b, p) >= 0 and turn(b, c, p) >= 0 and turn(c, a, p) >= 0:
                return False
        return True

    triangles = []
    while len(loop) > 3:
        n = len(loop)
        order = sorted(range(n), key=lambda k: (
            (loop[k - 1][0] - loop[(k + 1) % n][0]) ** 2
            + (loop[k - 1][1] - loop[(k + 1) % n][1]) ** 2, k))
        for k in order:
            if is_ear(k):
                triangles.append((loop[k - 1], loop[k], loop[(k + 1) % n]))
                del loop[k]
                break
        else:  # only points in a line are left: drop the flattest
            k = min(range(n), key=lambda i: abs(turn(loop[i - 1], loop[i], loop[(i + 1) % n])))
            del loop[k]
    triangles.append(tuple(loop))
    wanted = abs(area(outer)) - sum(abs(area(h)) for h in holes)
    got = sum(area(t) for t in triangles)
    if abs(wanted - got) > 1e-6 * max(1.0, wanted):
        raise ValueError("triangulation failed: area %g, not %g" % (got, wanted))
    return flip(triangles)


def flip(triangles):
    """Flip inner edges until the larger opposite angles are gone (a few rounds)."""
    triangles = [list(t) for t in triangles]
    for _ in range(12):
        edges, changed = {}, False
        for t, tri in enumerate(triangles):
            for i in range(3):
                edges.setdefault((tri[i], tri[(i + 1) % 3]), []).append((t, i))
        touched = set()
        for (a, b), mine in sorted(edges.items()):
            theirs = edges.get((b, a), [])
            if len(mine) != 1 or len(theirs) != 1:
                continue
            (t, i), (s, j) = mine[0], theirs[0]
            if t in touched or s in touched or t > s:
                continue
            c, d = triangles[t][(i + 2) % 3], triangles[s][(j + 2) % 3]
            if turn(c, d, b) <= 1e-9 or turn(d, c, a) <= 1e-9:
                continue  # not convex: cannot flip

            def angle(p):
                u, v = (a[0] - p[0], a[1] - p[1]), (b[0] - p[0], b[1] - p[1])
                return math.atan2(abs(u[0] * v[1] - u[1] * v[0]), u[0] * v[0] + u[1] * v[1])
            if angle(c) + angle(d) > math.pi + 1e-6:
                triangles[t], triangles[s] = [c, d, b], [d, c, a]
                touched.update((t, s))
                changed = True
        if not changed:
            break
    return [tuple(t) for t in triangles]
