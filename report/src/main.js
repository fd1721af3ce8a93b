// The program of report.html: it replaces the static figures by plots and a model that can be turned. Without it, or where
// it cannot run, the page keeps its tables and figures.

import "uplot/dist/uPlot.min.css";
import "./report.css";
import { block, head, numbers, SCHEMA } from "./data.js";
import { showPlots } from "./plots.js";
import { showRaster } from "./raster.js";
import { showModel } from "./viewer.js";

/** What the parts of the page tell each other: the chosen instant, and the times that the plots show. */
function clock() {
  const listeners = [];
  const followers = [];
  return {
    time: null,
    listen: (listener) => listeners.push(listener),
    set(time, by) {
      this.time = time;
      for (const listener of listeners) listener(time, by);
    },
    follow: (follower) => followers.push(follower),
    span(from, to) {
      for (const follower of followers) follower(from, to);
    },
  };
}

/** A tile with an instant sets it, and what the model is coloured by. */
function showTiles(shared) {
  for (const tile of document.querySelectorAll(".tile[data-time]")) {
    tile.addEventListener("click", () => {
      if (tile.dataset.field) window.carom?.colour(tile.dataset.field);
      shared.set(Number(tile.dataset.time), tile);
    });
  }
}

async function start() {
  const page = head();
  if (!page) return;
  if (page.schema !== SCHEMA) throw new Error(`the data of this page have schema ${page.schema}, not ${SCHEMA}`);
  const bytes = await block();
  const read = (array) => numbers(bytes, array);
  const shared = clock();
  const root = document.documentElement;
  if (page.raster) showRaster(page, read, shared);
  showPlots(page, read, shared);
  showTiles(shared);
  if (page.model) {
    try {
      showModel(page, read, shared);
      root.classList.add("has-model");
    } catch (cause) {
      const note = document.getElementById("model-note");
      note.textContent = `The model cannot be drawn in this browser (${cause.message}); the figures below show it.`;
      note.hidden = false;
      root.classList.add("no-model");
    }
  }
  root.classList.add("live");
  root.dataset.state = "ready";
}

start().catch((cause) => {
  document.documentElement.dataset.state = "failed";
  console.error(cause);
});
