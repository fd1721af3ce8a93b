// Plots over time: hover shows the values, dragging zooms all of them, a double click shows all, a click sets the instant of
// the model.

import uPlot from "uplot";
import { digits, prefix, quantity } from "./format.js";
import { colour, onTheme, series } from "./theme.js";

const HEIGHT = 220;
/** What is left free beside the axes of time of all plots, so that they stand under each other. */
const BESIDE = { left: 76, right: 24 };
/** Key of the cursors of all plots over time. */
const SYNC = "time";

/** Abscissae that ascend: of two samples at one instant, a jump, the later is put behind by rounding. */
function ascending(xs) {
  const out = Float64Array.from(xs);
  for (let k = 1; k < out.length; k += 1) {
    if (!(out[k] > out[k - 1])) out[k] = out[k - 1] + Math.max(Math.abs(out[k - 1]), 1e-300) * 1e-12;
  }
  return out;
}

function largest(arrays) {
  let size = 0;
  for (const values of arrays) for (const value of values) if (Math.abs(value) > size) size = Math.abs(value);
  return size;
}

/** Powers of ten on an axis, six or so. Those of uPlot end at 1e-16. */
function powers(low, high) {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const every = Math.max(1, Math.ceil((last - first) / 6));
  const all = [];
  for (let k = Math.ceil(first / every) * every; k <= last; k += every) all.push(10 ** k);
  return all;
}

/** uPlot writes only powers of ten whose digits it knows; what it leaves out is null. */
const unfiltered = (_, splits) => splits;

const power = (value) => (value === 1 ? "1" : `1e${Math.round(Math.log10(value))}`.replace("-", "−"));

/** The look of a curve by its role. */
function look(curve, number) {
  const own = { stroke: () => series(number), width: 1.5 };
  if (curve.role === "exact") return { stroke: () => colour("exact"), width: 4 };
  if (curve.role === "filtered") return { ...own, width: 2.5, alpha: 0.9 };
  if (curve.role === "instants") return { ...own, points: { show: true, size: 5 } };
  return own;
}

/** Draws what stands behind and over the curves: the band of rounding, the instants, the chosen one. */
function drawMarks(plot, page, { rounding, overTime }, instant) {
  const { ctx, bbox } = plot;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  if (rounding) {
    const y = Math.max(plot.valToPos(rounding, "y", true), bbox.top);
    if (y < bbox.top + bbox.height) {
      ctx.fillStyle = colour("raised");
      ctx.globalAlpha = 0.8;
      ctx.fillRect(bbox.left, y, bbox.width, bbox.top + bbox.height - y);
      ctx.globalAlpha = 1;
      ctx.fillStyle = colour("faint");
      ctx.font = `${12 * ratio}px system-ui, sans-serif`;
      ctx.textAlign = "right";
      ctx.fillText("rounding", bbox.left + bbox.width - 8 * ratio, bbox.top + bbox.height - 8 * ratio);
    }
  }
  const line = (time, stroke, dash) => {
    const x = Math.round(plot.valToPos(time, "x", true)) + 0.5;
    ctx.strokeStyle = stroke;
    ctx.lineWidth = ratio;
    ctx.setLineDash(dash.map((d) => d * ratio));
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
  };
  if (overTime) {
    for (const event of page.events) line(event.time, colour("faint"), [2, 4]);
    if (instant !== null) line(instant, colour("second"), []);
  }
  ctx.restore();
}

/** The extremes of the curves that are shown at first; what is rounding beside the largest value is zero. */
function extremes(all) {
  const curves = all.filter(({ curve, ys }) => !curve.hidden && ys.length > 0);
  const rounding = 1e-12 * largest(curves.map((c) => c.ys));
  const shown = (y, unit) => quantity(Math.abs(y) < rounding ? 0 : y, unit);
  const found = curves.map((one) => {
    let [low, high] = [0, 0];
    one.ys.forEach((y, k) => {
      if (y < one.ys[low]) low = k;
      if (y > one.ys[high]) high = k;
    });
    const at = (k) => `${shown(one.ys[k], one.unit)} at ${quantity(one.xs[k], one.axis)}`;
    return { ...one, low, high, at };
  });
  const table = document.createElement("p");
  table.className = "extremes";
  if (curves.length > 4) {
    const low = found.reduce((a, b) => (b.ys[b.low] < a.ys[a.low] ? b : a));
    const high = found.reduce((a, b) => (b.ys[b.high] > a.ys[a.high] ? b : a));
    table.textContent = `lowest ${low.at(low.low)} (${low.curve.name}) · highest ${high.at(high.high)} (${high.curve.name})`;
    return table;
  }
  const texts = found.filter(({ curve }) => curve.role !== "exact").map(({ curve, ys, unit, low, high, at }) => {
    const values = ys[low] === ys[high] ? shown(ys[0], unit) : `${at(low)} … ${at(high)}`;
    return `${curve.name}: ${values}`;
  });
  table.textContent = texts.join(" · ");
  return table;
}

class Plot {
  constructor(page, plot, read, shared, all) {
    this.figure = document.createElement("figure");
    this.figure.className = "plot";
    this.page = page;
    this.spec = plot;
    this.shared = shared;
    this.all = all;
    this.overTime = plot.abscissa === "time";
    this.axis = this.overTime ? page.abscissa : { name: "frequency", unit: "Hz" };
    this.curves = plot.curves.map((curve) => ({
      curve,
      xs: ascending(read(curve.x)),
      ys: read(curve.y),
      unit: plot.unit,
      axis: this.axis.unit,
    }));
    [this.factor, this.sign] = plot.scale === "linear" ? prefix(largest(this.curves.filter((c) => !c.curve.hidden).map((c) => c.ys)), plot.unit) : [1, ""];
    [this.xFactor, this.xSign] = prefix(this.overTime ? page.end : 1, this.axis.unit);
    this.data = this.join();
    const title = document.createElement("figcaption");
    title.textContent = plot.title;
    this.figure.append(title);
    this.draw();
    if (plot.scale === "linear") this.figure.append(extremes(this.curves));
    if (plot.note) {
      const note = document.createElement("p");
      note.className = "faint";
      note.textContent = plot.note;
      this.figure.append(note);
    }
  }

  join() {
    const log = this.spec.scale !== "linear";
    const tables = this.curves.map(({ xs, ys }) => [
      xs,
      Array.from(ys, (y) => (log ? (y > 0 ? y : null) : y / this.factor)),
    ]);
    return tables.length === 1 ? tables[0] : uPlot.join(tables);
  }

  options() {
    const { spec, axis } = this;
    const grid = { stroke: () => colour("grid"), width: 1 };
    const ink = () => colour("faint");
    const name = (label, sign, unit) => (unit ? `${label} (${sign}${unit})` : label);
    const times = (x) => (x === null || x === undefined ? "–" : quantity(x, axis.unit, 5));
    const value = (y) => (y === null || y === undefined ? "–" : quantity(y * this.factor, spec.unit, 5));
    const logarithmic = spec.scale !== "linear";
    return {
      width: Math.max(280, this.figure.clientWidth || 900),
      height: HEIGHT,
      padding: [null, BESIDE.right, null, 0],
      scales: {
        x: { time: false, distr: spec.scale === "double logarithmic" ? 3 : 1 },
        y: logarithmic ? { distr: 3, range: (_, low, high) => this.decades(low, high) } : {},
      },
      axes: [
        {
          stroke: ink,
          grid,
          ticks: grid,
          label: name(axis.name, this.xSign, axis.unit),
          labelSize: 18,
          size: 34,
          ...(this.overTime
            ? { values: (_, splits) => splits.map((t) => digits(t / this.xFactor)) }
            : { splits: (_, axis, low, high) => powers(low, high), filter: unfiltered, values: (_, splits) => splits.map(power) }),
        },
        {
          stroke: ink,
          grid,
          ticks: grid,
          label: name(spec.quantity, this.sign, spec.unit),
          labelSize: 20,
          size: BESIDE.left - 20,
          ...(logarithmic
            ? { splits: (_, axis, low, high) => powers(low, high), filter: unfiltered, values: (_, splits) => splits.map(power) }
            : { values: (_, splits) => splits.map((y) => digits(y)) }),
        },
      ],
      series: [
        { label: axis.name, value: (_, x) => times(x) },
        ...this.curves.map(({ curve }) => ({
          label: curve.name,
          spanGaps: true,
          points: { show: false },
          show: !curve.hidden,
          ...look(curve, this.curves.filter((c) => c.curve.role !== "exact").findIndex((c) => c.curve === curve)),
          value: (_, y) => value(y),
        })),
      ],
      cursor: this.overTime
        ? { sync: { key: SYNC, setSeries: false }, focus: { prox: 24 }, drag: { x: true, y: false } }
        : { drag: { x: true, y: false } },
      legend: { live: true },
      hooks: {
        drawAxes: [(plot) => drawMarks(plot, this.page, { rounding: spec.rounding, overTime: this.overTime }, this.shared.time)],
        setScale: [(plot, key) => key === "x" && this.overTime && this.all.zoom(plot)],
        ready: [(plot) => this.listen(plot)],
      },
    };
  }

  /** Whole decades, the band of rounding among them. */
  decades(low, high) {
    const bottom = this.spec.rounding ? Math.min(low ?? 1, this.spec.rounding / 100) : low;
    const top = this.spec.rounding ? Math.max(high ?? 1, this.spec.rounding * 10) : high;
    const floor = Math.max(bottom || top * 1e-6, top * 1e-20);
    return [10 ** Math.floor(Math.log10(floor)), 10 ** Math.ceil(Math.log10(top * 1.0001))];
  }

  /** A click without dragging sets the instant. */
  listen(plot) {
    if (!this.overTime) return;
    let from = null;
    plot.over.addEventListener("pointerdown", (e) => (from = [e.clientX, e.clientY]));
    plot.over.addEventListener("pointerup", (e) => {
      if (from && Math.hypot(e.clientX - from[0], e.clientY - from[1]) < 4) {
        this.shared.set(plot.posToVal(e.clientX - plot.over.getBoundingClientRect().left, "x"), this);
      }
    });
  }

  draw() {
    this.plot?.destroy();
    const holder = document.createElement("div");
    this.holder?.replaceWith(holder);
    if (!this.holder) this.figure.append(holder);
    this.holder = holder;
    this.plot = new uPlot(this.options(), this.data, holder);
  }

  resize() {
    const width = this.figure.clientWidth;
    if (width > 0) this.plot.setSize({ width, height: HEIGHT });
  }
}

/** Puts every plot into its section, in place of the static figures. */
export function showPlots(page, read, shared) {
  const { style } = document.documentElement;
  for (const side of ["left", "right"]) style.setProperty(`--beside-${side}`, `${BESIDE[side]}px`);
  const plots = [];
  let zooming = false;
  const all = {
    zoom(from) {
      if (zooming) return;
      zooming = true;
      const { min, max } = from.scales.x;
      for (const other of plots) if (other.overTime && other.plot !== from) other.plot.setScale("x", { min, max });
      shared.span(min, max);
      zooming = false;
    },
  };
  const resize = new ResizeObserver((entries) => {
    for (const entry of entries) plots.find((plot) => plot.figure === entry.target)?.resize();
  });
  const add = (spec, place) => {
    const plot = new Plot(page, spec, read, shared, all);
    plots.push(plot);
    place.append(plot.figure);
    plot.resize();
    resize.observe(plot.figure);
  };
  const folded = new Map();
  for (const spec of page.plots) {
    const place = document.getElementById(spec.id);
    if (!spec.folded) add(spec, place);
    else if (folded.has(spec.id)) folded.get(spec.id).push(spec);
    else {
      const specs = [spec];
      folded.set(spec.id, specs);
      const more = document.createElement("details");
      const summary = document.createElement("summary");
      summary.textContent = `${spec.title} with smaller forces`;
      more.append(summary);
      more.addEventListener("toggle", () => specs.splice(0).forEach((s) => add(s, more)));
      place.append(more);
    }
  }
  const first = plots.find((plot) => plot.overTime);
  if (first && page.begin > 0 && page.end > page.begin) first.plot.setScale("x", { min: page.begin, max: page.end });
  shared.listen(() => plots.forEach((plot) => plot.overTime && plot.plot.redraw(false, false)));
  onTheme(() => plots.forEach((plot) => plot.draw()));
}
