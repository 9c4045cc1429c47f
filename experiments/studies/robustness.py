# SPDX-License-Identifier: BSD-3-Clause
"""Random buildings: false closures, loops missed, path error and time of each mask."""
import os
import sys

sys.path.insert(0, os.path.dirname(__file__))
from runs import figure, look_of, median, read_all, save, write_csv  # noqa: E402


def draw(rows, masks, motion, path):
    drawing, (errors, recalls, times) = figure(columns=3, width=10.5, height=3.6)
    for mask in masks:
        runs = [row for row in rows if row["mask"] == mask and row["motion"] == motion]
        look = {**look_of(mask), "markevery": max(1, len(runs) // 10)}
        shares = [100.0 * (i + 1) / len(runs) for i in range(len(runs))]
        errors.step(sorted(max(row["path_error_m"], 1e-3) for row in runs), shares, where="post",
                    label=mask, **look)
        times.step(sorted(row["cpu_s"] for row in runs), shares, where="post", label=mask, **look)
        recall = sorted(100.0 * row["closed_pairs"] / row["true_pairs"] for row in runs
                        if row["true_pairs"])
        recalls.step(recall, [100.0 * (i + 1) / len(recall) for i in range(len(recall))],
                     where="post", label=mask, **look)
    errors.set_xscale("log")
    errors.xaxis.set_major_formatter("{x:g}")
    errors.set_xlabel("mean path-length error / m")
    recalls.set_xlabel("true loops closed / %")
    times.set_xlabel("CPU time of a run / s")
    errors.set_ylabel("share of buildings / %")
    for axes in (errors, recalls, times):
        axes.set_ylim(0, 101)
        axes.legend(fontsize=8)
    save(drawing, path)


def main(snakemake):
    rows = read_all(snakemake.input.runs)
    masks = list(dict.fromkeys(row["mask"] for row in rows))
    columns = ["mask", "motion", "log", "path_driven_m", "attempted", "matched", "validated", "not_offered",
               "false", "true_pairs", "closed_pairs", "path_error_m", "path_missing_m", "path_false_m",
               "trajectory_mean_m", "floors_right", "cpu_s"]
    write_csv(snakemake.output.csv, rows, columns)
    draw(rows, masks, snakemake.params.motion, snakemake.output.svg)


main(snakemake)  # noqa: F821
