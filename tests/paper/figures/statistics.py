"""Means over seeds, their errors, and when two of them differ."""

import math

import numpy


class Mean:
    """Of several runs: mean, deviation of one run, number, standard error of the mean."""

    def __init__(self, values):
        self.values = numpy.asarray(list(values), float)
        self.number = len(self.values)
        self.mean = float(self.values.mean())
        self.deviation = float(self.values.std(ddof=1)) if self.number > 1 else math.nan
        self.error = self.deviation / math.sqrt(self.number)

    def text(self, digits, scale=1.0):
        return f"{scale * self.mean:.{digits}f} ± {scale * self.deviation:.{digits}f} ({self.number})"


def apart(a, b):
    """How many standard errors two means lie apart."""
    return abs(a.mean - b.mean) / math.hypot(a.error, b.error)


def apart_from(a, value, error=0.0):
    """The same of a mean and a value known to `error`."""
    return abs(a.mean - value) / math.hypot(a.error, error)


def pooled(means):
    """Deviation of one run, from all groups together; `means` by name."""
    spare = sum(m.number - 1 for m in means)
    return math.sqrt(sum((m.number - 1) * m.deviation ** 2 for m in means) / spare)


def apart_pooled(a, b, deviation):
    """As apart(), with one deviation for all runs: that of four runs alone is known to half of itself."""
    return abs(a.mean - b.mean) / (deviation * math.sqrt(1.0 / a.number + 1.0 / b.number))


def chance(groups, shuffles=20000, seed=1):
    """Share of random reassignments of the runs to the groups whose means spread at least as much as these do (the
    sum of squares between groups): near 0, the groups differ; otherwise chance alone does as much."""
    sizes = [len(g) for g in groups]
    values = numpy.concatenate([numpy.asarray(g, float) for g in groups])
    edges = numpy.cumsum([0, *sizes])

    def between(v):
        return sum(n * (v[a:b].mean() - v.mean()) ** 2 for n, a, b in zip(sizes, edges, edges[1:]))

    random, seen = numpy.random.default_rng(seed), between(values)
    hits = sum(between(random.permutation(values)) >= seen * (1.0 - 1e-12) for _ in range(shuffles))
    return (hits + 1) / (shuffles + 1)


def slope(x, groups):
    """Least-squares slope of all runs' values over x of their group, and its standard error."""
    xs = numpy.concatenate([numpy.full(len(g), float(v)) for v, g in zip(x, groups)])
    ys = numpy.concatenate([numpy.asarray(g, float) for g in groups])
    centred = xs - xs.mean()
    b = (centred @ ys) / (centred @ centred)
    rest = ys - ys.mean() - b * centred
    return b, math.sqrt(rest @ rest / (len(ys) - 2) / (centred @ centred))
