# SPDX-License-Identifier: BSD-3-Clause
"""Table I: attempts, matches, closures and seconds of each mask, ours beside the paper's."""
import os
import sys

sys.path.insert(0, os.path.dirname(__file__))
from runs import (PAPER_TABLE1, STAGES, figure, median, read_all, save, spread,  # noqa: E402
                  write_csv)


def row_of(mask, motion, runs, timed):
    row = {"mask": mask, "motion": motion, "seeds": len(runs)}
    for count in ("scan_nodes", "attempted", "matched", "validated", "not_offered"):
        row[count] = median([run[count] for run in runs])
    for count in ("false", "true_pairs", "closed_pairs"):
        row[count] = sum(run[count] for run in runs)
    row["path_error_m"], row["path_error_min_m"], row["path_error_max_m"] = spread(
        [run["path_error_m"] for run in runs])
    row["trajectory_mean_m"] = median([run["trajectory_mean_m"] for run in runs])
    for run in timed:
        threads = run["threads"]
        row[f"stages_threads{threads}_s"] = run["stages_s"]
        row[f"total_threads{threads}_s"] = run["total_s"]
        row[f"cpu_threads{threads}_s"] = run["cpu_s"]
        if threads == 2:
            for stage in ["read", *STAGES, "rendering", "export"]:
                row[f"{stage}_s"] = run[f"{stage}_s"]
            row["timed_attempted"] = run["attempted"]
            row["peak_memory_mib"] = run["peak_memory_mib"]
        else:
            row["matching_threads1_s"] = run["matching_s"]
    paper = PAPER_TABLE1.get(mask)
    if paper:
        row.update(zip(("paper_attempted", "paper_matched", "paper_validated", "paper_s"), paper))
    return row


def draw(rows, masks, motion, path):
    drawing, (counts, seconds) = figure(columns=2, width=10.5, height=3.8)
    of_motion = {row["mask"]: row for row in rows if row["motion"] == motion}
    shown = [mask for mask in masks if mask != "never"]
    fills = [dict(color="#404040"), dict(color="#909090"), dict(color="#d8d8d8")]
    names = ["attempted", "matched", "validated"]
    width = 0.13
    for k, (name, fill) in enumerate(zip(names, fills)):
        at = [i + (k - 1) * width - 0.21 for i in range(len(shown))]
        counts.bar(at, [of_motion[mask][name] for mask in shown], width, label=name,
                   edgecolor="black", linewidth=0.6, **fill)
        theirs = [(i + (k - 1) * width + 0.21, PAPER_TABLE1[mask][k])
                  for i, mask in enumerate(shown) if mask in PAPER_TABLE1]
        counts.bar([x for x, _ in theirs], [y for _, y in theirs], width,
                   label=f"{name}, paper", edgecolor="black", linewidth=0.6, hatch="////", **fill)
    counts.set_xticks(range(len(shown)), shown)
    counts.set_xlim(-0.6, len(shown) - 0.4)
    counts.set_ylabel("pairs of scans")
    counts.legend(fontsize=8)

    bars = [(mask, source) for mask in masks
            for source in dict.fromkeys(row["motion"] for row in rows)]
    timed = {(row["mask"], row["motion"]) for row in rows if "motion_s" in row}
    bars = [bar for bar in bars if bar in timed]
    by_key = {(row["mask"], row["motion"]): row for row in rows}
    bottom = [0.0] * len(bars)
    greys = ["#1a1a1a", "#4d4d4d", "#808080", "#b3b3b3", "#d9d9d9", "#ffffff"]
    hatches = ["", "///", "", "...", "", "xxx"]
    for stage, grey, hatch in zip(STAGES, greys, hatches):
        heights = [by_key[bar][f"{stage}_s"] for bar in bars]
        seconds.bar(range(len(bars)), heights, 0.7, bottom=bottom, label=stage, color=grey,
                    hatch=hatch, edgecolor="black", linewidth=0.6)
        bottom = [low + height for low, height in zip(bottom, heights)]
    seconds.set_xticks(range(len(bars)), [f"{mask}, {source}" for mask, source in bars],
                       rotation=40, ha="right", fontsize=8)
    seconds.set_ylabel("seconds on two threads / s")
    seconds.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    save(drawing, path)


def main(snakemake):
    runs, timed = read_all(snakemake.input.runs), read_all(snakemake.input.timed)
    masks = list(snakemake.params.masks)
    motions = list(dict.fromkeys(run["motion"] for run in runs))

    def of(all_runs, mask, motion):
        return [run for run in all_runs if run["mask"] == mask and run["motion"] == motion]

    rows = [row_of(mask, motion, of(runs, mask, motion), of(timed, mask, motion))
            for motion in motions for mask in masks]
    # Work beside ours stretches wall times, not CPU; what a mask costs is what it adds to `never`.
    for row in rows:
        never = next(other for other in rows if (other["mask"], other["motion"]) ==
                     ("never", row["motion"]))
        row["cpu_s"] = row.get("cpu_threads1_s", row.get("cpu_threads2_s"))
        if row["mask"] != "never" and None not in (row["cpu_s"], never["cpu_s"]):
            row["cpu_over_never_s"] = row["cpu_s"] - never["cpu_s"]
    columns = list(dict.fromkeys(key for row in rows for key in row))
    write_csv(snakemake.output.csv, rows, columns)
    draw(rows, masks, snakemake.params.motion, snakemake.output.svg)


main(snakemake)  # noqa: F821
