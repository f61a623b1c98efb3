"""Draws docs/pareto-*.svg (and out/pareto/*.png) from docs/pareto-cpu.csv and docs/pareto-cuda.csv, and writes the
tables of docs/pareto.md between its markers. Errors are the same on every device, as the arithmetic is; speeds are not."""

import csv
import math

from plotting import DOCS, fill, plt, save, table

PLAIN = {"float32 MT": "^", "float32 Woop": "s"}
MESH_COLOURS = ["#1f6f8b", "#c2571a", "#4c8c4a", "#7a5195", "#b8860b", "#555555"]
RAYS = ["primary", "shadow", "diffuse"]


def read(device):
    path = DOCS / f"pareto-{device}.csv"
    if not path.exists():
        return []
    rows = list(csv.DictReader(path.open()))
    for row in rows:
        for key, text in row.items():
            if key not in ("mesh", "device", "form", "vertices", "triangle_test"):
                row[key] = float(text) if text else math.nan
    return rows


def meshes(rows):
    return list(dict.fromkeys(r["mesh"] for r in rows))


def ours(rows, mesh):
    """The exact forms of a mesh, by bits."""
    found = [r for r in rows if r["mesh"] == mesh and r["triangle_test"] == "exact"]
    return sorted(found, key=lambda r: r["bits"])


def row(rows, mesh, form):
    return next(r for r in rows if r["mesh"] == mesh and r["form"] == form)


def geometric_mean(values):
    values = [v for v in values if v > 0]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def grid_of_meshes(rows, title):
    figure, axes = plt.subplots(2, 3, figsize=(9.6, 5.8))
    figure.suptitle(title, fontsize=9)
    for axis, mesh in zip(axes.flat, meshes(rows)):
        axis.set_title(mesh, fontsize=8.5, loc="left")
    for axis in list(axes.flat)[len(meshes(rows)):]:
        axis.set_visible(False)
    return figure, list(axes.flat)


def plot_against_depth(rows, title, name, curves, label):
    """One panel a mesh, one line a curve, (name, colour, value of a row), over the RMS depth error."""
    figure, axes = grid_of_meshes(rows, title)
    for axis, mesh in zip(axes, meshes(rows)):
        exact = ours(rows, mesh)
        x = [r["depth_rms_steps21"] for r in exact]
        for curve, colour, value in curves:
            axis.plot(x, [value(r) for r in exact], "-o", color=colour, label=f"{curve}fixed point, exact", markersize=3)
            for form, marker in PLAIN.items():
                r = row(rows, mesh, form)
                axis.plot(r["depth_rms_steps21"], value(r), marker, color=colour, markerfacecolor="white",
                          label=f"{curve}{form}")
        top = max(value(r) for _, _, value in curves for r in exact + [row(rows, mesh, f) for f in PLAIN])
        for r, px in zip(exact, x):
            axis.annotate(f"{r['bits']:.0f}", (px, 1.06 * top), ha="center", fontsize=7, color="#555555")
        axis.set_xscale("log")
        axis.set_ylim(0, 1.2 * top)
    for axis in axes[3:]:
        axis.set_xlabel("RMS depth error, steps of 21 bits; above: B")
    for axis in axes[::3]:
        axis.set_ylabel(label)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=7, loc="lower center", ncol=len(curves) if len(curves) > 1 else 3)
    save(figure, name, bottom=0.04 + 0.035 * (3 if len(curves) > 1 else 1))


def plot_errors(rows):
    """One panel an error, one line a mesh, over bits; float32 with Woop as a tick at the right."""
    kinds = [
        ("depth_rms_steps21", "depth error, RMS, steps of 21 bits"), ("depth_rms_relative", "depth error, RMS, relative"),
        ("normal_rms_degrees", "normal error, RMS, degrees"), ("hausdorff_steps21", "Hausdorff, steps of 21 bits"),
        ("rmse", "image RMSE, linear"), ("flip", "image FLIP, mean"),
    ]
    figure, axes = plt.subplots(2, 3, figsize=(9.6, 5.6))
    figure.suptitle("Error against bits; at the right, float32 vertices with Woop's test", fontsize=9)
    for axis, (column, label) in zip(axes.flat, kinds):
        for colour, mesh in zip(MESH_COLOURS, meshes(rows)):
            exact = ours(rows, mesh)
            axis.plot([r["bits"] for r in exact], [r[column] for r in exact], "-o", color=colour, label=mesh,
                      markersize=3)
            axis.plot([26], [row(rows, mesh, "float32 Woop")[column]], "_", color=colour, markersize=12)
        axis.set_yscale("log")
        axis.set_title(label, fontsize=8.5, loc="left")
        bits = [r["bits"] for r in ours(rows, meshes(rows)[0])]
        axis.set_xticks(bits + [26])
        axis.set_xticklabels([f"{b:.0f}" for b in bits] + ["f32"])
    axes.flat[0].legend(fontsize=7)
    save(figure, "pareto-errors")


def plot_aimed(rows):
    """Rays at vertices and edges that miss, or meet two triangles, per million."""
    forms = ["float32 MT", "float32 Woop", "B 21 MT", "B 21 Woop", "B 10", "B 16", "B 21", "B 24"]
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3), sharey=True)
    figure.suptitle("Rays at vertices and edges, per million; a cross: none", fontsize=9)
    for axis, (column, label) in zip(
            axes, [("aimed_missed", "meet no triangle"), ("aimed_twice", "meet two or more"), ("leaks", "pass through the whole tracer")]):
        for k, mesh in enumerate(meshes(rows)):
            for i, form in enumerate(forms):
                r = row(rows, mesh, form)
                share = 1e6 * r[column] / r["aimed_rays"]
                place = i + (k - 2.5) * 0.12
                if share > 0:
                    axis.plot([place], [share], "o", color=MESH_COLOURS[k], markersize=4, label=mesh if i == 0 else None)
                else:
                    axis.plot([place], [1], "x", color=MESH_COLOURS[k], markersize=3)
        axis.set_yscale("log")
        axis.set_title(label, fontsize=8.5, loc="left")
        axis.set_xticks(range(len(forms)))
        axis.set_xticklabels(forms, rotation=40, ha="right")
    axes[0].legend(fontsize=6.5, loc="upper right")
    save(figure, "pareto-aimed")


def forms_of(rows):
    return list(dict.fromkeys(r["form"] for r in rows))


def errors_table(rows):
    heads = ["form", "`.nkd` B/tri", "of them vertices", "device B/tri", "wrong pixels, ppm", "depth RMS, steps of 21 bits",
             "own steps", "depth RMS, relative", "normal RMS, degrees", "RMSE", "FLIP", "Hausdorff, steps of 21 bits",
             "aimed: missed, ppm", "twice, ppm", "leaks, ppm"]
    out = []
    for form in forms_of(rows):
        own = [row(rows, m, form) for m in meshes(rows)]
        mean = lambda f: sum(map(f, own)) / len(own)
        gm = lambda column: geometric_mean([r[column] for r in own])
        ppm = lambda f: f"{1e6 * sum(map(f, own)) / sum(r['aimed_rays'] for r in own):.3g}"
        wrong = 1e6 * sum(r["missed"] + r["false"] + r["wrong_primitive"] for r in own) / sum(r["pixels"] for r in own)
        out.append([
            form, f"{mean(lambda r: r['file_bytes'] / r['triangles']):.1f}",
            f"{mean(lambda r: r['vertex_bytes'] / r['triangles']):.1f}",
            f"{mean(lambda r: r['device_bytes'] / r['triangles']):.1f}", f"{wrong:.3g}",
            f"{gm('depth_rms_steps21'):.3g}", f"{gm('depth_rms_steps'):.2g}", f"{gm('depth_rms_relative'):.2g}",
            f"{gm('normal_rms_degrees'):.2g}", f"{gm('rmse'):.2g}", f"{gm('flip'):.2g}", f"{gm('hausdorff_steps21'):.3g}",
            ppm(lambda r: r["aimed_missed"]), ppm(lambda r: r["aimed_twice"]), ppm(lambda r: r["leaks"])])
    return table(heads, out)


def depth_table(rows):
    heads = ["mesh", "B 21, steps", "float32 MT", "ratio", "float32 Woop", "ratio", "model-space MT", "ratio",
             "model-space Woop", "ratio"]
    out = []
    for mesh in meshes(rows):
        r = row(rows, mesh, "B 21")
        cells = [mesh, f"{r['depth_rms_steps21']:.3f}"]
        for other in [row(rows, mesh, "float32 MT")["depth_rms_steps21"], row(rows, mesh, "float32 Woop")["depth_rms_steps21"],
                      r["model_space_mt_depth_rms_steps21"], r["model_space_woop_depth_rms_steps21"]]:
            ratio = r["depth_rms_steps21"] / other
            cells += [f"{other:.3f}", f"**{ratio:.2f}**" if ratio <= 1.5 else f"{ratio:.2f}"]
        out.append(cells)
    return table(heads, out)


def speed_table(rows):
    """Each mesh's B 21 in Mrays/s, and forms over float32 with Woop as geometric means over meshes."""
    out = []
    for form in forms_of(rows):
        cells = [form]
        for rays in RAYS:
            ratio = geometric_mean([
                row(rows, m, form)[f"{rays}_mrays"] / row(rows, m, "float32 Woop")[f"{rays}_mrays"] for m in meshes(rows)])
            cells.append(f"{ratio:.3f}")
        out.append(cells)
    return table(["form", *RAYS], out)


def exactness_table(rows):
    out = []
    for mesh in meshes(rows):
        exact, mt, woop = (row(rows, mesh, f) for f in ("B 21", "B 21 MT", "B 21 Woop"))
        cells = [mesh]
        for rays in RAYS:
            cells.append(" / ".join(f"{r[f'{rays}_mrays']:.4g}" for r in (exact, mt, woop)))
        cells += [f"{exact[f'exact_to_mt_{rays}']:.3f}" for rays in RAYS]
        out.append(cells)
    means = [f"{geometric_mean([row(rows, m, 'B 21')[f'exact_to_mt_{rays}'] for m in meshes(rows)]):.3f}" for rays in RAYS]
    out.append(["geometric mean", "", "", "", *means])
    return table(["mesh", *[f"{rays}: exact / MT / Woop" for rays in RAYS], *[f"exact / MT, {rays}" for rays in RAYS]], out)


def main():
    by_device = {device: read(device) for device in ("cpu", "cuda")}
    rows = by_device["cuda"] or by_device["cpu"]
    if not rows:
        raise SystemExit("there is neither docs/pareto-cpu.csv nor docs/pareto-cuda.csv")
    for device, own in by_device.items():
        if not own:
            continue
        plot_against_depth(own, f"{own[0]['device']}: speed against depth error", f"pareto-speed-{device}",
                           [(f"{rays}, ", colour, lambda r, rays=rays: r[f"{rays}_mrays"])
                            for rays, colour in zip(RAYS, MESH_COLOURS)], "Mrays/s")
    plot_against_depth(rows, "Size of the .nkd against depth error", "pareto-bytes",
                       [("", MESH_COLOURS[0], lambda r: r["file_bytes"] / r["triangles"])], "bytes a triangle")
    plot_errors(rows)
    plot_aimed(rows)

    page = DOCS / "pareto.md"
    text = page.read_text()
    measured = f"{rows[0]['device']}, {rows[0]['width']:.0f} x {rows[0]['height']:.0f} pixels."
    text = fill(text, "errors", f"{measured}\n\n{errors_table(rows)}")
    text = fill(text, "depth", depth_table(rows))
    for device, own in by_device.items():
        body = "Not measured yet: run `kdbench pareto --device cuda --csv FILE.csv` on a GPU machine and give " \
               "`scripts/pareto.sh` the file."
        if own:
            size = f"{own[0]['width']:.0f} x {own[0]['height']:.0f}"
            body = (f"{own[0]['device']}, {size}. Mrays/s over those of float32 vertices with Woop's test, geometric means over "
                    f"the meshes:\n\n{speed_table(own)}\n\nWhat exactness costs, B = 21, Mrays/s; ratios are medians over "
                    f"the rounds:\n\n{exactness_table(own)}\n\n"
                    f"![Speed against depth error](pareto-speed-{device}.svg)")
        text = fill(text, f"speed-{device}", body)
    page.write_text(text)


main()
