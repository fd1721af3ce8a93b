// Runs inside of a page in a browser (`cargo xtask check page`): tries what a reader does, and leaves the outcome in the page.

(async () => {
  const problems = [];
  const wrong = (condition, text) => condition && problems.push(text);
  const root = document.documentElement;
  const pause = (time) => new Promise((resolve) => setTimeout(resolve, time));
  // a browser may take its time to paint
  const until = async (holds) => {
    for (let k = 0; k < 40 && !holds(); k += 1) await pause(50);
    return holds();
  };
  for (let k = 0; k < 100 && !root.dataset.state; k += 1) await pause(50);
  wrong(root.dataset.state !== "ready", `the page is ${root.dataset.state ?? "not ready"}`);

  const head = JSON.parse(document.getElementById("carom-page").textContent);
  const differ = (a, b) => a.length !== b.length || a.some((pixel, k) => pixel !== b[k]);
  const shown = head.plots.filter((plot) => !plot.folded).length;
  const plots = [...document.querySelectorAll(".plot .uplot canvas")];
  wrong(plots.length !== shown, `${plots.length} plots, not ${shown}`);
  const colours = (canvas) => {
    const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    return new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  };
  // the statuses stand under the plots: at the same places, and for the same times when these are zoomed
  const tryRaster = async () => {
    await pause(500);
    const over = document.querySelector("#plot-force .u-over");
    const raster = document.querySelector(".raster canvas");
    const [plot, rows] = [over, raster].map((element) => element.getBoundingClientRect());
    const apart = Math.max(Math.abs(plot.left - rows.left), Math.abs(plot.right - rows.right));
    wrong(apart > 2, `the statuses begin or end ${apart} pixels beside the plots`);
    const at = (part) => ({ clientX: plot.left + part * plot.width, clientY: plot.top + 20, movementX: 9, bubbles: true, button: 0 });
    // after a static stage the plots show the dynamics at first
    over.dispatchEvent(new MouseEvent("dblclick", at(0.5)));
    await pause(200);
    const whole = colours(raster);
    over.dispatchEvent(new MouseEvent("mousemove", at(0.01)));
    over.dispatchEvent(new MouseEvent("mousedown", at(0.01)));
    over.dispatchEvent(new MouseEvent("mousemove", at(0.02)));
    document.dispatchEvent(new MouseEvent("mouseup", at(0.02)));
    wrong(!(await until(() => differ(whole, colours(raster)))), "the statuses are not zoomed with the plots");
    over.dispatchEvent(new MouseEvent("dblclick", at(0.5)));
    wrong(!(await until(() => !differ(whole, colours(raster)))), "a double click does not show all times again");
  };
  for (const [k, canvas] of plots.entries()) wrong(new Set(colours(canvas)).size < 4, `plot ${k} is blank`);
  for (const more of document.querySelectorAll("details")) more.open = true;
  await pause(100);
  const all = document.querySelectorAll(".plot .uplot canvas").length;
  wrong(all !== head.plots.length, `${all} plots when all is opened, not ${head.plots.length}`);
  wrong(Boolean(head.raster) !== Boolean(document.querySelector(".raster canvas")), "the raster of the statuses");

  const odd = window.written.filter((text) => /Infinity|NaN|undefined|null/.test(text));
  wrong(odd.length > 0, `a plot has the text ${odd[0]}`);
  if (head.raster) await tryRaster();
  wrong(document.querySelector(".tiles") && document.querySelectorAll(".tile").length < 3, "tiles are missing");
  for (const link of document.querySelectorAll('a[href^="#"]')) {
    const target = link.getAttribute("href").slice(1);
    wrong(!document.getElementById(target), `a link leads to ${target}, which is not there`);
  }
  wrong(document.documentElement.scrollWidth > innerWidth, "the page is wider than its window");
  const hidden = head.plots.some((plot) => plot.curves.some((curve) => curve.hidden));
  wrong(hidden !== Boolean(document.querySelector(".u-legend .u-off")), "curves that are hidden at first");

  const withoutModel = root.classList.contains("no-model");
  wrong(withoutModel !== WITHOUT_WEBGL, `the model ${withoutModel ? "cannot be" : "is"} drawn`);
  if (withoutModel) {
    const figures = [...document.querySelectorAll(".still figure")];
    wrong(!figures.some((figure) => figure.offsetHeight > 0), "no figure stands for the model");
    wrong(document.getElementById("model-note").hidden, "nothing says why there is no model");
  } else if (head.model) {
    const viewer = window.carom;
    const picture = () => {
      viewer.renderer.render(viewer.scene, viewer.camera);
      return colours(viewer.renderer.domElement);
    };
    const last = head.model.frames.length - 1;
    viewer.go(0);
    const first = picture();
    wrong(new Set(first).size < 3, "the model is blank");
    viewer.go(last);
    wrong(!differ(first, picture()), "the first and the last instant look the same");
    document.getElementById("model-play").click();
    const played = new Set();
    for (let k = 0; k < 10; k += 1) {
      await pause(70);
      played.add(viewer.choice.frame);
    }
    wrong(played.size < 2, "playing does not move the model");
    document.getElementById("model-play").click();
    const [colour] = document.querySelectorAll("#model-settings select");
    for (const { value } of [...colour.options]) {
      colour.value = value;
      colour.dispatchEvent(new Event("change"));
      wrong(viewer.choice.field !== value, `the field ${value} is not chosen`);
      picture();
    }
    const range = document.querySelector("#model-range select");
    const choose = (value) => {
      range.value = value;
      range.dispatchEvent(new Event("change"));
    };
    viewer.colour("displacement");
    const ofRun = picture();
    choose("hand");
    wrong(document.getElementById("model-limits").hidden, "the ends of the colours cannot be written");
    wrong(differ(ofRun, picture()), "the ends by hand are not those of the run at first");
    const [lower, upper] = document.querySelectorAll("#model-limits input");
    if (Number(upper.value) > 0) {
      upper.value = Number(upper.value) / 10;
      upper.dispatchEvent(new Event("change"));
      wrong(!differ(ofRun, picture()), "the ends by hand change no colours");
      const [, set] = viewer.colouring.range;
      upper.value = lower.value;
      upper.dispatchEvent(new Event("change"));
      wrong(viewer.colouring.range[1] !== set, "a range without extent is taken");
    }
    choose("run");
    const group = document.querySelector("#model-group select");
    wrong(Boolean(group) !== (head.model.groups.length > 0), "the choice of a group");
    if (group) {
      group.value = head.model.groups[0].name;
      group.dispatchEvent(new Event("change"));
      picture();
      wrong(!viewer.parts.chosen.visible && !viewer.parts.chosenLines.object.visible, "the chosen group is not drawn");
      group.value = "";
      group.dispatchEvent(new Event("change"));
    }
    const names = document.querySelector("#model-names input");
    wrong(Boolean(names) !== (head.model.signs.length > 0), "the choice of names");
    if (names) {
      const marks = () => [...document.querySelectorAll(".marks path")].filter((path) => path.getAttribute("d")).length;
      const texts = () => [...document.querySelectorAll(".marks text")].filter((text) => text.style.display !== "none");
      if (!names.checked) names.click();
      const marked = head.model.signs.filter(({ what }) => !["body", "contact"].includes(what)).length;
      wrong(!(await until(() => texts().length === head.model.signs.length)), `${texts().length} names, not ${head.model.signs.length}`);
      wrong(marks() !== marked, `${marks()} marks of supports, loads, masses and springs, not ${marked}`);
      const box = viewer.holder.getBoundingClientRect();
      const inside = texts().filter((text) => {
        const { left, top } = text.getBoundingClientRect();
        return left >= box.left && left <= box.right && top >= box.top - 20 && top <= box.bottom;
      });
      wrong(inside.length === 0, "no name is beside the model");
      names.click();
      wrong(!(await until(() => texts().length === 0)), "the names stay");
    }
    const tile = document.querySelector('.tile[data-field="von_mises"]');
    const stress = head.model.frames.findIndex((frame) => frame.kinds.includes("largest stress"));
    wrong(Boolean(tile) !== stress >= 0, "the tile of the largest stress");
    if (tile) {
      viewer.go(stress === 0 ? last : 0);
      viewer.colour("displacement");
      tile.click();
      // that of all steps, of which the kept instant nearest to it is shown
      const nearest = viewer.instants.nearest(Number(tile.dataset.time));
      wrong(viewer.choice.frame !== nearest || viewer.choice.field !== "von_mises", "the tile does not show the largest stress");
      wrong(!viewer.parts.peak.visible, "nothing marks the largest stress");
      const marked = picture();
      viewer.parts.peak.visible = false;
      wrong(!differ(marked, picture()), "the mark of the largest stress is not seen");
      const told = document.getElementById("model-peak")?.textContent ?? "";
      wrong(!told.includes("largest at this instant"), `the largest stress is told as "${told}"`);
    }
    for (const jump of document.querySelectorAll(".jumps button")) jump.click();
    const boxes = [...document.querySelectorAll('#model-settings input[type="checkbox"]')];
    for (const box of boxes) box.click();
    picture();
    for (const box of boxes) box.click();
    const section = document.getElementById("model-section");
    if (section && head.model.triangles.count > 0) {
      const whole = picture();
      section.value = "0";
      section.dispatchEvent(new Event("change"));
      wrong(!differ(whole, picture()), "the section cuts nothing off");
    }
    await pause(100);
  }
  const asked = performance.getEntriesByType("resource").map((entry) => entry.name);
  wrong(asked.length > 0, `the page asks for ${asked.join(", ")}`);
  problems.push(...window.faults);
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = problems.length === 0 ? "GOOD" : problems.map((problem) => `WRONG ${problem}`).join("\n");
  document.body.append(outcome);
})();
