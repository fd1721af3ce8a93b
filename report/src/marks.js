// Supports, loads, masses, springs and contacts with their names, drawn over the model: they show through what is before them.

import { Vector3 } from "three";

const SVG = "http://www.w3.org/2000/svg";
/** Length of the arrow of a load, pixels. */
const ARROW = 24;
/** Height of a line of text, and how far to the side another name is in its way, pixels. */
const [LINE, WIDE] = [14, 90];
/** Most names that are shown at first. */
const FEW = 16;

const place = new Vector3();

/** The path of a mark at a place of the picture; `way`: the direction of a force there. */
function symbol(what, [x, y], way) {
  if (what === "support") return `M${x},${y}l-4,7h8z`;
  if (what === "mass") return `M${x - 4},${y - 4}h8v8h-8z`;
  if (what === "contact") return `M${x - 1.5},${y - 1.5}h3v3h-3z`;
  if (what !== "load") return "";
  const length = way ? Math.hypot(...way) : 0;
  // along the line of sight
  if (length < 1e-6) return `M${x - 3},${y}h6m-3,-3v6`;
  const [u, v] = way.map((w) => w / length);
  const side = (s) => `${x - 6 * u - s * v},${y - 6 * v + s * u}`;
  return `M${x - ARROW * u},${y - ARROW * v}L${x},${y}M${side(3)}L${x},${y}L${side(-3)}`;
}

export class Marks {
  /** `holder`: the element over which they are drawn. */
  constructor(model, read, holder) {
    this.svg = document.createElementNS(SVG, "svg");
    this.svg.setAttribute("class", "marks");
    this.svg.setAttribute("aria-hidden", "true");
    holder.append(this.svg);
    this.signs = model.signs.map(({ what, label, nodes, ways }) => {
      const path = document.createElementNS(SVG, "path");
      const text = document.createElementNS(SVG, "text");
      for (const element of [path, text]) element.setAttribute("class", `mark-${what}`);
      text.textContent = label;
      this.svg.append(path, text);
      return { what, nodes: read(nodes), ways: read(ways), path, text };
    });
    this.shown = { marks: true, names: this.signs.length <= FEW, contacts: false };
  }

  /** Draws them where the nodes are. `section`: what lies beyond it is left out. */
  draw(places, camera, [width, height], section) {
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const seen = (vector) => {
      vector.project(camera);
      return [((vector.x + 1) * width) / 2, ((1 - vector.y) * height) / 2];
    };
    const at = (node) => {
      place.fromArray(places, 3 * node);
      const [a, b, c, d] = section;
      return a * place.x + b * place.y + c * place.z > d ? null : seen(place).map((x) => Math.round(10 * x) / 10);
    };
    const [originX, originY] = seen(place.set(0, 0, 0));
    const direction = (ways, k) => {
      if (ways.length === 0) return null;
      const [x, y] = seen(place.fromArray(ways, 3 * k).normalize());
      // relative to the largest extent of a unit vector in the picture
      const scale = (camera.zoom * height) / (camera.top - camera.bottom);
      return [(x - originX) / scale, (y - originY) / scale];
    };
    const taken = [];
    for (const { what, nodes, ways, path, text } of this.signs) {
      const found = Array.from(nodes, at);
      const marked = what === "contact" ? this.shown.contacts : this.shown.marks;
      let drawn = "";
      if (marked && what === "link") {
        for (let k = 0; k + 1 < found.length; k += 2) if (found[k] && found[k + 1]) drawn += `M${found[k]}L${found[k + 1]}`;
      } else if (marked) {
        found.forEach((point, k) => point && (drawn += symbol(what, point, direction(ways, k))));
      }
      path.setAttribute("d", drawn);
      const visible = found.filter(Boolean);
      text.style.display = this.shown.names && visible.length > 0 ? "" : "none";
      if (text.style.display === "none") continue;
      const mean = (i) => visible.reduce((sum, point) => sum + point[i], 0) / visible.length;
      const x = mean(0) + 6;
      let y = mean(1) - 5;
      while (taken.some(([u, v]) => Math.abs(u - x) < WIDE && Math.abs(v - y) < LINE)) y += LINE;
      taken.push([x, y]);
      // a name at the right end is written to the left
      const ends = x + text.getComputedTextLength() > width;
      text.setAttribute("text-anchor", ends ? "end" : "start");
      text.setAttribute("x", ends ? x - 12 : x);
      text.setAttribute("y", y);
    }
  }
}
