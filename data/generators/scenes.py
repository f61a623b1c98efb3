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


def walkthrough():
    """The cathedral, walked through from the west door to the altar steps while the pilgrim goes ahead."""
    scene = cathedral()
    scene["camera"] = {"up": [0, 1, 0], "vertical_fov": 60, "interpolation": "smooth", "keys": [
        {"frame": 1, "position": [1.0, 2.9, -1.2], "target": [0.0, 5.0, -26]},
        {"frame": 80, "position": [0.9, 1.7, -9.5], "target": [-0.2, 2.6, -24]},
        {"frame": 150, "position": [0.1, 1.65, -18.0], "target": [0.0, 2.4, -32]},
        {"frame": 240, "position": [0.0, 1.9, -30.5], "target": [0.0, 3.4, -39.2], "vertical_fov": 50}]}
    # The sun rises a little: the rose creeps along the floor.
    scene["lights"][0]["keys"] = [{"frame": 1, "direction": [-0.03, -0.39, 0.92]},
                                  {"frame": 240, "direction": [-0.06, -0.46, 0.88]}]
    for character in scene["characters"]:
        if character["name"] == "pilgrim":
            character["keys"] = [{"frame": 1, "translate": [0, 0, 0]}, {"frame": 200, "translate": [0, 0, -7.2]}]
    return scene


def turntable():
    """A figure on a plinth that turns once in 240 frames, between two that stand."""
    def paint(r, g, b):
        return {"ambient": [r, g, b], "diffuse": [r, g, b], "specular": [0.1] * 3, "shininess": 20}

    figure = [{"name": "robe", "object": "robe"}, {"name": "hood", "object": "hood"},
              {"name": "face", "object": "icosphere", "translate": [0, 1.645, -0.055], "scale": [0.09, 0.115, 0.095],
               "material": paint(0.62, 0.4, 0.29)},
              {"name": "right arm", "object": "arm", "translate": [0.2, 1.36, -0.06],
               "rotate": {"axis": [1, 0, 0], "degrees": 40}},
              {"name": "left arm", "object": "arm", "translate": [-0.2, 1.36, -0.02]},
              {"name": "staff", "object": "staff", "translate": [0.32, 0, -0.33]}]
    statue = [{"name": "plinth", "object": "plinth"},
              {"name": "figure", "character": "figure", "translate": [0, 0.96, 0]}]
    turns = [{"frame": 1, "rotate": {"axis": [0, 1, 0], "degrees": 0}},
             {"frame": 241, "rotate": {"axis": [0, 1, 0], "degrees": 360}}]
    files = {"robe": "figure_robe", "hood": "figure_hood", "arm": "figure_arm", "staff": "figure_staff",
             "plinth": "plinth", "icosphere": "icosphere", "quad": "quad"}
    return {
        "film": {"width": 640, "height": 640},
        "camera": {"position": [0, 2.3, -6.4], "target": [0, 1.35, 0], "up": [0, 1, 0], "vertical_fov": 38},
        "background": [0.55, 0.6, 0.68],
        "ambient": [0.16, 0.16, 0.18],
        "lights": [
            {"kind": "spot", "position": [-2.5, 5.5, -4], "direction": [2.5, -4.2, 4], "colour": [1, 0.94, 0.84],
             "inner_angle": 16, "outer_angle": 30},
            {"kind": "directional", "direction": [0.6, -0.9, 0.4], "colour": [0.22, 0.24, 0.3]}],
        "objects": [{"name": n, "file": "compiled/%s.nkd" % f} for n, f in files.items()],
        "characters": [
            {"name": "figure", "shown": False, "parts": figure},
            {"name": "statue", "shown": False, "parts": statue},
            {"name": "floor", "parts": [{"name": "floor", "object": "quad", "scale": [16, 1, 16],
                                         "material": paint(0.42, 0.4, 0.38)}]},
            {"name": "turntable", "keys": turns, "parts": [{"name": "statue", "character": "statue"}]},
            {"name": "bystanders", "parts": [
                {"name": "left", "character": "statue", "translate": [2.1, 0, 1.4],
                 "rotate": {"axis": [0, 1, 0], "degrees": 35}, "scale": [0.9, 0.9, 0.9], "material": paint(0.5, 0.45, 0.37)},
                {"name": "right", "character": "statue", "translate": [-2.1, 0, 1.4],
                 "rotate": {"axis": [0, 1, 0], "degrees": -35}, "scale": [-0.9, 0.9, 0.9],
                 "material": paint(0.36, 0.42, 0.47)}]}],
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


def placed(scene):
    """The objects that the scene's instances are of."""
    parts = {c["name"]: c["parts"] for c in scene["characters"]}

    def below(name):
        return [o for p in parts[name] for o in (below(p["character"]) if "character" in p else [p["object"]])]

    return [o for c in scene["characters"] if c.get("shown", True) for o in below(c["name"])]


def write(path, scene):
    """Readable JSON: one line for each part, light and object."""
    def line(value):
        return json.dumps(value)

    def block(items, indent):
        pad = " " * indent
        return "[\n" + ",\n".join(pad + "  " + item for item in items) + "\n" + pad + "]"

    def character(c):
        members = ["%s: %s" % (line(key), line(value)) for key, value in c.items() if key != "parts"]
        return "{%s}" % ", ".join(members + ['"parts": ' + block([line(p) for p in c["parts"]], 4)])

    characters = [character(c) for c in scene["characters"]]
    text = ["  %s: %s" % (line(key), line(scene[key])) for key in ("film", "camera", "background", "ambient")]
    text.append('  "lights": ' + block([line(v) for v in scene["lights"]], 2))
    text.append('  "objects": ' + block([line(v) for v in scene["objects"]], 2))
    text.append('  "characters": ' + block(characters, 2))
    with open(path, "w", newline="\n") as out:
        out.write("{\n" + ",\n".join(text) + "\n}\n")
