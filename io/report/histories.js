// Histories: dygraphs over one time axis. A chart is given only the rows that its window can show, with none of the peaks
// left out, and finer ones as one zooms in.
"use strict";
grandamp.histories = (() => {
  const shape = grandamp.report.histories;
  const time = grandamp.data("time", Float64Array), values = grandamp.data("histories", Float32Array);
  const whole = [time[0], time[time.length - 1]];
  const most_rows = 2400, charts = [];
  let range = whole;

  /** The first row at or after `t`. */
  function row_at(t) {
    let low = 0, high = time.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time[middle] < t) low = middle + 1; else high = middle;
    }
    return low;
  }

  /** [time, value, ...] of the rows in the range and one beyond each end; of many, the least and the greatest of each few. */
  function rows_in(lines, factor, [from, to]) {
    const first = Math.max(0, row_at(from) - 1), last = Math.min(time.length, row_at(to) + 2);
    const columns = lines.map(line => values.subarray(line.column * shape.rows, (line.column + 1) * shape.rows));
    const rows = [], count = last - first;
    if (count <= most_rows) {
      for (let k = first; k < last; ++k) rows.push([time[k], ...columns.map(column => column[k] * factor)]);
      return rows;
    }
    const buckets = most_rows / 2;
    for (let bucket = 0; bucket < buckets; ++bucket) {
      const begin = first + Math.floor(bucket * count / buckets), end = first + Math.floor((bucket + 1) * count / buckets);
      const one = [time[begin]], two = [time[end - 1]];
      for (const column of columns) {
        let low = begin, high = begin;
        for (let k = begin + 1; k < end; ++k) {
          if (column[k] < column[low]) low = k;
          if (column[k] > column[high]) high = k;
        }
        one.push(column[Math.min(low, high)] * factor);
        two.push(column[Math.max(low, high)] * factor);
      }
      rows.push(one, two);
    }
    return rows;
  }

  function shade(context, area, graph, band) {
    if (!band) return;
    const from = Math.max(area.x, graph.toDomXCoord(band[0])), to = Math.min(area.x + area.w, graph.toDomXCoord(band[1]));
    if (!(to > from)) return;
    context.fillStyle = grandamp.style("band");
    context.fillRect(from, area.y, to - from, area.h);
  }

  function interaction() {
    const model = Object.assign({}, Dygraph.defaultInteractionModel);
    model.dblclick = () => show(whole);
    // A finger on a chart scrolls the page; the buttons zoom.
    for (const event of ["touchstart", "touchmove", "touchend"]) delete model[event];
    return model;
  }

  class History {
    constructor(figure) {
      Object.assign(this, figure);
      this.seen = this.stale = false;
      this.legend = grandamp.element("div", { class: "legend" });
      this.ground = grandamp.element("div", { class: "dygraph", role: "img", "aria-label": this.title + "; numbers below" });
      this.live.append(this.legend, this.ground);
      new IntersectionObserver(entries => {
        this.seen = entries[entries.length - 1].isIntersecting;
        if (this.seen) this.refresh();
      }, { rootMargin: "300px" }).observe(this.element);
    }

    tell(data) {
      const step = (range[1] - range[0]) / 1000, shown = [];
      if (data.x !== undefined) shown.push(grandamp.element("span", {}, grandamp.digits(data.x, step) + " s"));
      for (const [k, line] of this.facts.lines.entries()) {
        const value = data.series[k] && data.series[k].y;
        if (this.facts.lines.length === 1 && data.x === undefined) continue; // the title says it
        const text = value === undefined || value === null ? "" : " " + Number(value.toPrecision(5)) + " " + this.facts.unit;
        const mark = this.facts.lines.length > 1 ? [grandamp.element("i", { style: "background:" + grandamp.colour(line.colour) })] : [];
        shown.push(grandamp.element("span", {}, ...mark, line.name + text));
      }
      this.legend.replaceChildren(...shown);
      return "";
    }

    options() {
      return { dateWindow: range, colors: this.facts.lines.map(line => grandamp.colour(line.colour)),
        axisLineColor: grandamp.style("line"), gridLineColor: grandamp.style("grid") };
    }

    draw() {
      const { lines, factor, stacked, quantity, band } = this.facts;
      this.graph = new Dygraph(this.ground, rows_in(lines, factor, range), Object.assign(this.options(), {
        labels: ["time, s", ...lines.map(line => line.name)], stackedGraph: stacked, fillAlpha: stacked ? 0.75 : 0.15, strokeWidth: stacked ? 0.5 : 1.1,
        legend: "always", legendFormatter: data => this.tell(data), labelsDiv: document.createElement("div"), ylabel: quantity, yLabelWidth: 16,
        xlabel: "time, s", xLabelHeight: 16, axisLabelFontSize: 12, rightGap: 12, highlightCircleSize: 3, includeZero: stacked,
        axes: { x: { axisLabelFormatter: t => grandamp.digits(t, (range[1] - range[0]) / 20), pixelsPerLabel: 70 },
          y: { axisLabelWidth: 56, axisLabelFormatter: v => String(Number(v.toPrecision(4))) } },
        interactionModel: interaction(), underlayCallback: (context, area, graph) => shade(context, area, graph, band),
        zoomCallback: (from, to) => show([from, to]),
        drawCallback: (graph, first) => { // dragged with the shift key
          const [from, to] = graph.xAxisRange();
          if (!first && !this.updating && (Math.abs(from - range[0]) + Math.abs(to - range[1])) > 1e-9 * (whole[1] - whole[0])) show([from, to]);
        },
      }));
      this.stale = false;
    }

    refresh() {
      if (!this.graph) return this.draw();
      if (!this.stale) return;
      this.stale = false;
      this.updating = true;
      this.graph.updateOptions(Object.assign(this.options(), { file: rows_in(this.facts.lines, this.facts.factor, range) }));
      this.updating = false;
    }
  }

  /** Shows that time in all charts. */
  function show([from, to]) {
    const least = 4 * (whole[1] - whole[0]) / Math.max(time.length, 8);
    const length = Math.min(Math.max(to - from, least), whole[1] - whole[0]);
    from = Math.min(Math.max(from, whole[0]), whole[1] - length);
    range = [from, from + length];
    for (const chart of charts) {
      chart.stale = true;
      if (chart.seen) chart.refresh();
    }
    for (const told of document.querySelectorAll(".time-controls .readout")) told.textContent = range_text();
  }

  function range_text() {
    const step = (range[1] - range[0]) / 100;
    return `${grandamp.digits(range[0], step)} to ${grandamp.digits(range[1], step)} s`;
  }

  const scaled = by => {
    const middle = (range[0] + range[1]) / 2, half = (range[1] - range[0]) / 2 * by;
    show([middle - half, middle + half]);
  };
  const moved = by => show(range.map(t => t + by * (range[1] - range[0])));

  function controls(place) {
    const button = (text, label, press) => grandamp.element("button", { type: "button", "aria-label": label, title: label, onclick: press }, text);
    const figures = grandamp.report.figures, band = Object.values(figures).map(one => one.kind === "history" && one.band).find(one => one);
    place.append(button("Whole run", "Show the whole run", () => show(whole)));
    if (band && band[1] > band[0]) place.append(button("Window", "Show the window of the statistics", () => show(band)));
    const period = grandamp.report.period;
    if (period && 10 * period < whole[1] - whole[0])
      place.append(button("Last 10 periods", "Show the last ten periods", () => show([whole[1] - 10 * period, whole[1]])));
    place.append(button("+", "Zoom in", () => scaled(0.5)), button("−", "Zoom out", () => scaled(2)),
      button("◂", "Earlier", () => moved(-0.5)), button("▸", "Later", () => moved(0.5)),
      grandamp.element("span", { class: "readout", role: "status" }, range_text()));
    place.classList.add("controls");
    place.hidden = false;
  }

  for (const place of document.querySelectorAll(".time-controls")) controls(place);
  for (const figure of grandamp.figures("history")) charts.push(new History(figure));
  grandamp.redraws.push(() => charts.forEach(chart => {
    if (!chart.graph) return;
    chart.stale = true;
    chart.refresh();
  }));
  return { show, range: () => range, whole, charts };
})();
