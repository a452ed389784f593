// Draws the panels that interactive.py states as data: SVG that fits its place, tells the nearest point, and is
// enlarged by dragging. Panels of one name in `link` are enlarged together.
const FONT = 12, LINE = 15, PAD = 6, REACH = 30;  // [pixel]; how far from a point a pointer may be
const GRID = "#e2e2e2", FRAME = "#444", INK = "#222";
const DASHES = { solid: "", dash: "9 4", dashdot: "9 3 2 3", dot: "2 3", longdash: "15 5", longdashdot: "15 4 2 4" };

const pen = document.createElement("canvas").getContext("2d");
pen.font = `${FONT}px system-ui, sans-serif`;
const widthOf = (words) => Math.max(0, ...words.split("\n").map((line) => pen.measureText(line).width));

function element(parent, name, attributes = {}, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) if (value !== "") made.setAttribute(key, value);
  if (text) made.textContent = text;
  parent.append(made);
  return made;
}

// words of several lines; `y` is the baseline of the first
function words(parent, text, attributes) {
  const made = element(parent, "text", { "font-size": FONT, fill: INK, ...attributes });
  text.split("\n").forEach((line, i) => element(made, "tspan", { x: attributes.x, dy: i ? LINE : 0 }, line));
  return made;
}

function wrapped(text, width) {
  const lines = [];
  for (const word of text.split(" ")) {
    const longer = lines.length ? `${lines.at(-1)} ${word}` : word;
    if (lines.length && widthOf(longer) <= width) lines[lines.length - 1] = longer; else lines.push(word);
  }
  return lines.join("\n");
}

function numbers(text) {
  return new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
}

function said(value, digits = 4) {
  const short = Number(value.toPrecision(digits));
  const exponent = short && Math.floor(Math.log10(Math.abs(short)));
  const text = exponent < -4 || exponent > 5 ? short.toExponential().replace("e+", "e") : String(short);
  return text.replaceAll("-", "−");
}

// -- scales and their ticks

// maps values of an axis, whose ends in its own measure (the exponent on a logarithmic one) are given, to pixels
function scaleOf(axis, ends, from, to) {
  const own = (value) => (axis.log ? Math.log10(value) : value);
  const scale = (value) => from + (own(value) - ends[0]) / (ends[1] - ends[0]) * (to - from);
  scale.back = (pixel) => ends[0] + (pixel - from) / (to - from) * (ends[1] - ends[0]);
  return scale;
}

function ticksOf(axis, ends, count) {
  const [low, high] = [Math.min(...ends), Math.max(...ends)], slack = 1e-6 * (high - low);
  if (axis.ticks.length) {
    const own = (value) => (axis.log ? Math.log10(value) : value);
    return axis.ticks.filter(([value]) => own(value) >= low - slack && own(value) <= high + slack);
  }
  if (axis.log && high - low >= 1) {
    const step = Math.ceil((high - low) / count), powers = [];
    for (let n = Math.ceil(low - slack); n <= high + slack; n++) if (n % step === 0) powers.push(n);
    const plain = powers.every((n) => n >= -3 && n <= 4);
    return powers.map((n) => [10 ** n, plain ? said(10 ** n) : power(n)]);
  }
  const [first, last] = axis.log ? [10 ** low, 10 ** high] : [low, high];
  const rough = (last - first) / count, decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find((factor) => factor * decade >= rough);
  const found = [];
  for (let n = Math.ceil(first / step - 1e-6); n * step <= last + 1e-6 * step; n++) found.push([n * step, said(n * step, 6)]);
  return found.length > 1 || count > 16 ? found : ticksOf(axis, ends, 2 * count);  // one mark shows no scale
}

function power(n) {
  return `10${[...String(n)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻").join("")}`;
}

// -- marks

function polygon(corners, turn, inner = 1) {
  const points = Array.from({ length: inner < 1 ? 2 * corners : corners }, (_, i, all) => {
    const angle = turn + 2 * Math.PI * i / (inner < 1 ? 2 * corners : corners), r = i % 2 ? inner : 1;
    return [r * Math.sin(angle), -r * Math.cos(angle)];
  });
  return (x, y, r) => points.map(([u, v], i) => `${i ? "L" : "M"}${x + r * u} ${y + r * v}`).join("") + "Z";
}
const cross = (turn) => (x, y, r) => [0, 1].map((i) => {
  const u = r * Math.cos(turn + i * Math.PI / 2), v = r * Math.sin(turn + i * Math.PI / 2);
  return `M${x - u} ${y - v}L${x + u} ${y + v}`;
}).join("");
const plus = (turn) => {
  const arm = 0.35, shape = [];
  for (let i = 0; i < 4; i++) for (const [u, v] of [[-arm, -1], [arm, -1], [arm, -arm]]) {
    const angle = turn + i * Math.PI / 2;
    shape.push([u * Math.cos(angle) - v * Math.sin(angle), u * Math.sin(angle) + v * Math.cos(angle)]);
  }
  return (x, y, r) => shape.map(([u, v], i) => `${i ? "L" : "M"}${x + r * u} ${y + r * v}`).join("") + "Z";
};
const MARKS = {
  circle: (x, y, r) => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`,
  square: polygon(4, Math.PI / 4), diamond: polygon(4, 0), pentagon: polygon(5, 0), hexagon: polygon(6, 0),
  "triangle-up": polygon(3, 0), "triangle-right": polygon(3, Math.PI / 2), "triangle-down": polygon(3, Math.PI),
  "triangle-left": polygon(3, -Math.PI / 2), star: polygon(5, 0, 0.45), cross: plus(0), x: plus(Math.PI / 4),
  "cross-thin": cross(0), "x-thin": cross(Math.PI / 4),
};

// -- layers: each draws itself and adds to `near` what a pointer finds, with words that are made when it does

const LAYERS = {
  line(at, layer, near) {
    const { x, y, style } = layer, n = x.length;
    const look = { stroke: style.colour, opacity: layer.opacity, fill: "none" };
    const pixels = Array.from(x, (value, i) => [at.x(value), at.y(y[i])]);
    const seen = pixels.map(([u, v]) => Number.isFinite(u) && Number.isFinite(v));
    if (style.dash !== "none") {
      let path = "";
      for (let i = 0; i < n; i++) {
        if (!seen[i]) continue;
        const [u, v] = pixels[i], begins = !i || !seen[i - 1];
        path += begins ? `M${u.toFixed(1)} ${v.toFixed(1)}` : `${layer.steps ? `H${u.toFixed(1)}` : ""}L${u.toFixed(1)} ${v.toFixed(1)}`;
      }
      element(at.inside, "path", { ...look, d: path, class: "mark", "stroke-width": layer.width,
        "stroke-dasharray": DASHES[style.dash], "stroke-linejoin": "round" });
    }
    if (style.symbol) {
      const paths = { filled: "", open: "" }, r = 0.7 * layer.size;
      for (let i = 0; i < n; i++) if (seen[i]) {
        paths[layer.open[i % layer.open.length] ? "open" : "filled"] += MARKS[style.symbol](...pixels[i], r);
      }
      const place = layer.clip ? at.inside : at.above;
      if (paths.filled) element(place, "path", { ...look, d: paths.filled, class: "mark", fill: style.colour });
      if (paths.open) element(place, "path", { ...look, d: paths.open, class: "mark", fill: "white", "stroke-width": 1.2 });
    }
    pixels.forEach((place, i) => seen[i] && near.push({ place, value: x[i], text: () => [
      `${said(y[i])}${at.units[1]} at ${said(x[i])}${at.units[0]}`, layer.name, layer.notes[i]] }));
  },
  band(at, layer) {
    const { x, low, high } = layer, points = [];
    x.forEach((value, i) => points.push(`${at.x(value).toFixed(1)},${at.y(high[i]).toFixed(1)}`));
    for (let i = x.length - 1; i >= 0; i--) points.push(`${at.x(x[i]).toFixed(1)},${at.y(low[i]).toFixed(1)}`);
    element(at.inside, "polygon", { points: points.filter((p) => !p.includes("NaN")).join(" "), fill: layer.colour, class: "mark" });
  },
  bars(at, layer, near) {
    layer.places.forEach((place, i) => {
      const [a, b] = [at.x(layer.start[i]), at.x(layer.end[i])], [top, bottom] = [at.y(place + 0.39), at.y(place - 0.39)];
      const box = { x: Math.min(a, b), y: Math.min(top, bottom), width: Math.abs(b - a), height: Math.abs(bottom - top) };
      element(at.inside, "rect", { ...box, fill: layer.colours[i], class: "mark" });
      if (layer.hatch) element(at.inside, "rect", { ...box, fill: `url(#${at.hatch(layer.hatch)})` });
      if (layer.texts[i]) words(at.above, layer.texts[i], { x: Math.max(a, b) + 4, y: (top + bottom) / 2 + 4 });
      near.push({ box, text: () => [`${said(layer.end[i], 3)}${at.units[0]}`, layer.name] });
    });
  },
  rule(at, layer) {
    const { left, right, top, bottom } = at.frame, upright = layer.axis === "x", scale = upright ? at.x : at.y;
    const place = scale(layer.at), look = { stroke: layer.colour, "stroke-dasharray": DASHES[layer.dash], class: "mark" };
    if (layer.until !== null) {
      const [a, b] = [place, scale(layer.until)].sort((u, v) => u - v);
      const box = upright ? { x: a, y: top, width: b - a, height: bottom - top } : { x: left, y: a, width: right - left, height: b - a };
      element(at.inside, "rect", { ...box, fill: layer.colour, class: "mark" });
    } else {
      const line = upright ? { x1: place, x2: place, y1: top, y2: bottom } : { x1: left, x2: right, y1: place, y2: place };
      element(at.inside, "line", { ...line, ...look });
    }
    const shown = upright ? place >= left && place <= right : place >= top && place <= bottom;
    if (!layer.text || !shown) return;
    // beside an upright line, on the other side where there is no room
    let side = layer.side === "left" ? -1 : 1;
    if (upright && (side < 0 ? place - left : right - place) < widthOf(layer.text) + PAD) side = -side;
    const where = upright
      ? { x: place + 4 * side, y: top + LINE, "text-anchor": side < 0 ? "end" : "start" }
      : { x: side < 0 ? left + 4 : right - 4, y: place - 4, "text-anchor": side < 0 ? "start" : "end" };
    words(at.above, layer.text, { ...where, class: "halo" });
  },
  text(at, layer) {
    const anchor = { left: "start", center: "middle", right: "end" }[layer.anchor];
    words(at.inside, layer.text, { x: at.x(layer.x), y: at.y(layer.y) - 3, fill: layer.colour, "text-anchor": anchor, class: "halo" });
  },
  heat(at, layer, near) {
    const paths = new Map(), u = Array.from(layer.x, at.x), v = Array.from(layer.y, at.y), columns = u.length - 1;
    layer.cells.forEach((colour, i) => {
      const column = i % columns, row = Math.floor(i / columns);
      const box = { x: u[column], y: Math.min(v[row], v[row + 1]), width: u[column + 1] - u[column], height: Math.abs(v[row + 1] - v[row]) };
      if (colour >= 0) paths.set(colour, `${paths.get(colour) || ""}M${box.x} ${box.y}h${box.width}v${box.height}h${-box.width}z`);
      near.push({ box, text: () => layer.said(column, row, i) });
    });
    paths.forEach((d, colour) => element(at.inside, "path", { d, fill: layer.palette[colour], class: "mark", "shape-rendering": "crispEdges" }));
    layer.written.forEach((text, i) => {
      const column = i % columns, row = Math.floor(i / columns);
      words(at.inside, text, { x: (u[column] + u[column + 1]) / 2, y: (v[row] + v[row + 1]) / 2 + 4, "text-anchor": "middle",
        fill: isDark(layer.palette[layer.cells[i]] || "#ffffff") ? "white" : INK });
    });
  },
};
function isDark(colour) {
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
  return 0.3 * r + 0.6 * g + 0.1 * b < 128;
}

// numbers of the layers, from base64
function opened(panel) {
  for (const layer of panel.layers) {
    for (const key of ["x", "y", "low", "high", "places", "start", "end"]) if (typeof layer[key] === "string") layer[key] = numbers(layer[key]);
    if (layer.kind !== "heat") continue;
    const values = numbers(layer.values), names = (axis, centres) => Array.from(centres, (value) => {
      const tick = axis.ticks.find(([place]) => Math.abs(place - value) < 1e-6 * Math.max(1, Math.abs(value)));
      return `${axis.title}: ${tick ? tick[1].replace("\n", " ") : said(value)}`;
    });
    const [x, y] = [names(panel.x, numbers(layer.centres[0])), names(panel.y, numbers(layer.centres[1]))];
    layer.cells = Array.from(atob(layer.cells), (c) => c.charCodeAt(0)).map((colour) => (colour === 255 ? -1 : colour));
    layer.said = (column, row, i) => [x[column], y[row],
      `${layer.title}: ${Number.isFinite(values[i]) ? said(values[i], 3) : layer.gaps[layer.cells[i]] || "none"}`];
  }
  return panel;
}

// ends of an axis in its own measure, from what is drawn where they are not given
function endsOf(panel, name) {
  const axis = panel[name], own = (value) => (axis.log ? Math.log10(value) : value), found = [Infinity, -Infinity];
  const add = (value) => {
    const place = own(value);
    if (Number.isFinite(place)) { found[0] = Math.min(found[0], place); found[1] = Math.max(found[1], place); }
  };
  for (const layer of panel.layers) {
    if (layer.kind === "line" || layer.kind === "heat") layer[name].forEach(add);
    else if (layer.kind === "band") (name === "x" ? [layer.x] : [layer.low, layer.high]).forEach((each) => each.forEach(add));
    else if (layer.kind === "bars" && name === "x") [layer.start, layer.end].forEach((each) => each.forEach(add));
    else if (layer.kind === "bars") layer.places.forEach((place) => { add(place - 0.5); add(place + 0.5); });
    else if (layer.kind === "rule" && layer.axis === name) add(layer.at);
  }
  if (found[0] > found[1]) found.splice(0, 2, 0, 1);
  const heat = panel.layers.some((layer) => layer.kind === "heat");
  const margin = heat || (panel.link && name === "x") ? 0 : 0.04 * (found[1] - found[0]) || 0.5;
  const below = found[0] === 0 && !axis.log ? 0 : margin;
  const ends = [axis.low === null ? found[0] - below : own(axis.low), axis.high === null ? found[1] + margin : own(axis.high)];
  if (ends[0] >= ends[1]) ends[1] = ends[0] + 1;
  return axis.reverse ? ends.reverse() : ends;
}

class Chart {
  constructor(place) {
    this.place = place;
    this.panel = opened(JSON.parse(place.querySelector("script").textContent));
    this.hidden = new Set();
    this.linked = [this];
    this.reset();
    this.sheet = element(place, "svg", { role: "img", "aria-label": `${this.panel.y.title} over ${this.panel.x.title}` });
    this.tip = place.appendChild(Object.assign(document.createElement("div"), { className: "tip", hidden: true }));
    this.whole = place.appendChild(Object.assign(document.createElement("button"), { className: "whole", textContent: "whole", hidden: true }));
    this.whole.addEventListener("click", () => this.enlarge(null, null));
    this.legend();
    this.listen();
    this.draw();
    // a figure that is folded has no width until it is opened
    const again = () => { if (place.clientWidth !== this.width) this.draw(); };
    new ResizeObserver(() => requestAnimationFrame(again)).observe(place);
  }

  reset() { this.ends = { x: endsOf(this.panel, "x"), y: endsOf(this.panel, "y") }; }

  legend() {
    const list = this.place.appendChild(Object.assign(document.createElement("div"), { className: "legend" }));
    for (const { name, colour, dash, symbol, width } of this.panel.legend) {
      const entry = list.appendChild(Object.assign(document.createElement("button"), { type: "button", title: "click to hide" }));
      const mark = element(entry, "svg", { width: 26, height: 12 });
      if (dash && dash !== "none") element(mark, "line", { x1: 0, x2: 26, y1: 6, y2: 6, stroke: colour, "stroke-width": width, "stroke-dasharray": DASHES[dash] });
      if (symbol) element(mark, "path", { d: MARKS[symbol](13, 6, 4.5), fill: colour, stroke: colour });
      if (!dash && !symbol) element(mark, "rect", { x: 4, y: 0, width: 18, height: 12, fill: colour, stroke: "#bbb" });
      entry.append(name);
      entry.addEventListener("click", () => {
        if (!this.hidden.delete(name)) this.hidden.add(name);
        entry.classList.toggle("off");
        this.draw();
      });
    }
    if (this.panel.more) list.append(`and ${this.panel.more} more`);
  }

  draw() {
    const { panel, sheet } = this, width = this.width = this.place.clientWidth;
    if (!width) return;
    sheet.replaceChildren();
    const height = panel.height;
    const yTitle = wrapped(panel.y.title, height - 40), xTitle = wrapped(panel.x.title, width - 60);
    const yTicks = ticksOf(panel.y, this.ends.y, Math.max(2, Math.floor(height / 50)))
      .map(([value, text]) => [value, widthOf(text) > 0.36 * width ? wrapped(text, 0.36 * width) : text]);
    const lines = (text) => text.split("\n").length;
    const side = (ticks, title) => Math.max(0, ...ticks.map(([, text]) => widthOf(text))) + (title ? LINE * lines(title) : 0) + 12;
    const left = Math.max(panel.left || 0, side(yTicks, yTitle));  // as far as a panel below it begins
    const [second, factor] = panel.second || [null, 1];
    const beside = second && this.ends.y.map((end) => (panel.y.log ? end + Math.log10(factor) : factor * end));
    const secondTicks = second ? ticksOf(second, beside, Math.max(2, Math.floor(height / 50))) : [];
    const secondTitle = second && wrapped(second.title, height - 40);
    const afterBars = Math.max(0, ...panel.layers.flatMap((layer) => layer.texts || []).map(widthOf)) && !panel.x.high;
    const right = width - (second ? side(secondTicks, secondTitle) : afterBars ? 60 : 14);
    const few = ticksOf(panel.x, this.ends.x, Math.max(2, Math.floor((right - left) / 65)));
    const bottom = height - LINE * (Math.max(1, ...few.map(([, text]) => lines(text))) + lines(xTitle)) - 12;
    const frame = { left, right, top: 8, bottom };

    let { x: xEnds, y: yEnds } = this.ends;
    if (panel.equal) {
      const share = [Math.abs(xEnds[1] - xEnds[0]) / (right - left), Math.abs(yEnds[1] - yEnds[0]) / (bottom - frame.top)];
      const grown = (ends, by) => ends.map((end) => (ends[0] + ends[1]) / 2 + (end - (ends[0] + ends[1]) / 2) * by);
      [xEnds, yEnds] = [grown(xEnds, Math.max(...share) / share[0]), grown(yEnds, Math.max(...share) / share[1])];
    }
    sheet.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const id = this.place.id;
    const clip = element(element(sheet, "defs"), "clipPath", { id: `${id}-clip` });
    element(clip, "rect", { x: left, y: frame.top - 1, width: Math.max(0, right - left), height: bottom - frame.top + 2 });
    element(sheet, "rect", { x: left, y: frame.top, width: Math.max(0, right - left), height: bottom - frame.top, fill: panel.ground });
    const at = this.at = {
      frame, x: scaleOf(panel.x, xEnds, left, right), y: scaleOf(panel.y, yEnds, bottom, frame.top), units: [panel.x.unit, panel.y.unit],
      hatch: (kind) => hatched(sheet, id, kind),
    };
    const maps = panel.layers.some((layer) => layer.kind === "heat");
    const grid = (values) => (maps ? { stroke: "none" } : values);
    let free = -Infinity;  // right end of the last words below the axis
    for (const [value, text] of panel.equal ? ticksOf(panel.x, xEnds, Math.max(2, Math.floor((right - left) / 65))) : few) {
      const u = at.x(value), half = widthOf(text) / 2;
      element(sheet, "line", { x1: u, x2: u, y1: frame.top, y2: bottom, ...grid({ stroke: GRID }) });
      element(sheet, "line", { x1: u, x2: u, y1: bottom, y2: bottom + 4, stroke: FRAME });
      const middle = Math.min(Math.max(u, half), width - half);
      if (middle - half < free + 4) continue;
      free = middle + half;
      words(sheet, text, { x: middle, y: bottom + LINE + 2, "text-anchor": "middle" });
    }
    for (const [value, text] of panel.equal ? ticksOf(panel.y, yEnds, Math.max(2, Math.floor(height / 50))) : yTicks) {
      const v = at.y(value);
      element(sheet, "line", { x1: left, x2: right, y1: v, y2: v, ...grid({ stroke: GRID }) });
      words(sheet, text, { x: left - 5, y: v + 4 - LINE * (lines(text) - 1) / 2, "text-anchor": "end" });
    }
    if (second) {
      const scale = scaleOf(second, beside, bottom, frame.top);
      for (const [value, text] of secondTicks) {
        element(sheet, "line", { x1: right, x2: right + 4, y1: scale(value), y2: scale(value), stroke: FRAME });
        words(sheet, text, { x: right + 6, y: scale(value) + 4 });
      }
      element(sheet, "line", { x1: right, x2: right, y1: frame.top, y2: bottom, stroke: FRAME });
      this.upright(secondTitle, width - LINE * (lines(secondTitle) - 1) - 4, "second");
    }
    element(sheet, "path", { d: `M${left} ${frame.top}V${bottom}H${right}`, stroke: FRAME, fill: "none" });
    words(sheet, xTitle, { x: (left + right) / 2, y: height - LINE * (lines(xTitle) - 1) - 5, "text-anchor": "middle", "data-axis": "x" });
    this.upright(yTitle, FONT, "y");

    at.inside = element(sheet, "g", { "clip-path": `url(#${id}-clip)` });
    at.above = element(sheet, "g");
    this.near = [];
    for (const layer of panel.layers) if (!this.hidden.has(layer.name)) LAYERS[layer.kind](at, layer, this.near);
    this.pin = element(sheet, "line", { y1: frame.top, y2: bottom, stroke: "#888", visibility: "hidden" });
    this.chosen = element(sheet, "rect", { fill: "#0072b2", opacity: 0.15, visibility: "hidden" });
  }

  upright(title, x, name) {
    const { top, bottom } = this.at.frame, middle = (top + bottom) / 2;
    words(this.sheet, title, { x: -middle, y: x, transform: "rotate(-90)", "text-anchor": "middle", "data-axis": name });
  }

  // ends in the measures of the axes; null is the whole, undefined stays
  enlarge(x, y) {
    for (const chart of this.linked) {
      const whole = { x: endsOf(chart.panel, "x"), y: endsOf(chart.panel, "y") };
      if (x !== undefined) chart.ends.x = x || whole.x;
      if (y !== undefined && (chart === this || !y)) chart.ends.y = y || whole.y;
      chart.whole.hidden = String([chart.ends.x, chart.ends.y]) === String([whole.x, whole.y]);
      chart.draw();
    }
  }

  listen() {
    const { sheet } = this;
    let start = null;
    const here = (event) => {
      const edges = sheet.getBoundingClientRect();
      return [event.clientX - edges.left, event.clientY - edges.top];
    };
    sheet.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "touch" || event.button) return;  // a finger scrolls the page
      start = here(event);
      sheet.setPointerCapture(event.pointerId);
    });
    sheet.addEventListener("pointermove", (event) => {
      const [u, v] = here(event);
      if (!start) { this.tell(u, v); return; }
      const [box] = [this.selected(start, [u, v])];
      for (const [key, value] of Object.entries(box)) this.chosen.setAttribute(key, value);
      this.chosen.setAttribute("visibility", "visible");
    });
    sheet.addEventListener("pointerup", (event) => {
      if (!start) return;
      const box = this.selected(start, here(event)), { top, bottom, left, right } = this.at.frame;
      start = null;
      this.chosen.setAttribute("visibility", "hidden");
      const across = box.width < right - left && box.width > PAD, along = box.height < bottom - top && box.height > PAD;
      if (!across && !along) return;
      const ends = (scale, a, b, axis) => { const found = [scale.back(a), scale.back(b)].sort((p, q) => p - q); return axis.reverse ? found.reverse() : found; };
      this.enlarge(across ? ends(this.at.x, box.x, box.x + box.width, this.panel.x) : undefined,
        along ? ends(this.at.y, box.y, box.y + box.height, this.panel.y) : undefined);
    });
    sheet.addEventListener("dblclick", () => this.enlarge(null, null));
    sheet.addEventListener("pointerleave", () => this.tell(-1e6, -1e6));
  }

  // what dragging selects: a stretch of one axis where the other has hardly changed
  selected([a, b], [u, v]) {
    const { left, right, top, bottom } = this.at.frame, within = (value, low, high) => Math.min(Math.max(value, low), high);
    const [x0, x1] = [a, u].map((value) => within(value, left, right)).sort((p, q) => p - q);
    const [y0, y1] = [b, v].map((value) => within(value, top, bottom)).sort((p, q) => p - q);
    const wide = x1 - x0 > 3 * (y1 - y0) || y1 - y0 < 3 * PAD, tall = y1 - y0 > 3 * (x1 - x0) || x1 - x0 < 3 * PAD;
    return { x: tall ? left : x0, width: tall ? right - left : x1 - x0, y: wide ? top : y0, height: wide ? bottom - top : y1 - y0 };
  }

  tell(u, v) {
    let best = null, distance = REACH ** 2;
    for (const each of this.near || []) {
      const away = each.box
        ? (u >= each.box.x && u <= each.box.x + each.box.width && v >= each.box.y && v <= each.box.y + each.box.height ? 0 : Infinity)
        : (each.place[0] - u) ** 2 + (each.place[1] - v) ** 2;
      if (away < distance) { best = each; distance = away; }
    }
    for (const chart of this.linked) {
      if (!chart.pin) continue;
      const place = best && best.value !== undefined && chart.panel.link ? chart.at.x(best.value) : NaN;
      chart.pin.setAttribute("visibility", Number.isFinite(place) ? "visible" : "hidden");
      if (Number.isFinite(place)) { chart.pin.setAttribute("x1", place); chart.pin.setAttribute("x2", place); }
    }
    this.tip.hidden = !best;
    if (!best) return;
    this.tip.textContent = best.text().filter(Boolean).join("\n");
    const [x, y] = best.place || [u, v];
    this.tip.style.left = `${Math.max(0, Math.min(x + 10, this.width - this.tip.offsetWidth))}px`;
    this.tip.style.top = `${y > this.tip.offsetHeight + 14 ? y - this.tip.offsetHeight - 10 : y + 14}px`;
  }
}

function hatched(sheet, chart, kind) {
  const id = `${chart}-hatch-${["/", "x", "."].indexOf(kind)}`;
  if (document.getElementById(id)) return id;
  const pattern = element(sheet.querySelector("defs"), "pattern", { id, width: 7, height: 7, patternUnits: "userSpaceOnUse" });
  const d = { "/": "M0 7L7 0", x: "M0 0L7 7M0 7L7 0", ".": "M3 3h1" }[kind];
  element(pattern, "path", { d, stroke: "white", "stroke-width": kind === "." ? 2 : 1 });
  return id;
}

function drawCharts(root) {
  const charts = Array.from(root.querySelectorAll(".chart"), (place) => new Chart(place)), groups = new Map();
  for (const chart of charts) if (chart.panel.link) groups.set(chart.panel.link, [...(groups.get(chart.panel.link) || []), chart]);
  groups.forEach((group) => group.forEach((chart) => { chart.linked = group; }));
}
drawCharts(document);
