# SPDX-License-Identifier: BSD-3-Clause
"""The real logs: relations, attempts, closures, and path lengths held against the shortest of the
maps that are free of false closures."""
import json
import os
import sys

sys.path.insert(0, os.path.dirname(__file__))
from runs import figure, look_of, read, save, write_csv  # noqa: E402


def row_of(path, errors, checked):
    run = read(path)
    log = path.split("/")[-2]
    relations = run["evaluation"].get("relations", {})
    error = errors.get(path, {})
    return {**run, "log": log, "score": 100.0 * float(run["settings"]["matcher.min_score"]),
            "relations_m": relations.get("translation_m", {}).get("mean"),
            "relations_deg": relations.get("rotation_deg", {}).get("mean"),
            "checked_map": int(path in checked), "path_error_m": error.get("mean_m"),
            "path_missing_m": error.get("missing_m"), "path_false_m": error.get("false_m")}


def draw(rows, masks, score, path):
    logs = list(dict.fromkeys(row["log"] for row in rows))
    drawing, (attempts, errors) = figure(columns=2, width=9.6, height=3.6)
    shown = [row for row in rows if abs(row["score"] - score) < 1e-6]
    for mask in masks:
        of_mask = {row["log"]: row for row in shown if row["mask"] == mask}
        at = [i for i, log in enumerate(logs) if log in of_mask]
        look = dict(look_of(mask, masks), linestyle="none", markersize=8, fillstyle="none",
                    label=mask)
        attempts.plot(at, [of_mask[logs[i]]["attempted"] for i in at], **look)
        known = [i for i in at if of_mask[logs[i]]["path_error_m"] is not None]
        errors.plot(known, [max(of_mask[logs[i]]["path_error_m"], 1e-3) for i in known], **look)
    for axes in (attempts, errors):
        axes.set_xticks(range(len(logs)), logs)
        axes.set_xlim(-0.5, len(logs) - 0.5)
        axes.legend(fontsize=8)
    attempts.set_ylabel("attempted matches")
    errors.set_ylabel("mean path-length error / m")
    errors.set_yscale("log")
    errors.yaxis.set_major_formatter("{x:g}")
    save(drawing, path)


def main(snakemake):
    errors, checked = {}, set()
    for path in snakemake.input.paths:
        with open(path) as file:
            measured = json.load(file)
        errors.update(measured["errors"])
        checked.update(measured["checked"])
    rows = [row_of(path, errors, checked) for path in snakemake.input.runs]
    write_csv(snakemake.output.csv, rows,
              ["log", "mask", "score", "scan_nodes", "attempted", "matched", "validated", "checked",
               "false", "checked_map", "true_pairs", "closed_pairs", "path_error_m",
               "path_missing_m", "path_false_m", "relations_m", "relations_deg", "stages_s",
               "total_s", "cpu_s"])
    draw(rows, list(snakemake.params.masks), snakemake.params.score, snakemake.output.svg)


main(snakemake)  # noqa: F821
