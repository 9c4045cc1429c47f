# SPDX-License-Identifier: BSD-3-Clause
"""Figures 3, 4 and 5: something of the map against one parameter, for each mask: the median over
the seeds, and a band from the least to the greatest."""
import os
import sys

sys.path.insert(0, os.path.dirname(__file__))
from runs import figure, look_of, median, read_all, save, spread, write_csv  # noqa: E402

LABELS = {
    "matcher.min_score": "MinScore / %",
    "candidates.max_mahalanobis": "MaxMaha",
    "path_error_m": "mean path-length error / m",
    "attempted": "attempted matches",
}


def main(snakemake):
    x_key, y_key = snakemake.params.x, snakemake.params.y
    scale = 100.0 if x_key == "matcher.min_score" else 1.0
    rows = read_all(snakemake.input.runs)
    for row in rows:
        row["x"] = float(row["settings"][x_key]) * scale
    masks = list(dict.fromkeys(row["mask"] for row in rows))
    table = []
    drawing, axes = figure()
    for mask in masks:
        xs = sorted({row["x"] for row in rows if row["mask"] == mask})
        points = []
        for x in xs:
            here = [row for row in rows if row["mask"] == mask and row["x"] == x]
            middle, least, greatest = spread([row[y_key] for row in here])
            points.append((middle, least, greatest))
            table.append({
                "mask": mask, "x": x, "seeds": len(here), f"{y_key}_median": middle,
                f"{y_key}_min": least, f"{y_key}_max": greatest,
                "false_closures": sum(row["false"] for row in here),
                "validated": median([row["validated"] for row in here]),
                "recall": sum(row["closed_pairs"] for row in here) /
                max(1, sum(row["true_pairs"] for row in here)),
            })
        look = look_of(mask)
        axes.plot(xs, [point[0] for point in points], label=mask, **look)
        axes.fill_between(xs, [point[1] for point in points], [point[2] for point in points],
                          color=look["color"], alpha=0.15, linewidth=0)
    axes.set_xlabel(LABELS[x_key])
    axes.set_ylabel(LABELS[y_key])
    if y_key == "path_error_m":
        never = median([row[y_key] for row in read_all(snakemake.input.never)])
        if never is not None:
            table.append({"mask": "never", "seeds": len(snakemake.input.never),
                          f"{y_key}_median": never})
            axes.axhline(never, label="never (no closures)", color="#888888", linestyle=":")
        axes.axhline(0.5, color="black", linewidth=0.8)
        axes.annotate("target 0.5 m", (1.0, 0.5), xycoords=("axes fraction", "data"),
                      ha="right", va="bottom", fontsize=8)
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
    else:
        axes.set_ylim(bottom=0)
    axes.legend(loc="best")
    save(drawing, snakemake.output.svg)
    write_csv(snakemake.output.csv, table,
              ["mask", "x", "seeds", f"{y_key}_median", f"{y_key}_min", f"{y_key}_max",
               "validated", "false_closures", "recall"])


main(snakemake)  # noqa: F821
