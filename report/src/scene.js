// The model as three.js objects: faces coloured by a field, edges, lines of bars and beams, contact surfaces, obstacles.

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  DoubleSide,
  GLSL3,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Plane,
  Points,
  PointsMaterial,
  SRGBColorSpace,
  ShaderMaterial,
  Vector3,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { shade, texture } from "./colours.js";
import { colour, series } from "./theme.js";

/** Most categories that the shader knows; further ones begin again. */
const CATEGORIES = 12;

/** Pixels of the picture of a ring. */
const RING = 64;

const VERTEX = `
in float value;
out float v_value;
out vec3 v_place;
out vec3 v_view;
void main() {
  v_value = value;
  vec4 place = modelMatrix * vec4(position, 1.0);
  v_place = place.xyz;
  vec4 view = viewMatrix * place;
  v_view = view.xyz;
  gl_Position = projectionMatrix * view;
}`;

const FRAGMENT = `
precision highp float;
in float v_value;
in vec3 v_place;
in vec3 v_view;
out vec4 colour;
uniform sampler2D map;
uniform vec2 range;
uniform vec4 section;
uniform vec3 palette[${CATEGORIES}];
uniform bool categories;
uniform bool lit;
void main() {
  if (dot(section.xyz, v_place) > section.w) discard;
  vec3 base;
  if (categories) {
    base = palette[int(v_value + 0.5) % ${CATEGORIES}];
  } else {
    float part = clamp((v_value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
    base = texture(map, vec2((0.5 + 255.0 * part) / 256.0, 0.5)).rgb;
  }
  if (lit) {
    vec3 normal = normalize(cross(dFdx(v_view), dFdy(v_view)));
    float light = 0.62 + 0.38 * abs(dot(normal, normalize(vec3(0.25, 0.45, 0.86))));
    if (!gl_FrontFacing) light *= 0.62;
    base *= light;
  }
  colour = linearToOutputTexel(vec4(base, 1.0));
}`;

/** Positions of triangles or lines, corner by corner, from those of the nodes. */
function spread(nodes, corners, out) {
  for (let k = 0; k < corners.length; k += 1) {
    const from = 3 * corners[k];
    out[3 * k] = nodes[from];
    out[3 * k + 1] = nodes[from + 1];
    out[3 * k + 2] = nodes[from + 2];
  }
}

export class ModelScene {
  /** `model`: the head's model; `read`: from its arrays to numbers. */
  constructor(model, read) {
    this.model = model;
    this.flat = model.dimension < 3;
    this.maps = { magnitude: texture("magnitude"), signed: texture("signed") };
    this.triangles = read(model.triangles);
    this.triangleCell = read(model.triangle_cells);
    this.edges = read(model.edges);
    this.lines = read(model.lines);
    this.lineCell = read(model.line_cells);
    this.dots = read(model.points);
    this.plane = new Plane(new Vector3(1, 0, 0), 0);
    this.places = new Float32Array(3 * model.nodes);
    this.shared = new BufferAttribute(this.places, 3);
    this.root = new Group();
    /** What is drawn once more on the other side of the axis. */
    this.twins = new Map();
    this.#faces();
    this.#edges();
    this.#bars();
    this.#contacts(read);
    this.#groups();
    this.#obstacles(read);
    this.#forces();
    this.#peak();
    if (model.axisymmetric) this.#mirror();
    this.recolour();
  }

  #faces() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * this.triangles.length), 3));
    geometry.setAttribute("value", new BufferAttribute(new Float32Array(this.triangles.length), 1));
    this.material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      uniforms: {
        map: { value: this.maps.magnitude },
        range: { value: [0, 1] },
        section: { value: [0, 0, 0, 1] },
        palette: { value: Array.from({ length: CATEGORIES }, () => new Color()) },
        categories: { value: true },
        lit: { value: !this.flat },
      },
    });
    this.faces = new Mesh(geometry, this.material);
    this.faces.frustumCulled = false;
    this.root.add(this.faces);
  }

  #edges() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.shared);
    geometry.setIndex(new BufferAttribute(this.edges, 1));
    this.edgeMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.35 });
    this.net = new LineSegments(geometry, this.edgeMaterial);
    const still = geometry.clone();
    still.setAttribute("position", new BufferAttribute(new Float32Array(this.places.length), 3));
    this.ghostMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.25 });
    this.ghost = new LineSegments(still, this.ghostMaterial);
    this.ghost.visible = false;
    for (const object of [this.net, this.ghost]) {
      object.frustumCulled = false;
      this.root.add(object);
    }
  }

  #bars() {
    this.barMaterial = new LineMaterial({ linewidth: this.model.dimension === 1 ? 9 : 5, vertexColors: true });
    this.bars = new LineSegments2(new LineSegmentsGeometry(), this.barMaterial);
    this.bars.frustumCulled = false;
    this.bars.visible = this.lines.length > 0;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.shared);
    geometry.setIndex(new BufferAttribute(this.dots, 1));
    this.dotMaterial = new PointsMaterial({ size: 9, sizeAttenuation: false });
    this.masses = new Points(geometry, this.dotMaterial);
    this.masses.frustumCulled = false;
    this.root.add(this.bars, this.masses);
  }

  #contacts(read) {
    this.surfaces = new Group();
    this.surfaces.visible = false;
    this.surfaceLines = [];
    this.model.contacts.forEach((contact) => {
      ["secondary", "primary"].forEach((side, number) => {
        const { triangles, lines } = contact[side];
        const index = read(triangles);
        if (index.length > 0) {
          const geometry = new BufferGeometry();
          geometry.setAttribute("position", this.shared);
          geometry.setIndex(new BufferAttribute(index, 1));
          const material = new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.75, clippingPlanes: [] });
          material.userData.side = number;
          material.polygonOffset = true;
          material.polygonOffsetFactor = -1 - number;
          material.polygonOffsetUnits = -1 - number;
          const mesh = new Mesh(geometry, material);
          mesh.frustumCulled = false;
          this.surfaces.add(mesh);
        }
        const ends = read(lines);
        if (ends.length > 0) {
          const material = new LineMaterial({ linewidth: 5 });
          material.userData.side = number;
          const object = new LineSegments2(new LineSegmentsGeometry(), material);
          object.frustumCulled = false;
          this.surfaces.add(object);
          this.surfaceLines.push({ object, ends });
        }
      });
    });
    this.root.add(this.surfaces);
  }

  /** The group that is chosen; `name` is empty for none. */
  choose(read, name) {
    const group = this.model.groups.find((one) => one.name === name);
    const [triangles, lines] = group ? [read(group.triangles), read(group.lines)] : [new Uint32Array(), new Uint32Array()];
    this.chosen.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.chosenLines.ends = lines;
    this.toggle(this.chosen, triangles.length > 0);
    this.chosenLines.object.visible = lines.length > 0;
    this.#placeLines(this.chosenLines);
  }

  #groups() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.shared);
    const material = new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.85, clippingPlanes: [] });
    Object.assign(material, { polygonOffset: true, polygonOffsetFactor: -3, polygonOffsetUnits: -3 });
    this.chosen = new Mesh(geometry, material);
    this.chosenLines = { object: new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ linewidth: 5 })), ends: new Uint32Array() };
    for (const object of [this.chosen, this.chosenLines.object]) {
      object.frustumCulled = false;
      object.visible = false;
      this.root.add(object);
    }
  }

  #placeLines({ object, ends }) {
    if (ends.length === 0) return;
    const places = new Float32Array(3 * ends.length);
    spread(this.places, ends, places);
    object.geometry.setPositions(places);
  }

  #obstacles(read) {
    this.obstacles = new Group();
    this.obstacleParts = this.model.obstacles.map((obstacle) => {
      const part = new Group();
      part.matrixAutoUpdate = false;
      const triangles = read(obstacle.triangles);
      if (triangles.length > 0) {
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(triangles, 3));
        const material = new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.25, depthWrite: false });
        part.add(new Mesh(geometry, material));
      }
      const lines = read(obstacle.lines);
      if (lines.length > 0) {
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(lines, 3));
        part.add(new LineSegments(geometry, new LineBasicMaterial()));
      }
      for (const child of part.children) child.frustumCulled = false;
      this.obstacles.add(part);
      return part;
    });
    this.root.add(this.obstacles);
  }

  /** Dots at nodes with a contact force. */
  #forces() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.shared);
    this.forceMaterial = new PointsMaterial({ size: 6, sizeAttenuation: false, depthTest: !this.flat });
    this.forces = new Points(geometry, this.forceMaterial);
    this.forces.frustumCulled = false;
    this.root.add(this.forces);
  }

  /** A ring around the place of the largest value, which shows through the model. */
  #peak() {
    const canvas = Object.assign(document.createElement("canvas"), { width: RING, height: RING });
    const context = canvas.getContext("2d");
    for (const [width, stroke] of [[14, "#ffffff"], [6, "#d6006e"]]) {
      Object.assign(context, { lineWidth: width, strokeStyle: stroke });
      context.beginPath();
      context.arc(RING / 2, RING / 2, RING / 2 - 8, 0, 2 * Math.PI);
      context.stroke();
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3), 3));
    const map = new CanvasTexture(canvas);
    map.colorSpace = SRGBColorSpace;
    const material = new PointsMaterial({ size: 26, sizeAttenuation: false, map, transparent: true, depthTest: false });
    this.peak = new Points(geometry, material);
    this.peak.renderOrder = 10;
    this.peak.frustumCulled = false;
    this.root.add(this.peak);
  }

  /** Puts the ring at a place with a displacement, drawn with a factor; `null` hides it. */
  point(peak, factor) {
    this.peak.visible = Boolean(peak);
    if (!peak) return;
    const position = this.peak.geometry.getAttribute("position");
    for (let i = 0; i < 3; i += 1) position.array[i] = peak.place[i] + factor * peak.moved[i];
    position.needsUpdate = true;
  }

  /** The other half of a section through the axis. */
  #mirror() {
    const half = new Group();
    half.applyMatrix4(new Matrix4().makeScale(-1, 1, 1));
    for (const object of [this.faces, this.net, this.forces, this.surfaces, this.chosen]) {
      const other = object.clone();
      half.add(other);
      this.twins.set(object, other);
    }
    this.root.add(half);
  }

  /** Takes the colours of the theme. */
  recolour() {
    this.material.uniforms.palette.value.forEach((entry, k) => entry.setStyle(series(k)));
    this.edgeMaterial.color.setStyle(colour("ink"));
    this.ghostMaterial.color.setStyle(colour("faint"));
    this.dotMaterial.color.setStyle(colour("ink"));
    this.forceMaterial.color.setStyle(colour("bad"));
    for (const { material } of [this.chosen, this.chosenLines.object]) material.color.setStyle(colour("fourth"));
    const sides = ["second", "first"];
    this.surfaces.traverse(({ material }) => material?.color?.setStyle(colour(sides[material.userData.side])));
    this.obstacles.traverse(({ material }) => material?.color?.setStyle(colour("faint")));
  }

  /** Where the nodes are: reference places x and displacements u (three to each node), the factor of these. */
  place(x, u, factor) {
    for (let k = 0; k < this.places.length; k += 1) this.places[k] = x[k] + factor * u[k];
    this.shared.needsUpdate = true;
    const corners = this.faces.geometry.getAttribute("position");
    spread(this.places, this.triangles, corners.array);
    corners.needsUpdate = true;
    const still = this.ghost.geometry.getAttribute("position");
    still.array.set(x);
    still.needsUpdate = true;
    if (this.lines.length > 0) {
      this.linePlaces ??= new Float32Array(3 * this.lines.length);
      spread(this.places, this.lines, this.linePlaces);
      this.bars.geometry.setPositions(this.linePlaces);
    }
    for (const lines of [...this.surfaceLines, this.chosenLines]) this.#placeLines(lines);
  }

  /** Hides the faces of deleted cells: `visible` has a number for each triangle, `null` shows all. */
  show(visible) {
    if (!visible) return;
    const corners = this.faces.geometry.getAttribute("position").array;
    for (let k = 0; k < visible.length; k += 1) if (!visible[k]) corners.fill(NaN, 9 * k, 9 * k + 9);
  }

  /** Colours by numbers of nodes or cells. `look`: { on, map, range, categories }. */
  paint(values, look) {
    const { uniforms } = this.material;
    uniforms.categories.value = look.categories;
    uniforms.map.value = this.maps[look.map] ?? this.maps.magnitude;
    uniforms.range.value = look.range;
    const corner = this.faces.geometry.getAttribute("value");
    const of = look.on === "node" ? (k) => values[this.triangles[k]] : (k) => values[this.triangleCell[(k / 3) | 0]];
    for (let k = 0; k < corner.count; k += 1) corner.array[k] = of(k);
    corner.needsUpdate = true;
    if (this.lines.length === 0) return;
    const colours = new Float32Array(3 * this.lines.length);
    const [low, high] = look.range;
    const palette = uniforms.palette.value;
    const tint = new Color();
    for (let k = 0; k < this.lines.length; k += 1) {
      const value = look.on === "node" ? values[this.lines[k]] : values[this.lineCell[k >> 1]];
      if (look.categories) tint.copy(palette[Math.round(value) % CATEGORIES]);
      else {
        const [r, g, b] = shade(look.map, (value - low) / Math.max(high - low, 1e-30));
        tint.setStyle(`rgb(${Math.round(r)},${Math.round(g)},${Math.round(b)})`);
      }
      tint.toArray(colours, 3 * k);
    }
    this.bars.geometry.setColors(colours);
  }

  /** Shows or hides an object and its twin. */
  toggle(object, on) {
    object.visible = on;
    const twin = this.twins.get(object);
    if (twin) twin.visible = on;
  }

  /** Marks the nodes with a contact force. */
  mark(nodes) {
    this.forces.geometry.setIndex(nodes);
  }

  /** Brings the obstacles to where they are: of each the upper three rows of its matrix, or nothing. */
  pose(poses) {
    this.obstacleParts.forEach((part, k) => {
      const pose = poses?.[k];
      if (!pose) return;
      part.matrix.set(...pose, 0, 0, 0, 1);
      part.matrixWorldNeedsUpdate = true;
    });
  }

  /** Cuts off what lies beyond a place along a direction; `null` for nothing. */
  cut(section) {
    const planes = [];
    if (section) {
      const { normal, offset } = section;
      this.material.uniforms.section.value = [...normal, offset];
      this.plane.set(new Vector3(...normal).negate(), offset);
      planes.push(this.plane);
    } else {
      this.material.uniforms.section.value = [0, 0, 0, 1];
    }
    this.root.traverse(({ material }) => {
      if (!material || material === this.material) return;
      material.clippingPlanes = planes;
      material.needsUpdate = true;
    });
  }
}
