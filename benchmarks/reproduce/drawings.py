"""Drawings of the method: its steps (the paper's Figure 3) and the Lap-line descriptor (4)."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from figures import BLACK, BLUE, GREY, ORANGE, RED, SKY

BOXES = (
    ("pose graph", "odometry and loop closures"),
    ("initialisation", "a weight a loop: χ² against odometry,\nor how alike the paths are (Lap-line)"),
    ("induced graph", "weighted, undirected: odometry 1,\nloops close to 0; Laplacian L = D − W"),
    ("heat distance of every loop", "D(t) = (e_i − e_j)' exp(−tL) (e_i − e_j)"),
    ("threshold", "prune where D > μ + konst · σ"),
    ("pruned pose graph", "optimised, with or without a robust kernel"),
)
FIRST_IN_LOOP, LAST_IN_LOOP = 3, 4


def draw_overview(figures):
    """Figure 3: from a pose graph to a pruned one."""
    figure, axis = plt.subplots(figsize=(7.5, 6.6), constrained_layout=True)
    height, width, step = 0.74, 5.0, 1.1
    for k, (title, text) in enumerate(BOXES):
        middle = -k * step
        colour = SKY if FIRST_IN_LOOP <= k <= LAST_IN_LOOP else "#dddddd"
        axis.add_patch(matplotlib.patches.FancyBboxPatch(
            (-width / 2, middle - height / 2), width, height, boxstyle="round,pad=0.03",
            facecolor=colour, edgecolor=BLACK, linewidth=0.8, alpha=0.6))
        axis.text(0, middle + 0.2, title, ha="center", va="center", weight="bold", fontsize=10)
        axis.text(0, middle - 0.13, text, ha="center", va="center", fontsize=8.5)
        if k > 0:
            axis.annotate("", (0, middle + height / 2 + 0.04), (0, middle + step - height / 2 - 0.04),
                          arrowprops={"arrowstyle": "->"})
    top, bottom = -FIRST_IN_LOOP * step, -LAST_IN_LOOP * step
    side = width / 2 + 0.05
    axis.annotate("", (side, top), (side, bottom), arrowprops={
        "arrowstyle": "->", "connectionstyle": "bar,fraction=0.35"})
    axis.text(side + 0.6, (top + bottom) / 2, "next smaller scale t,\nin the graph that is left",
              va="center", fontsize=8.5)
    axis.set_xlim(-width / 2 - 0.2, width / 2 + 3.0)
    axis.set_ylim(-(len(BOXES) - 1) * step - 0.55, 0.55)
    axis.set_axis_off()
    figures.save(figure, "figure3-overview")


class Path:
    """A polyline by arc length."""

    def __init__(self, points):
        self.points = points
        self.arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]

    def at(self, arc):
        return np.array([np.interp(arc, self.arc, column) for column in self.points.T])


def window(path, middle, interval, longest=30, turn=np.pi / 2):
    """Half of the window, in intervals: until 30 L are full or the path would turn too far."""
    half = 0
    while 2 * (half + 1) <= longest:
        arcs = middle + interval * np.arange(-half - 1, half + 2)
        chords = np.diff([path.at(arc) for arc in arcs], axis=0)
        headings = np.unwrap(np.arctan2(chords[:, 1], chords[:, 0]))
        if headings.max() - headings.min() > turn:
            break
        half += 1
    return half


def crossing(path, middle, half, interval, base, normal):
    """Where the perpendicular through `base` meets the path: the descriptor's entry there."""
    arcs = np.linspace(middle - half * interval, middle + half * interval, 4001)
    along = np.array([path.at(arc) for arc in arcs]) - base
    direction = np.array([normal[1], -normal[0]])
    nearest = np.argmin(np.abs(along @ direction))
    return normal @ along[nearest]


def draw_lap_line(figures, sequence="00", vertex=116):
    """Figure 4: the descriptor of a vertex on a bend of KITTI 00."""
    rows = figures.graphs.data / "paper" / "kitti" / f"poses_{sequence}.txt"
    camera = np.loadtxt(rows)[:, 1:].reshape(-1, 3, 4)
    path = Path(np.column_stack([camera[:, 2, 3], -camera[:, 0, 3]]))
    interval = path.arc[-1] / (len(path.points) - 1)
    middle = path.arc[vertex]
    half = window(path, middle, interval)
    ends = [path.at(middle + side * half * interval) for side in (-1, 1)]
    point = path.at(middle)
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    normal = np.array([-along[1], along[0]])
    reach = [int(abs((end - point) @ along) / interval) for end in ends]

    figure, axis = plt.subplots(figsize=(8, 4.5), constrained_layout=True)
    shown = [path.at(arc) for arc in middle + interval * np.linspace(-1.5 * half, 1.5 * half, 400)]
    axis.plot(*np.array(shown).T, color=GREY, linewidth=1.2, label="path")
    stations = [point + k * interval * along for k in range(-reach[0], reach[1] + 1)]
    axis.plot(*np.array(stations).T, ".", color=BLACK, markersize=4,
              label="line ℓ, a station every interval L")
    for k, base in enumerate(stations):
        offset = crossing(path, middle, half, interval, base, normal)
        axis.plot(*np.array([base, base + offset * normal]).T, color=BLUE, linewidth=1.2,
                  label="descriptor: signed offsets" if k == 0 else None)
        axis.plot(*(base + offset * normal), "o", color=BLUE, markersize=3)
    axis.plot(*np.array(ends).T, "s", color=ORANGE, label="ends of the window, v_b and v_f")
    axis.plot(*point, "o", color=RED, label="vertex v")
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_xlabel("x [m]")
    axis.set_ylabel("y [m]")
    axis.legend(fontsize=8)
    axis.set_title(f"KITTI {sequence}, vertex {vertex}: 2 · {half} intervals of {interval:.2f} m")
    figures.save(figure, "figure4-lap-line")
