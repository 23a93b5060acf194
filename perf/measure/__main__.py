import sys

from . import accuracy, effects, kernels, lasting, paper, peers, radii, sizes, sweep, threads

{"kernels": kernels.main, "scenes": peers.scenes, "peers": peers.main, "sizes": sizes.main, "radii": radii.main, "threads": threads.main,
 "paper_table4": paper.table4, "paper_fig14": paper.fig14, "effects": effects.main, "checkpoint": lasting.checkpoint,
 "long_run": lasting.long_run, "accuracy": accuracy.accuracy, "sweep": sweep.main}[sys.argv[1]]()
