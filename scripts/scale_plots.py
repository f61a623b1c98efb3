"""Draws docs/scale-cpu.svg and docs/scale-cuda.svg from docs/scale-cpu.json and docs/scale-cuda.json, and writes the
tables of docs/scale.md between its markers."""

import json

from plotting import DOCS, fill, plt, save, table

COLOURS = {"parse": "#b8860b", "load": "#1f6f8b", "hierarchy": "#7a5195", "upload": "#4c8c4a", "frame": "#c2571a"}
PANELS = [
    ("library", "objects listed; 10 in the picture", ["parse", "load", "upload", "frame"]),
    ("unseen_objects", "objects placed; 10 in view", ["parse", "load", "upload", "frame"]),
    ("picture", "instances in view", ["parse", "load", "hierarchy", "frame"]),
    ("unseen_instances", "instances out of view; 100 in view", ["parse", "load", "hierarchy", "frame"]),
]
TABLES = ["library", "folder", "seen_objects", "unseen_objects", "picture", "unseen_instances"]
LIGHTS = [("lights_lit", "lit", "#c2571a"), ("lights_black", "black", "#333333"), ("lights_behind", "behind", "#1f6f8b")]


def rows(report, name):
    return next(s["rows"] for s in report["series"] if s["name"] == name)


def ms(rows, step):
    return [1e3 * r["seconds"][step] for r in rows]


def plot(report, name):
    figure, axes = plt.subplots(2, 3, figsize=(9.6, 5.6))
    figure.suptitle(f"{report['device']}: milliseconds", fontsize=9)
    for axis, (series, title, steps) in zip(axes.flat, PANELS):
        own = rows(report, series)
        for step in steps:
            axis.plot([max(r["count"], 1) for r in own], ms(own, step), "-o", color=COLOURS[step], label=step)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_title(title, fontsize=8.5, loc="left")
        axis.legend(fontsize=6.5)
    axis = axes.flat[4]
    for series, label, colour in LIGHTS:
        own = rows(report, series)
        axis.plot([r["count"] for r in own], ms(own, "frame"), "-o", color=colour, label=label)
    axis.set_title("lights: a frame", fontsize=8.5, loc="left")
    axis.legend(fontsize=6.5)
    axis = axes.flat[5]
    own = [r for r in report["motion"] if r["count"] > 0]
    axis.plot([r["count"] for r in own], ms(own, "move"), "-o", color=COLOURS["frame"], label="move")
    axis.plot([r["count"] for r in own], ms(own, "place"), "-o", color=COLOURS["load"], label="place all")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_title(f"instances that move, of {report['motion'][0]['instances']:,}", fontsize=8.5, loc="left")
    axis.legend(fontsize=6.5)
    save(figure, name)


def number(value):
    """Three digits, or all of what is before the point."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def scenes_table(report, series):
    steps = ["parse", "load", "place", "hierarchy", "upload", "frame"]
    found = next(s for s in report["series"] if s["name"] == series)
    heads = [found["counts"], "opened", "parse, ms", "load, ms", "of it placing", "hierarchy", "upload, ms", "frame, ms", "objects, MB",
             "instances, MB"]
    body = [[f"{r['count']:,}", str(r["objects_opened"]), *[number(1e3 * r["seconds"][s]) for s in steps],
             number(1e-6 * r["bytes"]["objects"]), number(1e-6 * r["bytes"]["scene"])] for r in found["rows"]]
    return f"{found['title']}:\n\n{table(heads, body)}"


def lights_table(report):
    heads = ["lights", *[f"{label}: frame, ms" for _, label, _ in LIGHTS], *[f"{label}: shadow rays" for _, label, _ in LIGHTS]]
    series = [rows(report, name) for name, _, _ in LIGHTS]
    body = [[str(own[0]["count"]), *[number(1e3 * r["seconds"]["frame"]) for r in own],
             *[f"{r['rays']['shadow']:,}" for r in own]] for own in zip(*series)]
    return f"Lights, a hundred instances in view:\n\n{table(heads, body)}"


def motion_table(report):
    body = [[f"{r['count']:,}", number(1e3 * r["seconds"]["place"]), number(1e3 * r["seconds"]["move"]),
             f"{r['rebuilds']} of {r['moves']}"] for r in report["motion"]]
    heads = ["moving", "place all, ms", "move, ms", "moves that built again"]
    return f"Instances that move, of {report['motion'][0]['instances']:,}, on the host:\n\n{table(heads, body)}"


def main():
    page = DOCS / "scale.md"
    text = page.read_text()
    for device in ("cpu", "cuda"):
        body = "Not measured yet: run `kdbench scale --device cuda --size 1920x1080 --json FILE.json` on a GPU machine and give\n" \
               "`scripts/scale.sh` the file."
        path = DOCS / f"scale-{device}.json"
        if path.exists():
            report = json.loads(path.read_text())
            plot(report, f"scale-{device}")
            measured = [s["name"] for s in report["series"]]  # a report may be of a version that had fewer
            tables = [scenes_table(report, series) for series in TABLES if series in measured]
            tables += [lights_table(report), motion_table(report)]
            body = (f"{report['device']}; {report['machine']['processor']}, {report['threads']} threads; "
                    f"{report['film']['width']} x {report['film']['height']}, medians of {report['repeats']}.\n\n"
                    f"![Cost against size](scale-{device}.svg)\n\n" + "\n\n".join(tables))
        text = fill(text, device, body)
    page.write_text(text)


main()
