# SPDX-License-Identifier: BSD-3-Clause
"""Figure 2: one floor of the campus before and after closures."""
import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from runs import figure, read, save, write_csv  # noqa: E402


def read_grid(folder, floor):
    """Image (row 0 on top) and its extent in metres."""
    with open(os.path.join(folder, "floors", floor + ".pgm"), "rb") as file:
        data = file.read()
    words, at = [], 0
    while len(words) < 4:
        end = at
        while data[end:end + 1] not in (b" ", b"\n", b"\t"):
            end += 1
        if data[at:at + 1] == b"#":
            at = data.index(b"\n", at) + 1
            continue
        if end > at:
            words.append(data[at:end])
        at = end + 1
    width, height = int(words[1]), int(words[2])
    image = np.frombuffer(data, dtype=np.uint8, count=width * height, offset=at)
    image = image.reshape(height, width)
    values = {}
    with open(os.path.join(folder, "floors", floor + ".yaml")) as file:
        for line in file:
            if ":" in line:
                key, value = line.split(":", 1)
                values[key.strip()] = value.strip()
    cell = float(values["resolution"])
    x, y = [float(word) for word in values["origin"].strip("[]").split(",")[:2]]
    return image, (x, x + width * cell, y, y + height * cell)


def read_nodes(folder):
    return np.loadtxt(os.path.join(folder, "nodes.tum"), usecols=(0, 1, 2, 3), ndmin=2)


def closures_of(folder, nodes):
    """Index pairs of validated closures."""
    index = {f"{stamp:.6f}": i for i, stamp in enumerate(nodes[:, 0])}
    pairs = []
    with open(os.path.join(folder, "closures.csv")) as file:
        next(file)
        for line in file:
            fields = line.split(",")
            if fields[9] == "validated":
                ends = [index.get(f"{float(field):.6f}") for field in fields[:2]]
                if None not in ends:
                    pairs.append(ends)
    return pairs


def elevation_of(folder, floor):
    with open(os.path.join(folder, "summary.json")) as file:
        return next(entry["elevation_m"] for entry in json.load(file)["floors"]
                    if entry["label"] == floor)


def main(snakemake):
    floor = snakemake.params.floor
    titles = {"before": "before: odometry alone",
              "after": "after: openings and closures"}
    drawing, panels = figure(columns=2, width=7.2, height=6.6, sharex=True, sharey=True)
    table = []
    for axes, when in zip(panels, titles):
        folder = snakemake.input[when]
        image, extent = read_grid(folder, floor)
        axes.grid(False)
        axes.imshow(np.where(image == 0, 60, np.where(image == 205, 255, 225)), cmap="gray",
                    vmin=0, vmax=255, extent=extent, interpolation="nearest")
        nodes = read_nodes(folder)
        here = np.abs(nodes[:, 3] - elevation_of(folder, floor)) < 1.0
        closures = [pair for pair in closures_of(folder, nodes) if here[pair[0]] and here[pair[1]]]
        axes.plot(nodes[here, 1], nodes[here, 2], ".", color="#2166ac", markersize=2.5,
                  label="nodes")
        # A closure joins nodes a metre apart; a ring shows where it is.
        ends = np.array([nodes[pair[0], 1:3] for pair in closures]).reshape(-1, 2)
        if len(ends):
            axes.plot(ends[:, 0], ends[:, 1], "o", color="#d95f02", markersize=5, fillstyle="none",
                      markeredgewidth=0.7, linestyle="none", label="validated closures")
        axes.set_title(titles[when], fontsize=10)
        axes.set_xlabel("x / m")
        axes.set_aspect("equal")
        run = read(snakemake.input[when + "_run"])
        table.append({"map": when, "mask": run["mask"], "motion": run["motion"],
                      "nodes": run["nodes"], "floor_nodes": int(here.sum()),
                      "floor_closures": len(closures), "path_error_m": run["path_error_m"],
                      "trajectory_mean_m": run["trajectory_mean_m"],
                      "width_m": extent[1] - extent[0], "height_m": extent[3] - extent[2]})
    panels[0].set_ylabel("y / m")
    handles, labels = panels[1].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="upper center", ncol=2,
                   bbox_to_anchor=(0.5, 0.03))
    save(drawing, snakemake.output.svg)
    write_csv(snakemake.output.csv, table)


main(snakemake)  # noqa: F821
