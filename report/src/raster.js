// Statuses of contact points over time, one row for each point or each group of neighbours, under the plots and with their times.

import { quantity } from "./format.js";
import { colour, onTheme } from "./theme.js";

const ROW = 5;
/** Bits of a cell: some point was open, closed, slipping in that time. */
const [CLOSED, SLIPPING] = [2, 4];
/** Longest name that stands beside its rows, letters. */
const BESIDE = 11;

/** The red, green and blue of a colour of the style. */
function rgb(name) {
  const probe = document.createElement("canvas").getContext("2d");
  probe.fillStyle = colour(name);
  probe.fillRect(0, 0, 1, 1);
  return probe.getImageData(0, 0, 1, 1).data;
}

/** The rows of a contact with their name. */
function row(contact, columns) {
  const holder = document.createElement("div");
  holder.className = contact.name.length > BESIDE ? "raster-row" : "raster-row beside";
  const name = document.createElement("span");
  name.textContent = contact.name;
  name.title = `${contact.name}: ${contact.points} points in ${contact.rows} rows`;
  const canvas = document.createElement("canvas");
  canvas.width = columns;
  canvas.height = contact.rows;
  canvas.style.height = `${Math.max(10, Math.min(120, contact.rows * ROW))}px`;
  holder.append(name, canvas);
  return { holder, canvas };
}

/** Draws the raster into its section. */
export function showRaster(page, read, shared) {
  const { raster } = page;
  const cells = read(raster.cells);
  const { columns } = raster;
  // the times that are shown, and the chosen instant
  let [from, to, instant] = [raster.begin, raster.end, null];
  const figure = document.createElement("figure");
  figure.className = "plot raster";
  const caption = document.createElement("figcaption");
  caption.textContent = "Status of the contact points";
  const body = document.createElement("div");
  figure.append(caption, body);
  document.getElementById(raster.id).append(figure);
  const time = (canvas, x) => {
    const { left, width } = canvas.getBoundingClientRect();
    return from + ((x - left) / width) * (to - from);
  };
  let first = 0;
  const parts = raster.contacts.map((contact) => {
    const { holder, canvas } = row(contact, columns);
    body.append(holder);
    canvas.addEventListener("click", (e) => shared.set(time(canvas, e.clientX), canvas));
    canvas.addEventListener("mousemove", (e) => {
      canvas.title = `${contact.name} at ${quantity(time(canvas, e.clientX), page.abscissa.unit)}`;
    });
    first += contact.rows;
    return { canvas, rows: contact.rows, first: first - contact.rows };
  });
  const legend = document.createElement("p");
  legend.className = "faint";
  const slips = Array.prototype.some.call(cells, (cell) => cell & SLIPPING);
  legend.innerHTML =
    '<span class="swatch" style="background: var(--first)"></span> closed ' +
    (slips ? '<span class="swatch" style="background: var(--second)"></span> closed and slipping ' : "");
  legend.append(`– ${raster.note}`);
  figure.append(legend);

  let colours;
  const paint = () => {
    const [open, closed, slip, paper, line] = colours;
    const marked = instant === null ? -1 : Math.floor(((instant - from) / (to - from)) * columns);
    const cellOf = Array.from({ length: columns }, (_, k) => {
      const at = from + ((k + 0.5) / columns) * (to - from);
      const cell = Math.floor(((at - raster.begin) / (raster.end - raster.begin)) * columns);
      return cell >= 0 && cell < columns ? cell : -1;
    });
    for (const { canvas, rows, first: above } of parts) {
      const context = canvas.getContext("2d");
      const image = context.createImageData(columns, rows);
      for (let k = 0; k < rows; k += 1) {
        cellOf.forEach((at, column) => {
          const cell = at < 0 ? 0 : cells[(above + k) * columns + at];
          const status = cell & SLIPPING ? slip : cell & CLOSED ? closed : at < 0 ? paper : open;
          image.data.set(column === marked ? line : status, 4 * (k * columns + column));
        });
      }
      context.putImageData(image, 0, 0);
    }
  };
  const repaint = () => {
    colours = ["raised", "first", "second", "paper", "ink"].map(rgb);
    paint();
  };
  repaint();
  onTheme(repaint);
  let pending = false;
  const later = () => {
    if (pending) return;
    pending = true;
    requestAnimationFrame(() => {
      pending = false;
      paint();
    });
  };
  shared.follow((low, high) => {
    [from, to] = [low, high];
    later();
  });
  shared.listen((at) => {
    instant = at;
    later();
  });
}
