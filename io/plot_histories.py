#!/usr/bin/env python3
"""Draws the displacement histories of runs, as `grandamp export DIR history` writes them, one below the other.

    plot_histories.py -o PICTURE.png [--title TEXT] LABEL=FILE.csv ...
"""
import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE")
    parser.add_argument("--title", default="")
    parser.add_argument("histories", nargs="+", metavar="LABEL=FILE.csv")
    arguments = parser.parse_args()

    figure, axes = plt.subplots(len(arguments.histories), 1, sharex=True, sharey=True, squeeze=False, figsize=(9, 6),
                                layout="constrained")
    for axis, item in zip(axes[:, 0], arguments.histories):
        label, _, name = item.partition("=")
        history = np.genfromtxt(name, delimiter=",", names=True)
        axis.plot(history["time"], 1e3 * history["displacement"], linewidth=0.5)
        axis.set_title(label, fontsize="medium")
        axis.set_ylabel("displacement (mm)")
        axis.grid(alpha=0.3)
    axes[-1, 0].set_xlabel("time (s)")
    axes[-1, 0].set_xlim(history["time"][0], history["time"][-1])
    figure.suptitle(arguments.title)
    figure.savefig(arguments.output, dpi=150)


if __name__ == "__main__":
    main()
