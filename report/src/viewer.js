// The model: turn, zoom, cut, colour, and play the instants that the run kept.

import { Box3, OrthographicCamera, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { gradient } from "./colours.js";
import { quantity } from "./format.js";
import { controls } from "./controls.js";
import { Instants } from "./instants.js";
import { Marks } from "./marks.js";
import { ModelScene } from "./scene.js";
import { onTheme, series } from "./theme.js";

/** Pauses between two instants while playing, ms. */
const PAUSE = 110;
/** Largest displacement drawn at first of a model whose motion would not be seen, relative to the model. */
const SHOWN = 0.06;
/** Relative displacement that is seen without magnification. */
const SEEN = 0.02;

/** Part of the largest value of all instants below which a value is rounding. */
const ROUNDING = 1e-9;
/** Largest turn of a plane model to each side, rad. */
const TURN = (70 * Math.PI) / 180;

/** A round number near a factor: 1, 2 or 5 times a power of ten. */
function round(factor) {
  const power = 10 ** Math.floor(Math.log10(factor));
  return [5, 2, 1].find((k) => k * power <= factor) * power;
}

class Viewer {
  constructor(page, read, shared) {
    this.page = page;
    this.model = page.model;
    this.read = read;
    this.shared = shared;
    if (!document.createElement("canvas").getContext("webgl2")) throw new Error("it has no WebGL");
    this.instants = new Instants(page.model, read);
    this.parts = new ModelScene(page.model, read);
    this.scene = new Scene();
    this.scene.add(this.parts.root);
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.localClippingEnabled = true;
    this.holder = document.getElementById("model-view");
    if (this.model.dimension === 1) this.holder.classList.add("low");
    this.holder.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute("aria-label", "the model; drag to turn it, scroll to zoom");
    this.marks = new Marks(page.model, read, this.holder);
    this.camera = new OrthographicCamera();
    this.orbit = new OrbitControls(this.camera, this.renderer.domElement);
    this.orbit.addEventListener("change", () => this.render());
    this.size = this.instants.size;
    const visible = this.instants.largest / this.size;
    this.factor = visible >= SEEN || visible === 0 ? 1 : round(SHOWN / visible);
    this.choice = {
      frame: Math.max(0, this.instants.frames.findIndex((f) => f.kinds.includes("largest stress"))),
      field: this.instants.fields[0].id,
      range: "run",
      limits: {},
      section: null,
      peak: true,
      edges: !this.model.decimated_from,
    };
    this.controls = controls(this);
    this.parts.toggle(this.parts.net, this.choice.edges);
    new ResizeObserver(() => this.fit()).observe(this.holder);
    onTheme(() => {
      this.parts.recolour();
      this.show();
    });
    shared.listen((time, by) => by !== this && this.go(this.instants.nearest(time)));
    this.renderer.domElement.addEventListener("click", (event) => this.pick(event));
    this.show();
    this.look(this.model.dimension < 3 ? "front" : "oblique");
  }

  /** Shows an instant by its number. */
  go(number) {
    this.choice.frame = Math.min(Math.max(number, 0), this.instants.frames.length - 1);
    this.show();
  }

  /** Plays all instants once more, or stops. */
  play() {
    if (this.timer) {
      clearInterval(this.timer);
      this.timer = null;
    } else {
      const count = this.instants.frames.length;
      this.timer = setInterval(() => this.go((this.choice.frame + 1) % count), PAUSE);
    }
    this.controls.playing(Boolean(this.timer));
  }

  show() {
    const { frame, field } = this.choice;
    const still = this.instants.frames[frame];
    this.parts.place(this.instants.x, this.instants.moved(frame), this.factor);
    this.parts.show(this.instants.visible(frame));
    this.parts.pose(still.poses);
    this.parts.mark(this.instants.touching(frame));
    const look = this.colouring;
    this.parts.paint(this.instants.values(field, frame), look);
    const largest = Math.max(...this.instants.look(field, null).range.map(Math.abs));
    const found = this.instants.peak(field, frame);
    const peak = found && Math.abs(found.value) > ROUNDING * largest ? found : null;
    this.parts.point(this.choice.peak ? peak : null, this.factor);
    this.legend(look, peak);
    this.controls.at(still, frame);
    this.shared.set(still.time, this);
    this.render();
  }

  render() {
    if (!this.pending) {
      this.pending = true;
      requestAnimationFrame(() => {
        this.pending = false;
        this.renderer.render(this.scene, this.camera);
        const { places, material } = this.parts;
        const size = [this.holder.clientWidth, this.holder.clientHeight];
        this.marks.draw(places, this.camera, size, material.uniforms.section.value);
      });
    }
  }

  /** Colours by a field. */
  colour(field) {
    if (!this.instants.fields.some((f) => f.id === field)) return;
    this.choice.field = field;
    this.controls.coloured(field);
    this.show();
  }

  /** Ends of the colours by hand of the field that is shown: at first those of all instants. */
  limits() {
    const { field, limits } = this.choice;
    return limits[field] ?? this.instants.look(field, null).range;
  }

  /** How the field that is shown is coloured at this instant. */
  get colouring() {
    const { field, frame, range } = this.choice;
    const look = this.instants.look(field, range === "frame" ? frame : null);
    return range === "hand" && !look.categories ? { ...look, range: this.limits(), byHand: true } : look;
  }

  legend(look, peak) {
    const legend = document.getElementById("model-legend");
    legend.replaceChildren();
    if (look.categories) {
      look.names.slice(0, 24).forEach((name, k) => {
        const entry = document.createElement("span");
        const swatch = document.createElement("span");
        swatch.className = "swatch";
        swatch.style.background = series(k);
        entry.append(swatch, ` ${name} `);
        legend.append(entry);
      });
      if (look.names.length > 24) legend.append(`and ${look.names.length - 24} more`);
      return;
    }
    const [low, high] = look.range;
    const bar = document.createElement("span");
    bar.className = "ramp";
    bar.style.background = gradient(look.map);
    // beyond ends by hand the colours stay those of the ends
    const [under, over] = look.byHand ? ["≤ ", "≥ "] : ["", ""];
    legend.append(`${under}${quantity(low, look.unit)}`, bar, `${over}${quantity(high, look.unit)} ${look.note ?? ""}`);
    if (!peak) return;
    const place = document.createElement("span");
    place.id = "model-peak";
    const at = peak.place.slice(0, this.model.dimension).map((x) => quantity(x, "m"));
    const through = this.model.dimension === 3 && this.model.triangles.count > 0 ? "; marked through what is before it" : "";
    place.textContent = `◯ ${peak.word} at this instant: ${quantity(peak.value, look.unit)} at (${at.join(", ")})${through}`;
    legend.append(place);
  }

  /** Looks at the whole model from a side. */
  look(side) {
    const directions = { front: [0, 0, 1], top: [0, 1, 0.0001], right: [1, 0, 0], x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, 1], oblique: [0.8, -1.1, 0.6] };
    const direction = new Vector3(...directions[side]).normalize();
    const box = this.box();
    const middle = box.getCenter(new Vector3());
    const reach = Math.max(box.getSize(new Vector3()).length(), 1e-12);
    this.camera.up.set(...(this.model.dimension < 3 || side === "z" ? [0, 1, 0] : [0, 0, 1]));
    this.camera.position.copy(middle).addScaledVector(direction, 2 * reach);
    this.camera.near = 0;
    this.camera.far = 5 * reach;
    this.camera.zoom = 1;
    this.orbit.target.copy(middle);
    this.orbit.enableRotate = this.model.dimension > 1;
    // a plane model seen along its plane would be a line
    if (this.model.dimension === 2) {
      [this.orbit.minAzimuthAngle, this.orbit.maxAzimuthAngle] = [-TURN, TURN];
      [this.orbit.minPolarAngle, this.orbit.maxPolarAngle] = [Math.PI / 2 - TURN, Math.PI / 2 + TURN];
    }
    this.camera.lookAt(middle);
    this.camera.updateMatrixWorld();
    // the middle of what is seen from there stands in the middle of the frame
    const { low, high } = this.seen();
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const shift = right.multiplyScalar((low[0] + high[0]) / 2).addScaledVector(up, (low[1] + high[1]) / 2);
    this.camera.position.add(shift);
    this.orbit.target.add(shift);
    this.camera.updateMatrixWorld();
    this.fit();
    this.orbit.update();
  }

  /** Calls with the places of all nodes at some instants. */
  visit(call) {
    const place = new Vector3();
    const { x, frames } = this.instants;
    const step = Math.max(1, Math.floor(frames.length / 8));
    for (let k = 0; k < frames.length; k += step) {
      const u = this.instants.moved(k);
      for (let n = 0; n < x.length; n += 3) {
        const moved = [0, 1, 2].map((i) => x[n + i] + this.factor * u[n + i]);
        call(place.set(...moved));
        if (this.model.axisymmetric) call(place.set(-moved[0], moved[1], moved[2]));
      }
    }
  }

  /** The box around what is drawn, over all instants. */
  box() {
    const box = new Box3();
    this.visit((place) => box.expandByPoint(place));
    this.bounds = box;
    return box;
  }

  /** Extent of what is drawn along the axes of the camera, over all instants. */
  seen() {
    const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
    this.visit((place) => {
      const { x, y } = place.applyMatrix4(this.camera.matrixWorldInverse);
      low[0] = Math.min(low[0], x);
      low[1] = Math.min(low[1], y);
      high[0] = Math.max(high[0], x);
      high[1] = Math.max(high[1], y);
    });
    return { low, high };
  }

  /** Fills the frame with the model. */
  fit() {
    const width = this.holder.clientWidth;
    const height = this.holder.clientHeight;
    if (width === 0 || !this.bounds) return;
    this.renderer.setSize(width, height);
    const { low, high } = this.seen();
    const reach = [0, 1].map((i) => Math.max(Math.abs(low[i]), Math.abs(high[i])));
    const half = 1.08 * Math.max(reach[1], (reach[0] * height) / width, 1e-12);
    this.camera.top = half;
    this.camera.bottom = -half;
    this.camera.right = (half * width) / height;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  /** Cuts the model across an axis at a part from 0 to 1 of its extent. */
  cut(axis, part, flip) {
    if (axis === null) this.parts.cut(null);
    else {
      const { min, max } = this.bounds;
      const place = min.getComponent(axis) + part * (max.getComponent(axis) - min.getComponent(axis));
      const sign = flip ? -1 : 1;
      const normal = [0, 0, 0];
      normal[axis] = sign;
      this.parts.cut({ normal, offset: sign * place });
    }
    this.render();
  }

  /** Says what is under the pointer. */
  pick(event) {
    const { left, top, width, height } = this.renderer.domElement.getBoundingClientRect();
    const at = new Vector2((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
    const node = this.nearest(at, width, height);
    const out = document.getElementById("model-pick");
    if (node === null) {
      out.textContent = "";
      return;
    }
    out.textContent = this.instants.describe(node, this.choice.frame);
  }

  /** The node nearest to the pointer, of those near it the one in front. */
  nearest(at, width, height) {
    const place = new Vector3();
    let best = null;
    let least = Infinity;
    const { places } = this.parts;
    const { section } = this.parts.material.uniforms;
    for (let n = 0; n < places.length / 3; n += 1) {
      place.fromArray(places, 3 * n);
      const [a, b, c, d] = section.value;
      if (a * place.x + b * place.y + c * place.z > d) continue;
      place.project(this.camera);
      const off = Math.hypot(((place.x - at.x) * width) / 2, ((place.y - at.y) * height) / 2);
      if (off > 14) continue;
      const rank = off + 400 * (place.z + 1);
      if (rank < least) [best, least] = [n, rank];
    }
    return best;
  }
}

/** Draws the model into its section. */
export function showModel(page, read, shared) {
  const app = document.getElementById("model-app");
  app.hidden = false;
  try {
    const viewer = new Viewer(page, read, shared);
    window.carom = viewer;
  } catch (cause) {
    app.hidden = true;
    throw cause;
  }
}
