// Charts of few points: lines and dots with bars of error, or bars, by Chart.js.
"use strict";
grandamp.charts = (() => {
  const made = [];

  /** Bars of error, beneath the dots. */
  const error_bars = {
    id: "error_bars",
    beforeDatasetsDraw(chart) { if (chart.config.type !== "bar") error_bars.draw(chart); },
    afterDatasetsDraw(chart) { if (chart.config.type === "bar") error_bars.draw(chart); },
    draw(chart) {
      const context = chart.ctx, bars = chart.config.type === "bar";
      chart.data.datasets.forEach((set, index) => {
        if (!chart.isDatasetVisible(index)) return;
        context.strokeStyle = bars ? grandamp.style("ink") : set.borderColor;
        context.lineWidth = 1;
        for (const [k, point] of set.points.entries()) {
          if (point.low === null) continue;
          const x = chart.scales.x.getPixelForValue(bars ? k : point.x);
          const low = chart.scales.y.getPixelForValue(Math.max(point.low, chart.scales.y.min)), high = chart.scales.y.getPixelForValue(point.high);
          context.beginPath();
          context.moveTo(x, low); context.lineTo(x, high);
          context.moveTo(x - 4, high); context.lineTo(x + 4, high);
          context.moveTo(x - 4, low); context.lineTo(x + 4, low);
          context.stroke();
        }
      });
    },
  };

  /** A range of x, shaded. */
  const band = {
    id: "band",
    beforeDraw(chart, ignored, range) {
      if (!range || range.from === undefined) return;
      const { left, right, top, bottom } = chart.chartArea;
      const from = Math.max(left, chart.scales.x.getPixelForValue(range.from)), to = Math.min(right, chart.scales.x.getPixelForValue(range.to));
      chart.ctx.fillStyle = grandamp.style("band");
      if (to > from) chart.ctx.fillRect(from, top, to - from, bottom - top);
    },
  };

  /** Names beside points, left out where one would lie on another. */
  const names = {
    id: "names",
    afterDatasetsDraw(chart) {
      const context = chart.ctx, taken = [];
      context.font = "11px system-ui, sans-serif";
      context.fillStyle = grandamp.style("soft");
      context.textAlign = "left";
      chart.data.datasets.forEach((set, index) => {
        if (!chart.isDatasetVisible(index)) return;
        chart.getDatasetMeta(index).data.forEach((mark, k) => {
          const name = set.names && set.names[k];
          if (!name) return;
          const long = context.measureText(name).width, bar = chart.config.type === "bar";
          const x = bar ? mark.x - long / 2 : mark.x + 6, y = mark.y - 6;
          if (x + long > chart.width || taken.some(one => x < one.to && one.from < x + long && Math.abs(y - one.y) < 11)) return;
          taken.push({ from: x, to: x + long, y });
          context.fillText(name, x, y);
        });
      });
    },
  };

  function axis(facts, room) {
    const ink = grandamp.style("soft"), short = value => String(Number(Number(value).toPrecision(4)));
    return { type: facts.logarithmic ? "logarithmic" : "linear", beginAtZero: facts.from_zero && !facts.logarithmic, grace: facts.logarithmic ? 0 : room,
      title: { display: facts.name !== "", text: facts.name, color: ink }, grid: { color: grandamp.style("grid"), borderColor: grandamp.style("line") },
      ticks: { color: ink, maxRotation: 0, autoSkipPadding: 12, callback(value) {
        if (!facts.logarithmic) return short(value);
        const leading = value / 10 ** Math.floor(Math.log10(value) + 1e-9);
        return [1, 2, 5].some(one => Math.abs(leading - one) < 1e-6) ? short(value) : "";
      } } };
  }

  /** What an axis must show: points, and whole bars of error; a little room around them where it is logarithmic. */
  function reach(facts, which) {
    const all = [];
    for (const series of facts.series)
      for (const [x, y, low, high] of series.points) {
        if (which === "x") all.push(x);
        else all.push(y, ...(high === null ? [] : [low, high]));
      }
    const shown = all.filter(value => isFinite(value) && (value > 0 || !facts[which].logarithmic));
    if (shown.length === 0) return {};
    const least = Math.min(...shown), greatest = Math.max(...shown);
    return facts[which].logarithmic ? { min: least / 1.15, max: greatest * 1.15 } : { suggestedMin: least, suggestedMax: greatest };
  }

  function data_set(series, bars, order) {
    const colour = grandamp.colour(series.colour);
    const points = series.points.map(([x, y, low, high]) => ({ x, y, low, high }));
    return { label: series.name, data: bars ? points.map(point => point.y) : points, points, names: series.points.map(point => point[4]), borderColor: colour,
      backgroundColor: series.hollow ? grandamp.style("card") : colour, pointBackgroundColor: series.hollow ? grandamp.style("card") : colour, showLine: series.line,
      borderWidth: bars ? 0 : series.width, pointRadius: series.dots ? (points.length > 150 ? 1.5 : 3.5) : 0, pointHoverRadius: 6, pointHitRadius: 8,
      maxBarThickness: 70, order };
  }

  function tip(item) {
    const set = item.dataset, point = set.data[item.dataIndex], name = set.names[item.dataIndex];
    if (typeof point === "number") return `${Number(point.toPrecision(4))} ${name ? "(" + name + ")" : ""}`;
    const bar = point.low === null ? "" : `, ${Number(point.low.toPrecision(4))} to ${Number(point.high.toPrecision(4))}`;
    return `${set.label}${name ? " " + name : ""}: ${Number(point.x.toPrecision(6))}; ${Number(point.y.toPrecision(5))}${bar}`;
  }

  function configuration(facts) {
    const bars = facts.categories !== undefined, named = facts.series.filter(series => series.name !== "").length > 1;
    return { type: bars ? "bar" : "scatter", data: { labels: facts.categories, datasets: facts.series.map((series, k) => data_set(series, bars, -k)) }, // the last on top
      plugins: [band, error_bars, names],
      options: { animation: false, responsive: true, maintainAspectRatio: false, layout: { padding: { top: bars ? 16 : 4, right: 12 } },
        interaction: { mode: "nearest", intersect: true },
        scales: { x: bars ? { grid: { display: false }, ticks: { color: grandamp.style("soft") }, title: { display: facts.x.name !== "", text: facts.x.name, color: grandamp.style("soft") } } : Object.assign(axis(facts.x, 0), reach(facts, "x")),
          y: Object.assign(axis(facts.y, "5%"), reach(facts, "y")) },
        plugins: { band: facts.band ? { from: facts.band[0], to: facts.band[1] } : {},
          legend: { display: named, labels: { color: grandamp.style("ink"), usePointStyle: true, boxHeight: 7, filter: item => item.text !== "", sort: (a, b) => a.datasetIndex - b.datasetIndex } },
          tooltip: { callbacks: { title: () => "", label: tip } } } } };
  }

  for (const figure of grandamp.figures("chart")) {
    const canvas = grandamp.element("canvas", { role: "img", "aria-label": figure.title + "; numbers below" });
    figure.live.append(grandamp.element("div", { class: "chart" }, canvas));
    grandamp.when_near(figure.element, () => {
      let chart = new Chart(canvas, configuration(figure.facts));
      made.push(figure.element.id);
      grandamp.redraws.push(() => {
        chart.destroy();
        chart = new Chart(canvas, configuration(figure.facts));
      });
    });
  }
  return { made };
})();
