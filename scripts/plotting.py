"""What the plot scripts share: the look of figures, small SVG files, tables, and pages with places for them."""

import io
import pathlib
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"

plt.rcParams.update({
    "svg.fonttype": "none", "font.sans-serif": ["DejaVu Sans"], "svg.hashsalt": "kdtrace", "font.size": 8, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.5,
    "legend.frameon": False, "lines.linewidth": 1.2, "lines.markersize": 4.5,
})


def slim(svg):
    """Half the bytes: two decimals, a style a class, no indentation."""
    svg = re.sub(r"(\d\.\d\d)\d+", r"\1", svg)
    svg = re.sub(r' transform="rotate\(-0 [^"]*"| clip-path="[^"]*"', "", svg)
    svg = re.sub(r"\s*\n\s*", "\n", svg)
    styles = {}
    def shared(match):
        return f'class="s{styles.setdefault(match.group(1), len(styles))}"'
    svg = re.sub(r'style="([^"]*)"', shared, svg)
    rules = "\n".join(f".s{number} {{{style}}}" for style, number in styles.items())
    return svg.replace("</style>", rules + "\n</style>", 1)


def save(figure, name, bottom=0):
    """To docs/NAME.svg, and as a PNG twin to look at to out/, to the folder that NAME begins with."""
    for axis in figure.axes:
        axis.minorticks_off()
    figure.tight_layout(rect=(0, bottom, 1, 1))
    drawing = io.StringIO()
    figure.savefig(drawing, format="svg", metadata={"Date": None})
    (DOCS / f"{name}.svg").write_text(slim(drawing.getvalue()))
    pictures = ROOT / "out" / name.split("-")[0]
    pictures.mkdir(parents=True, exist_ok=True)
    figure.savefig(pictures / f"{name}.png", dpi=110, metadata={"Software": None})
    plt.close(figure)


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows])


def fill(text, name, body):
    """The text with what stands between the markers of `name` replaced."""
    pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)", re.S)
    if not pattern.search(text):
        raise SystemExit(f"the page has no place for {name}")
    return pattern.sub(lambda m: m.group(1) + "\n" + body + "\n\n" + m.group(2), text)
