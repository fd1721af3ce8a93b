// The buttons and sliders of the model.

import { digits, prefix, quantity } from "./format.js";

const element = (tag, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
};

const button = (text, title, onclick) => element("button", { type: "button", textContent: text, title, onclick });

function select(label, options, onchange) {
  const choice = element("select", { onchange: (e) => onchange(e.target.value) });
  for (const [value, text] of options) choice.append(element("option", { value, textContent: text }));
  return element("label", {}, `${label} `, choice);
}

function check(label, checked, onchange) {
  const box = element("input", { type: "checkbox", checked, onchange: (e) => onchange(e.target.checked) });
  return element("label", {}, box, ` ${label}`);
}

/** The range of the colours: of the run, of an instant, or two limits that the reader writes, in the unit of the legend. */
function range(viewer) {
  const { choice } = viewer;
  let unit = [1, ""];
  const limit = (name, at) => {
    const input = element("input", {
      type: "number",
      step: "any",
      ariaLabel: `${name} end of the colours`,
      onchange: () => {
        const limits = [...viewer.limits()];
        // an empty box is no number
        limits[at] = input.value === "" ? NaN : Number(input.value) * unit[0];
        if (Number.isFinite(limits[at]) && limits[0] < limits[1]) {
          choice.limits[choice.field] = limits;
          viewer.show();
        }
        fill();
      },
    });
    return input;
  };
  const ends = [limit("lower", 0), limit("upper", 1)];
  const word = element("span");
  const boxes = element("span", { id: "model-limits", hidden: true }, "from ", ends[0], " to ", ends[1], " ", word);
  const fill = () => {
    const look = viewer.colouring;
    boxes.hidden = choice.range !== "hand" || Boolean(look.categories);
    if (boxes.hidden) return;
    const limits = viewer.limits();
    unit = prefix(Math.max(...limits.map(Math.abs)), look.unit);
    // what the reader wrote, without the rounding of the prefix
    ends.forEach((end, k) => (end.value = Number((limits[k] / unit[0]).toPrecision(6))));
    word.textContent = `${unit[1]}${look.unit}`;
  };
  const options = [["run", "of all instants"], ["frame", "of this instant"], ["hand", "by hand"]];
  const choose = select("range", options, (value) => {
    choice.range = value;
    viewer.show();
    fill();
  });
  choose.id = "model-range";
  return { elements: [choose, boxes], fill };
}

/** Builds the controls of a viewer; how it tells them what it shows. */
export function controls(viewer) {
  const { instants, model, parts, choice, page } = viewer;
  const time = document.getElementById("model-time");
  const settings = document.getElementById("model-settings");

  const play = button("▶ play", "play the kept instants", () => viewer.play());
  play.id = "model-play";
  const slider = element("input", {
    type: "range",
    min: 0,
    max: instants.frames.length - 1,
    value: choice.frame,
    ariaLabel: "instant",
    oninput: (e) => viewer.go(Number(e.target.value)),
  });
  const caption = element("output", { id: "model-caption" });
  time.append(play, button("‹", "the instant before", () => viewer.go(choice.frame - 1)), slider);
  time.append(button("›", "the next instant", () => viewer.go(choice.frame + 1)), caption);
  const jumps = element("span", { className: "jumps" });
  instants.frames.forEach((frame, k) => {
    for (const kind of frame.kinds) {
      if (kind === "equal times" || kind === "start") continue;
      jumps.append(button(kind, `go to ${quantity(frame.time, page.abscissa.unit)}`, () => viewer.go(k)));
    }
  });
  time.append(jumps);

  const factor = element("input", {
    type: "number",
    min: 0,
    step: "any",
    value: viewer.factor,
    onchange: (e) => {
      viewer.factor = Math.max(0, Number(e.target.value)) || 0;
      viewer.show();
      viewer.box();
      viewer.fit();
    },
  });
  const colours = select("colour", instants.fields.map((f) => [f.id, f.name]), (id) => viewer.colour(id));
  const limits = range(viewer);
  settings.append(
    colours,
    ...limits.elements,
    element("label", {}, "displacements × ", factor),
  );
  const drawing = (change) => (on) => {
    change(on);
    viewer.render();
  };
  settings.append(
    check("mesh", choice.edges, drawing((on) => parts.toggle(parts.net, on))),
    check("largest value", choice.peak, (on) => {
      choice.peak = on;
      viewer.show();
    }),
    check("undeformed", false, drawing((on) => (parts.ghost.visible = on))),
  );
  const { shown, signs } = viewer.marks;
  const of = (what) => signs.some((sign) => what.includes(sign.what));
  if (of(["support", "load", "mass", "link"])) {
    const title = "supports green, loads red, masses violet, springs and bolts brown; they show through the model";
    const marks = check("supports and loads", shown.marks, drawing((on) => (shown.marks = on)));
    marks.title = title;
    settings.append(marks);
  }
  if (signs.length > 0) {
    const names = check("names", shown.names, drawing((on) => (shown.names = on)));
    names.id = "model-names";
    settings.append(names);
  }
  if (model.groups.length > 0) {
    const names = model.groups.map((group) => [group.name, group.name]);
    const group = select("group", [["", "none"], ...names], (name) => {
      parts.choose(viewer.read, name);
      viewer.render();
    });
    group.title = "a group of the mesh, in violet";
    group.id = "model-group";
    settings.append(group);
  }
  if (model.contacts.length > 0) {
    const title = "secondary side red, primary side blue";
    const surfaces = check("contact surfaces", false, drawing((on) => {
      shown.contacts = on;
      parts.toggle(parts.surfaces, on);
    }));
    surfaces.title = title;
    settings.append(surfaces, check("contact forces", true, drawing((on) => parts.toggle(parts.forces, on))));
  }
  if (model.obstacles.length > 0) {
    settings.append(check("obstacles", true, drawing((on) => (parts.obstacles.visible = on))));
  }
  if (model.dimension === 3) {
    const section = { axis: null, part: 0.5, flip: false };
    const cut = () => viewer.cut(section.axis, section.part, section.flip);
    const place = element("input", {
      type: "range",
      min: 0,
      max: 1,
      step: 0.005,
      value: 0.5,
      disabled: true,
      ariaLabel: "place of the section",
      oninput: (e) => {
        section.part = Number(e.target.value);
        cut();
      },
    });
    const axes = select("section", [["", "none"], ["0", "x"], ["1", "y"], ["2", "z"]], (axis) => {
      section.axis = axis === "" ? null : Number(axis);
      place.disabled = section.axis === null;
      cut();
    });
    axes.firstElementChild.id = "model-section";
    settings.append(axes, place, check("other side", false, (on) => {
      section.flip = on;
      cut();
    }));
    const views = element("span", {}, "view ");
    for (const side of ["oblique", "x", "y", "z"]) views.append(button(side, `look along ${side}`, () => viewer.look(side)));
    settings.append(views);
  } else {
    settings.append(button("whole model", "show the whole model", () => viewer.look("front")));
  }

  return {
    at(still, frame) {
      slider.value = frame;
      const kinds = still.kinds.filter((kind) => kind !== "equal times");
      const reason = kinds.length > 0 ? ` – ${kinds.join(", ")}` : "";
      const scale = viewer.factor === 1 ? "" : ` – displacements × ${digits(viewer.factor)}`;
      caption.textContent = `${quantity(still.time, page.abscissa.unit, 5)}${reason}${scale}`;
    },
    coloured(field) {
      colours.firstElementChild.value = field;
      limits.fill();
    },
    playing(on) {
      play.textContent = on ? "❚❚ stop" : "▶ play";
    },
  };
}
