"""The demo scenes, as JSON."""

import json
import math

from .parts import BAY

BAYS = 7


def cathedral():
    objects = {"pier": "cathedral_pier", "bay": "cathedral_bay", "aisle": "cathedral_aisle",
               "rose wall": "cathedral_rose_wall", "floor": "cathedral_floor"}
    for name in ("carpet", "pew", "candle_stand", "chandelier", "altar", "plinth", "cube", "icosphere",
                 "figure_robe", "figure_hood", "figure_arm", "figure_staff"):
        objects[name.replace("_", " ")] = name

    building, furniture = [], []

    def part(group, name, thing, at, **more):
        entry = {"name": name, "object": thing, "translate": [round(c, 4) for c in at]}
        entry.update(more)
        group.append(entry)

    def turned(degrees):
        return {"axis": [0, 1, 0], "degrees": degrees}

    length = round(BAYS * BAY, 4)
    mirrored = {"scale": [-1, 1, 1]}
    for k in range(BAYS + 1):
        z = -k * BAY
        part(building, "pier %d right" % (k + 1), "pier", (0, 0, z))
        part(building, "pier %d left" % (k + 1), "pier", (0, 0, z), **mirrored)
    for k in range(BAYS):
        z = -(k + 0.5) * BAY
        for thing in ("bay", "aisle"):
            part(building, "%s %d right" % (thing, k + 1), thing, (0, 0, z))
            part(building, "%s %d left" % (thing, k + 1), thing, (0, 0, z), **mirrored)
        part(building, "floor %d" % (k + 1), "floor", (0, 0, z))
    part(building, "east wall", "rose wall", (0, 0, -length))
    part(building, "west wall", "rose wall", (0, 0, 0), rotate=turned(180))

    for k in range(BAYS - 1):
        part(furniture, "carpet %d" % (k + 1), "carpet", (0, 0, -(k + 0.5) * BAY))
    # Steps: the unit cube mapped by its bounding box.
    for k in range(3):
        wide, deep = round(4.2 - 0.4 * k, 4), BAY - 0.45 * k
        furniture.append({"name": "step %d" % (k + 1), "object": "cube", "box": {
            "point": [-wide, 0.16 * k - 0.001 * (k == 0), -length], "x_axis": [round(2 * wide, 4), 0, 0],
            "y_axis": [0, 0.16, 0], "z_axis": [0, 0, round(deep, 4)]},
            "material": {"ambient": [0.58, 0.53, 0.45], "diffuse": [0.58, 0.53, 0.45],
                         "specular": [0.1, 0.1, 0.1], "shininess": 30}})
    part(furniture, "altar", "altar", (0, 0.48, -length + 2.0))
    for k, x in enumerate((-2.6, 2.6)):
        part(furniture, "altar candle %d" % (k + 1), "candle stand", (x, 0.48, -length + 2.6))
    for k in range(11):
        z = -19.4 - 1.15 * k
        for side, x in (("right", 2.55), ("left", -2.55)):
            part(furniture, "pew %d %s" % (k + 1, side), "pew", (x, 0, z))
    for k in range(3):
        z = -(1.5 * k + 2.5) * BAY
        for side, x in (("right", 2.75), ("left", -2.75)):
            part(furniture, "chandelier %d %s" % (k + 1, side), "chandelier", (x, 5.7, z))
    for k in range(1, BAYS - 1):
        for side, x in (("right", 1), ("left", -1)):
            part(furniture, "candle %d %s" % (k, side), "candle stand", (x * 3.55, 0, -k * BAY))

    def figure(at, degrees, scale, material=None, staff=True):
        """The parts of a figure that stands somewhere and looks along -z, turned."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        parts = []
        layout = [("robe", "figure robe", (0, 0, 0)), ("hood", "figure hood", (0, 0, 0)),
                  ("face", "icosphere", (0, 1.645, -0.055)),
                  ("right arm", "figure arm", (0.2, 1.36, -0.06)),
                  ("left arm", "figure arm", (-0.2, 1.36, -0.02))]
        if staff:
            layout.append(("staff", "figure staff", (0.32, 0, -0.33)))
        for name, thing, (x, y, z) in layout:
            entry = {"name": name, "object": thing, "translate": [
                round(at[0] + scale * (c * x + s * z), 4), round(at[1] + scale * y, 4),
                round(at[2] + scale * (c * z - s * x), 4)]}
            if name == "right arm":  # raised forward: turn about the figure's x axis
                entry["rotate"] = {"axis": [round(c, 5), 0, round(-s, 5)], "degrees": 40}
            elif degrees:
                entry["rotate"] = turned(degrees)
            if name == "face":
                entry["scale"] = [round(v * scale, 4) for v in (0.09, 0.115, 0.095)]
                entry["material"] = skin
            elif scale != 1:
                entry["scale"] = [scale] * 3
            if material:
                entry["material"] = material
            parts.append(entry)
        return parts

    skin = {"ambient": [0.62, 0.4, 0.29], "diffuse": [0.62, 0.4, 0.29],
            "specular": [0.1, 0.1, 0.1], "shininess": 20}
    stone = {"ambient": [0.66, 0.6, 0.5], "diffuse": [0.66, 0.6, 0.5],
             "specular": [0.08, 0.08, 0.08], "shininess": 20}
    characters = [{"name": "cathedral", "parts": building}, {"name": "furniture", "parts": furniture},
                  {"name": "pilgrim", "parts": figure((-0.45, 0.02, -8.6), 0, 1)}]
    for name, x, degrees in (("left statue", -3.4, -150), ("right statue", 3.4, 150)):
        at = (x, 0.96, -length + BAY + 1.0)
        parts = [{"name": "plinth", "object": "plinth", "translate": [x, 0, at[2]]}]
        characters.append({"name": name, "parts": parts + figure(at, degrees, 1.15, stone)})

    return {
        "film": {"width": 960, "height": 540},
        "camera": {"position": [1.0, 2.9, -1.2], "target": [0.0, 5.0, -26], "up": [0, 1, 0],
                   "vertical_fov": 60},
        "background": [0.62, 0.78, 0.98],
        "ambient": [0.11, 0.115, 0.14],
        "lights": [
            # The morning sun throws the rose on the floor; a second, weaker light
            # throws the clerestory windows.  Both come in through the openings.
            {"kind": "directional", "direction": [-0.03, -0.39, 0.92], "colour": [1.7, 1.28, 0.74]},
            {"kind": "directional", "direction": [-0.5, -0.8, -0.27], "colour": [0.8, 0.74, 0.64]},
            {"kind": "point", "position": [1.5, 4.9, -7.0], "colour": [0.27, 0.2, 0.12]},
            {"kind": "point", "position": [0, 5.1, -31.5], "colour": [0.28, 0.2, 0.11]}],
        "objects": [{"name": n, "file": "compiled/%s.nkd" % f} for n, f in objects.items()],
        "characters": characters,
    }


def spheres():
    def paint(r, g, b, specular, shininess):
        return {"ambient": [r, g, b], "diffuse": [r, g, b], "specular": [specular] * 3,
                "shininess": shininess}

    return {
        "film": {"width": 512, "height": 512},
        "camera": {"position": [0, 2.4, 6], "target": [0, 0.8, 0], "up": [0, 1, 0], "vertical_fov": 42},
        "background": [0.45, 0.6, 0.8],
        "ambient": [0.15, 0.15, 0.15],
        "lights": [
            {"kind": "point", "position": [-3, 5, 4], "colour": [0.4, 0.38, 0.34]},
            {"kind": "directional", "direction": [-0.5, -1, -0.6], "colour": [0.5, 0.5, 0.48]}],
        "objects": [{"name": n, "file": "compiled/%s.nkd" % n} for n in ("quad", "cube", "icosphere")],
        "characters": [{"name": "still life", "parts": [
            {"name": "floor", "object": "quad", "scale": [12, 1, 12]},
            {"name": "cube", "object": "cube", "translate": [0.4, 0, -1.9],
             "rotate": {"axis": [0, 1, 0], "degrees": 30}, "scale": [1.3, 1.3, 1.3],
             "material": paint(0.75, 0.55, 0.25, 0.1, 10)},
            {"name": "red ball", "object": "icosphere", "translate": [-1.3, 0.8, 0],
             "scale": [0.8, 0.8, 0.8], "material": paint(0.75, 0.12, 0.1, 0.5, 60)},
            {"name": "green ball", "object": "icosphere", "translate": [0.25, 0.5, 1.1],
             "scale": [0.5, 0.5, 0.5], "material": paint(0.15, 0.6, 0.2, 0.2, 12)},
            {"name": "blue egg", "object": "icosphere", "translate": [1.5, 1.0, 0.2],
             "rotate": {"axis": [0, 0, 1], "degrees": -20}, "scale": [0.55, 1.0, 0.55],
             "material": paint(0.15, 0.25, 0.75, 0.6, 120)}]}],
    }


def write(path, scene):
    """Readable JSON: one line for each part, light and object."""
    def line(value):
        return json.dumps(value)

    def block(items, indent):
        pad = " " * indent
        return "[\n" + ",\n".join(pad + "  " + item for item in items) + "\n" + pad + "]"

    characters = ['{"name": %s, "parts": %s}' % (line(c["name"]), block([line(p) for p in c["parts"]], 4))
                  for c in scene["characters"]]
    text = ["  %s: %s" % (line(key), line(scene[key])) for key in ("film", "camera", "background", "ambient")]
    text.append('  "lights": ' + block([line(v) for v in scene["lights"]], 2))
    text.append('  "objects": ' + block([line(v) for v in scene["objects"]], 2))
    text.append('  "characters": ' + block(characters, 2))
    with open(path, "w", newline="\n") as out:
        out.write("{\n" + ",\n".join(text) + "\n}\n")
