#!/usr/bin/env python3
"""Writes the demo meshes, their materials and the demo scenes into this folder.

    python3 data/generate.py

Needs Python 3.9 and its standard library only; the same files come out each time.
"""

import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True

from generators import mesh, parts, scenes  # noqa: E402


def main():
    library = "materials.mtl"
    parts.write_materials(os.path.join(HERE, library))
    print("%-26s %d materials" % (library, len(parts.MATERIALS)))
    total = size = 0
    counts = {}

    def report(name, triangles):
        nonlocal total, size
        here = os.path.getsize(os.path.join(HERE, name))
        counts[os.path.splitext(name)[0]] = triangles
        total, size = total + triangles, size + here
        print("%-26s %6d triangles %7d bytes" % (name, triangles, here))

    for make in parts.MESHES:
        made = make()
        name = made.name + ".obj"
        report(name, made.write_obj(os.path.join(HERE, name), library))
    points, triangles = parts.icosphere()
    report("icosphere.ply", mesh.write_ply(os.path.join(HERE, "icosphere.ply"),
                                           "Sphere of radius 1, written by data/generate.py",
                                           points, triangles))
    print("%-26s %6d triangles %7d bytes" % ("all meshes", total, size))
    for name, scene in (("cathedral.json", scenes.cathedral()), ("walkthrough.json", scenes.walkthrough()),
                        ("turntable.json", scenes.turntable()), ("spheres.json", scenes.spheres())):
        scenes.write(os.path.join(HERE, name), scene)
        files = {o["name"]: os.path.splitext(os.path.basename(o["file"]))[0] for o in scene["objects"]}
        used = [files[o] for o in scenes.placed(scene)]
        print("%-26s %6d instances, %d triangles as seen" % (
            name, len(used), sum(counts[f] for f in used)))


if __name__ == "__main__":
    main()
