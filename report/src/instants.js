// The instants that the run kept: motion and fields of the model, read when they are asked for.

import { digits, quantity } from "./format.js";

/** Names of the statuses of a node, by their numbers. */
const STATUSES = ["no contact", "open", "closed", "slipping"];

/** Instants whose arrays are kept uncompressed. */
const KEPT = 64;

export class Instants {
  constructor(model, read) {
    this.model = model;
    this.read = read;
    this.frames = model.frames;
    this.x = read(model.x);
    this.bodyOfNode = read(model.body_of_node);
    this.bodyOfCell = read(model.body_of_cell);
    this.number = read(model.numbers);
    this.cache = new Map();
    let [largest, low, high] = [0, [Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    this.frames.forEach((_, k) => {
      const u = this.moved(k);
      for (let n = 0; n < u.length; n += 3) largest = Math.max(largest, Math.hypot(u[n], u[n + 1], u[n + 2]));
    });
    for (let n = 0; n < this.x.length; n += 1) {
      low[n % 3] = Math.min(low[n % 3], this.x[n]);
      high[n % 3] = Math.max(high[n % 3], this.x[n]);
    }
    this.largest = largest;
    this.size = Math.max(...high.map((h, i) => h - low[i]), 1e-30);
    this.fields = this.list();
  }

  /** What the model can be coloured by. */
  list() {
    const { model } = this;
    const fields = [
      ...model.fields.map((field) => ({ ...field, map: field.signed ? "signed" : "magnitude" })),
      { id: "displacement", name: "displacement", unit: "m", on: "node", map: "magnitude" },
      { id: "body", name: "bodies", on: "cell", categories: true, names: model.bodies },
    ];
    if (model.contacts.length > 0) {
      fields.push({ id: "status", name: "contact status", on: "node", categories: true, names: STATUSES });
    }
    if (model.zones.length > 0) {
      fields.push({ id: "zone", name: "zones", on: "cell", categories: true, names: model.zones });
      fields.push({ id: "weight", name: "weight of the zone's internal work", unit: "", on: "cell", map: "magnitude" });
    }
    return fields;
  }

  /** Keeps what a function makes for a key. */
  keep(key, make) {
    if (!this.cache.has(key)) {
      if (this.cache.size >= KEPT * 4) this.cache.delete(this.cache.keys().next().value);
      this.cache.set(key, make());
    }
    return this.cache.get(key);
  }

  /** Displacements at an instant, three to each node, m. */
  moved(frame) {
    return this.keep(`moved ${frame}`, () => {
      const { moved, offsets } = this.frames[frame];
      const parts = moved.map(this.read);
      const u = new Float32Array(this.x.length);
      for (let n = 0; n < this.model.nodes; n += 1) {
        const offset = offsets[this.bodyOfNode[n]];
        for (let i = 0; i < 3; i += 1) u[3 * n + i] = offset[i] + parts[i][n];
      }
      return u;
    });
  }

  /** Values of a field at an instant, one to each node or cell. */
  values(id, frame) {
    return this.keep(`${id} ${frame}`, () => {
      if (id === "displacement") {
        const u = this.moved(frame);
        return Float32Array.from({ length: this.model.nodes }, (_, n) => Math.hypot(u[3 * n], u[3 * n + 1], u[3 * n + 2]));
      }
      if (id === "body") return this.bodyOfCell;
      if (id === "zone") return Float32Array.from(this.bodyOfCell, (body) => this.model.zone_of_body[body]);
      if (id === "weight") return this.read(this.model.constants.weight);
      if (id === "quality") return this.read(this.model.constants.quality);
      return this.read(this.frames[frame].values[id]);
    });
  }

  /** Triangles that are there at an instant; `null` for all. */
  visible(frame) {
    const { visible } = this.frames[frame];
    return visible ? this.keep(`visible ${frame}`, () => this.read(visible)) : null;
  }

  /** Nodes with a contact force at an instant. */
  touching(frame) {
    return this.keep(`touching ${frame}`, () => {
      if (this.model.contacts.length === 0) return [];
      const found = [];
      this.values("status", frame).forEach((status, node) => status >= 2 && found.push(node));
      return found;
    });
  }

  /** How a field is coloured: over the range of one instant, or of all. */
  look(id, frame) {
    const field = this.fields.find((f) => f.id === id);
    if (field.categories) return { ...field, range: [0, 1] };
    const frames = frame === null ? this.frames.map((_, k) => k) : [frame];
    let [low, high] = this.keep(`range ${id} ${frame}`, () => {
      let [a, b] = [Infinity, -Infinity];
      for (const k of frames) {
        for (const value of this.values(id, k)) {
          if (value < a) a = value;
          if (value > b) b = value;
        }
      }
      return a <= b ? [a, b] : [0, 0];
    });
    if (field.map === "signed") {
      high = Math.max(Math.abs(low), Math.abs(high));
      low = -high;
    } else low = Math.min(low, 0);
    return { ...field, range: [low, high] };
  }

  /**
   * The value of a field that matters most at an instant, with its place and displacement: the largest magnitude, of the quality the least; of
   * stress and plastic strain that of all cells, those inside included. `null` where there is none.
   */
  peak(id, frame) {
    const field = this.fields.find((f) => f.id === id);
    if (field.categories || id === "weight") return null;
    const of = this.frames[frame].largest[id];
    if (of) return { ...of, word: "largest" };
    const isLeast = id === "quality";
    const measure = isLeast ? (value) => -value : Math.abs;
    const values = this.values(id, frame);
    let best = -1;
    values.forEach((value, k) => {
      if (Number.isFinite(value) && (best < 0 || measure(value) > measure(values[best]))) best = k;
    });
    if (best < 0 || values[best] === 0) return null;
    const nodes = field.on === "node" ? [best] : this.#nodesOf(best);
    if (nodes.length === 0) return null;
    const mean = (array) => [0, 1, 2].map((i) => nodes.reduce((sum, n) => sum + array[3 * n + i], 0) / nodes.length);
    return { value: values[best], place: mean(this.x), moved: mean(this.moved(frame)), word: isLeast ? "least" : "largest" };
  }

  /** Nodes of the part of a cell that is drawn. */
  #nodesOf(cell) {
    const found = new Set();
    for (const [corners, cells, width] of [["triangles", "triangle_cells", 3], ["lines", "line_cells", 2]]) {
      const own = this.keep(corners, () => this.read(this.model[corners]));
      this.keep(cells, () => this.read(this.model[cells])).forEach((other, k) => {
        if (other === cell) for (let i = 0; i < width; i += 1) found.add(own[width * k + i]);
      });
    }
    return [...found];
  }

  /** The instant nearest to a time, by its number. */
  nearest(time) {
    let best = 0;
    this.frames.forEach((frame, k) => {
      if (Math.abs(frame.time - time) < Math.abs(this.frames[best].time - time)) best = k;
    });
    return best;
  }

  /** A node at an instant, in words. */
  describe(node, frame) {
    const u = this.moved(frame);
    const at = [0, 1, 2].map((i) => this.x[3 * node + i]);
    const parts = [
      `node ${this.number[node]} of ${this.model.bodies[this.bodyOfNode[node]]} at (${at.map((c) => digits(c)).join(", ")}) m`,
      `displacement (${[0, 1, 2].map((i) => quantity(u[3 * node + i], "m")).join(", ")})`,
    ];
    for (const field of this.fields) {
      if (field.categories || field.on !== "node" || field.id === "displacement") continue;
      parts.push(`${field.name} ${quantity(this.values(field.id, frame)[node], field.unit)}`);
    }
    if (this.model.contacts.length > 0) parts.push(STATUSES[this.values("status", frame)[node]]);
    return parts.join(" · ");
  }
}
