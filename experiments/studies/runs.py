# SPDX-License-Identifier: BSD-3-Clause
"""The runs of a study as rows of plain values, and how all figures look."""
import csv
import json
import os
import statistics

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

STAGES = ["motion", "mask", "projection", "matching", "validation", "optimisation"]  # the paper's

# Told apart by dash and marker, not by colour alone; the colours differ in lightness.
LOOKS = {
    "always": dict(color="#d95f02", marker="s", linestyle="--"),
    "eccentricity": dict(color="#7570b3", marker="^", linestyle="-."),
    "openings": dict(color="#003c30", marker="o", linestyle="-"),
    "never": dict(color="#888888", marker="x", linestyle=":"),
}
SPARE_LOOKS = [dict(color="#66a61e", marker="D", linestyle=(0, (5, 1, 1, 1, 1, 1))),
               dict(color="#a6761d", marker="v", linestyle=(0, (1, 1)))]
PAPER_TABLE1 = {  # attempted, matched, validated, seconds
    "always": (5353, 4437, 3833, 195),
    "eccentricity": (1172, 860, 627, 50),
    "openings": (974, 760, 637, 46),
}


def look_of(mask, masks=()):
    if mask in LOOKS:
        return LOOKS[mask]
    spare = [name for name in masks if name not in LOOKS]
    return SPARE_LOOKS[spare.index(mask) % len(SPARE_LOOKS) if mask in spare else 0]


def read(path):
    """One run, flat. `mask`, `motion`, `score` and `maha` are those of the file's name."""
    with open(path) as file:
        run = json.load(file)
    mask, motion = os.path.basename(path).split(".")[:2]
    evaluation = run["evaluation"]
    closures = evaluation.get("closures", {})
    path_length = evaluation.get("path_length", {})
    settings = dict(setting.split("=", 1) for setting in run["settings"])
    seconds = run["seconds"]
    row = {
        "log": os.path.basename(os.path.dirname(path)),
        "mask": mask,
        "motion": motion,
        "threads": run["threads"],
        "path_driven_m": run["path_driven_m"],
        "duration_s": run["duration_s"],
        "nodes": run["counts"]["nodes"],
        "scan_nodes": run["counts"]["scan_nodes"],
        "attempted": run["counts"]["attempted"],
        "matched": run["counts"]["matched"],
        "validated": run["counts"]["validated"],
        "not_offered": run["counts"]["not_offered"],
        "false": closures.get("false"),
        "checked": closures.get("checked"),
        "true_pairs": closures.get("true_pairs"),
        "closed_pairs": closures.get("closed_pairs"),
        "path_error_m": path_length.get("mean_m"),
        "path_missing_m": path_length.get("missing_m"),
        "path_false_m": path_length.get("false_m"),
        "trajectory_mean_m": evaluation.get("trajectory", {}).get("mean_m"),
        "floors_right": evaluation.get("floors", {}).get("right"),
        "cpu_s": run["cpu_s"],
        "peak_memory_mib": run["peak_memory_mib"],
        "stages_s": round(sum(seconds[stage] for stage in STAGES), 4),
        "total_s": seconds["total"],
        "program": run["program"],
    }
    row.update({f"{stage}_s": seconds[stage] for stage in
                ["read", *STAGES, "rendering", "export"]})
    row["settings"] = settings
    row["evaluation"] = evaluation
    return row


def read_all(paths):
    return [read(path) for path in paths]


def median(values):
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else None


def spread(values):
    """Median, least and greatest; None thrice when there is nothing."""
    values = [value for value in values if value is not None]
    return (statistics.median(values), min(values), max(values)) if values else (None, None, None)


def write_csv(path, rows, columns=None):
    columns = columns or list(rows[0])

    def text(value):
        if isinstance(value, float):
            return f"{value:.6g}"
        return "" if value is None else value

    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in rows:
            writer.writerow([text(row.get(column)) for column in columns])


def figure(columns=1, rows=1, width=6.4, height=4.0, **options):
    plt.rcParams.update({
        "font.size": 10, "font.family": "sans-serif", "axes.grid": True, "grid.color": "#dddddd",
        "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False,
        "legend.frameon": False, "svg.fonttype": "none", "svg.hashsalt": "masked_mapper",
        "lines.linewidth": 1.6, "lines.markersize": 5,
    })
    return plt.subplots(rows, columns, figsize=(width, height), constrained_layout=True, **options)


def save(drawing, path):
    """As SVG, and beside it as PNG for a quick look."""
    drawing.savefig(os.path.splitext(path)[0] + ".png", dpi=120, bbox_inches="tight")
    drawing.savefig(path, bbox_inches="tight",
                    metadata={"Date": None, "Creator": "masked_mapper experiments"})
    plt.close(drawing)
