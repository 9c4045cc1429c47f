# SPDX-License-Identifier: BSD-3-Clause
"""Time, memory and attempts against the length of the tour, with the exponents of fitted powers."""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from runs import STAGES, figure, read_all, save, write_csv  # noqa: E402

LEAST_FITTED_M = 2000.0  # below it the constant cost of any run weighs
KM_TICKS = [0.5, 1, 2, 5, 10, 20]


def exponent(lengths, values):
    """Of the power of length that fits best, and its factor; None with fewer than two lengths."""
    chosen = [(length, value) for length, value in zip(lengths, values)
              if length >= LEAST_FITTED_M and value > 0]
    if len(chosen) < 2:
        return None
    slope, offset = np.polyfit(*np.log(np.array(chosen)).T, 1)
    return float(slope), float(np.exp(offset))


def panel(axes, km, values, label, look, fit):
    axes.plot(km, values, label=label, **look)
    if fit:
        line = np.array([LEAST_FITTED_M, 1000.0 * max(km)])
        axes.plot(line / 1000.0, fit[1] * line ** fit[0], color="black", linewidth=0.8,
                  linestyle="--", label=f"~ length$^{{{fit[0]:.2f}}}$")


def main(snakemake):
    rows = sorted(read_all(snakemake.input.runs), key=lambda row: row["path_driven_m"])
    lengths = [row["path_driven_m"] for row in rows]
    km = [length / 1000.0 for length in lengths]
    drawing, (times, memory, attempts) = figure(columns=3, width=10.5, height=3.6)
    fits = {name: exponent(lengths, [row[name] for row in rows])
            for name in ["cpu_s", "total_s", "stages_s", "attempted", "nodes", "peak_memory_mib",
                         *[f"{stage}_s" for stage in STAGES]]}
    panel(times, km, [row["cpu_s"] for row in rows], "CPU, whole run",
          dict(color="#003c30", marker="o", linestyle="-"), fits["cpu_s"])
    looks = [dict(marker=marker, linestyle=":", linewidth=1.0, markersize=4, color=grey)
             for marker, grey in zip("sv^Dx+", ["#222222", "#444444", "#666666", "#777777",
                                                "#888888", "#999999"])]
    for stage, look in zip(STAGES, looks):
        times.plot(km, [max(row[f"{stage}_s"], 1e-3) for row in rows], label=stage, **look)
    panel(memory, km, [row["peak_memory_mib"] for row in rows], "peak memory",
          dict(color="#003c30", marker="o", linestyle="-"), None)
    memory.axhline(1024, color="black", linewidth=0.8)
    memory.annotate("target 1 GiB", (0.02, 1024), xycoords=("axes fraction", "data"), va="bottom",
                    fontsize=8)
    panel(attempts, km, [row["attempted"] for row in rows], "attempted",
          dict(color="#003c30", marker="o", linestyle="-"), fits["attempted"])
    panel(attempts, km, [row["nodes"] for row in rows], "nodes",
          dict(color="#7570b3", marker="^", linestyle="-."), fits["nodes"])
    for axes in (times, attempts):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks(KM_TICKS)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("")
        axes.yaxis.set_major_formatter("{x:g}")
    for axes in (times, memory, attempts):
        axes.set_xlabel("length of the tour / km")
        axes.legend(fontsize=7)
    memory.set_ylim(bottom=0)
    times.set_ylabel("seconds on one thread / s")
    memory.set_ylabel("peak memory / MiB")
    attempts.set_ylabel("count")
    save(drawing, snakemake.output.svg)
    columns = ["log", "path_driven_m", "nodes", "attempted", "validated", "false", "cpu_s",
               "total_s", "stages_s", *[f"{stage}_s" for stage in STAGES], "rendering_s",
               "export_s", "peak_memory_mib", "path_error_m", "true_pairs", "closed_pairs"]
    fitted = {"log": f"exponent above {LEAST_FITTED_M:.0f} m"}
    fitted.update({name: fit[0] for name, fit in fits.items() if fit})
    write_csv(snakemake.output.csv, rows + [fitted], columns)


main(snakemake)  # noqa: F821
