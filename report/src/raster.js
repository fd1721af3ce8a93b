// Statuses of contact points over time, one row for each point or each group of neighbours.

import { quantity } from "./format.js";
import { colour, onTheme } from "./theme.js";

const ROW = 5;
/** Bits of a cell: some point was open, closed, slipping in that time. */
const [CLOSED, SLIPPING] = [2, 4];

/** Draws the raster into its section. */
export function showRaster(page, read, shared) {
  const { raster } = page;
  const cells = read(raster.cells);
  const columns = raster.columns;
  const at = (part) => raster.begin + part * (raster.end - raster.begin);
  const place = document.getElementById(raster.id);
  const figure = document.createElement("figure");
  figure.className = "plot raster";
  const caption = document.createElement("figcaption");
  caption.textContent = "Status of the contact points";
  const body = document.createElement("div");
  figure.append(caption, body);
  place.append(figure);
  const parts = raster.contacts.map((contact, k) => {
    const first = raster.contacts.slice(0, k).reduce((sum, c) => sum + c.rows, 0);
    const row = document.createElement("div");
    row.className = "raster-row";
    const name = document.createElement("span");
    name.textContent = contact.name;
    name.title = `${contact.name}: ${contact.points} points in ${contact.rows} rows`;
    const canvas = document.createElement("canvas");
    canvas.width = columns;
    canvas.height = contact.rows;
    canvas.style.height = `${Math.max(10, Math.min(120, contact.rows * ROW))}px`;
    row.append(name, canvas);
    body.append(row);
    canvas.addEventListener("click", (e) => {
      const { left, width } = canvas.getBoundingClientRect();
      shared.set(at((e.clientX - left) / width), canvas);
    });
    canvas.addEventListener("mousemove", (e) => {
      const { left, width } = canvas.getBoundingClientRect();
      const column = Math.floor(((e.clientX - left) / width) * columns);
      canvas.title = `${contact.name} at ${quantity(at(column / columns), page.abscissa.unit)}`;
    });
    return { canvas, rows: contact.rows, first };
  });
  const legend = document.createElement("p");
  legend.className = "faint";
  legend.innerHTML =
    '<span class="swatch" style="background: var(--first)"></span> closed <span class="swatch" style="background: var(--second)"></span> closed and slipping ';
  legend.append(`– from ${quantity(raster.begin, page.abscissa.unit)} to ${quantity(raster.end, page.abscissa.unit)}; ${raster.note}`);
  figure.append(legend);

  const paint = () => {
    const rgb = (name) => {
      const probe = document.createElement("canvas").getContext("2d");
      probe.fillStyle = colour(name);
      probe.fillRect(0, 0, 1, 1);
      return probe.getImageData(0, 0, 1, 1).data;
    };
    const [open, closed, slip] = ["raised", "first", "second"].map(rgb);
    for (const { canvas, rows, first } of parts) {
      const context = canvas.getContext("2d");
      const image = context.createImageData(columns, rows);
      for (let row = 0; row < rows; row += 1) {
        for (let column = 0; column < columns; column += 1) {
          const cell = cells[(first + row) * columns + column];
          const shade = cell & SLIPPING ? slip : cell & CLOSED ? closed : open;
          image.data.set(shade, 4 * (row * columns + column));
        }
      }
      context.putImageData(image, 0, 0);
    }
  };
  paint();
  onTheme(paint);
}
