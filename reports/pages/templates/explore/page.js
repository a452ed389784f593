// The page: sliders state a problem, a worker solves it, and the view, the graphs and the map show it.
(function explore() {
  const root = document.getElementById("explore"), find = (name) => root.querySelector(`[data-part="${name}"]`);
  const given = JSON.parse(document.getElementById("given").textContent), records = given.records, DEG = 180 / Math.PI, GRAVITY = given.gravity;
  const doubles = (text) => text && new Float64Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const motions = records.map(({ x, y, z, dt }) => ({ x: doubles(x), y: doubles(y), z: doubles(z), dt }));
  const peaks = motions.map(({ x, y }) => x.reduce((most, value, i) => Math.max(most, Math.hypot(value, y[i])), 0) / GRAVITY);
  const BLUE = "#0072B2", RED = "#B00020", ORANGE = "#D55E00", GREY = "#8a8a8a", AGREEMENT = 0.01, SLIPS = 0.05;  // of alpha; of the time in motion

  // -- the problem: what each slider states, between the bounds of its number; out of them nothing is computed

  const standard = given.state, state = { ...standard }, fields = {};
  for (const field of root.querySelectorAll(".field")) {
    const name = field.dataset.field, [number, slider] = field.querySelectorAll("input"), [low, high] = [Number(number.min), Number(number.max)];
    const log = "log" in slider.dataset, to = (value) => (log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low)) * 1000;
    const rounded = (value, digits) => Math.min(Math.max(Number(value.toPrecision(digits)), low), high);
    const from = (share) => rounded(log ? low * (high / low) ** (share / 1000) : low + (high - low) * share / 1000, 4);
    slider.addEventListener("input", () => { state[name] = number.value = from(Number(slider.value)); slider.ariaValueText = number.value; changed(); });
    number.addEventListener("input", () => {
      if (number.validity.valid) { state[name] = Number(number.value); slider.value = to(state[name]); slider.ariaValueText = number.value; }
      changed();
    });
    const show = () => { number.value = rounded(state[name], 5); slider.value = to(state[name]); slider.ariaValueText = number.value; };
    fields[name] = { field, low, high, show };
  }
  for (const name of ["record", "support"]) {
    find(name).addEventListener("change", () => { state[name] = name === "record" ? Number(find(name).value) : find(name).value; changed(); });
  }

  // what the model takes, which has no tendon on flat ground
  const problemOf = (at) => {
    const released = at.record < 0, tendon = at.support !== "flat", lean = at.support === "planar" ? at.plane : at.lean;
    return {
      height: at.height, diameter: at.diameter, gamma: at.slab, delta: Math.min(at.loss / 1000, 0.05 * at.diameter), gravity: GRAVITY,
      prestress: tendon ? at.prestress : 0, stiffness: tendon ? at.stiffness : 0, yielding: tendon ? at.yielding : 0, support: at.support, azimuth: at.plane / DEG,
      release: released ? { tilt: at.tilt / DEG, azimuth: lean / DEG, rate: at.support === "planar" ? 0 : at.rate } : null,
      friction: at.friction, record: at.record, intensity: at.intensity, factors: at.factors, duration: released ? given.free : given.duration || (motions[at.record].x.length - 1) * motions[at.record].dt,
    };
  };

  // -- the address holds what differs from the standard

  const differing = () => Object.fromEntries(Object.entries(state).filter(([name, value]) => value !== standard[name]));
  const readAddress = () => {
    Object.assign(state, standard);
    for (const [name, text] of new URLSearchParams(location.hash.slice(1))) {
      const value = Number(text), field = fields[name];
      if (field && text !== "" && value >= field.low && value <= field.high) state[name] = value;
      else if (name === "record" && (value === -1 || records[value])) state.record = value;
      else if (name === "support" && [...find("support").options].some((option) => option.value === text)) state.support = text;
    }
  };
  let addressTimer = 0;
  const writeAddress = () => {
    clearTimeout(addressTimer);  // browsers allow few changes a second
    addressTimer = setTimeout(() => history.replaceState(null, "", `#${new URLSearchParams(differing())}`), 300);
  };
  addEventListener("hashchange", () => { readAddress(); showFields(); changed(); });

  // -- runs: a worker has one request at a time, and the newest one next; what is compared has a worker of its own

  const source = document.getElementById("model").textContent, address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  const workerOf = (answer) => {
    const worker = new Worker(address);
    worker.onmessage = answer;
    worker.postMessage({ motions });
    return worker;
  };
  const solverOf = (requestOf, done) => {
    let solving = null, waiting = null;
    const worker = workerOf(({ data }) => {
      const at = solving;
      solving = null;
      if (waiting) ask(waiting);
      done(at, data);
    });
    const ask = (at) => {
      waiting = solving ? at : null;
      if (solving) return;
      solving = at;
      worker.postMessage(requestOf(at));
    };
    return ask;
  };
  const runOf = (at) => ({ problem: problemOf(at) });
  // two horizontal components, or tilt and rate of a release, each as given and 1 % more or less
  const FACTORS = [0.99, 1, 1.01].flatMap((one) => [0.99, 1, 1.01].map((other) => [one, other])).filter(([one, other]) => one !== 1 || other !== 1);
  const copiesOf = (at) => ({
    problems: FACTORS.map(([one, other]) => problemOf({ ...at, factors: [one, other], tilt: at.tilt * one, rate: at.rate * other })),
  });
  let bodies = [], pinned = null, frame = 0;
  const besideOf = (at) => ({
    pinned, stronger: { ...at, intensity: at.intensity * (1 + 1e-6), tilt: at.record < 0 ? at.tilt * (1 + 1e-6) : at.tilt },
    planar: { ...at, support: "planar" }, other: { ...at, support: at.support === "flat" ? "recess" : "flat" },
  })[find("beside").value];
  const outOfRange = () => root.querySelector(".field:not([hidden]) input:invalid");
  // both are drawn once where they come before the same frame
  const showSoon = () => { frame ||= requestAnimationFrame(() => { frame = 0; if (!outOfRange()) show(); }); };
  const solve = solverOf(runOf, (at, { run }) => { bodies[0] = bodyOf(at, run, run.outcome === "overturned" ? RED : BLUE, 1); solveCopies(at); showSoon(); });
  const solveCopies = solverOf(copiesOf, (at, { peaks: ends }) => { if (bodies[0].at === at) { bodies[0].copies = ends; showSoon(); } });
  const solveBeside = solverOf(runOf, (at, { run }) => {
    if (find("beside").value) bodies[1] = bodyOf(at, run, GREY, 0.4);
    if (bodies[0]) showSoon();
  });
  const changed = () => {
    const at = { ...state }, beside = besideOf(at), released = at.record < 0;
    for (const name of ["ground", "map"]) root.querySelector(`.graph.${name}`).hidden = released;
    const hide = { intensity: released, tilt: !released, rate: !released || at.support === "planar", lean: !released || at.support === "planar", plane: at.support !== "planar", friction: at.support !== "flat" };
    for (const [name, hidden] of Object.entries(hide)) {
      fields[name].field.hidden = hidden;
      if (hidden) fields[name].show();
    }
    const wrong = outOfRange();
    for (const part of root.querySelectorAll("[data-of-run]")) part.inert = Boolean(wrong);
    if (wrong) {
      const { title, range } = wrong.closest(".field").dataset;
      say(`Nothing is computed: ${title} must be from ${range}`, "undecided");
      find("follows").textContent = "";
      clock.pause();
      return;
    }
    find("follows").textContent = `R = ${number(Math.hypot(at.height, at.diameter) / 2)} m, tan α = ${number(at.diameter / at.height)}; beyond the tilt α = ${number(Math.atan2(at.diameter, at.height) * DEG)}° the weight overturns it`;
    const refused = (at.prestress || at.stiffness) && at.support === "flat";
    find("refused").textContent = refused ? "The tendon is left out: the model has none on flat ground." : "";
    solve(at);
    if (beside) solveBeside(beside); else bodies.length = Math.min(bodies.length, 1);
    writeAddress();
    askMap(at);
    find("text").hidden = true;
  };
  const showFields = () => {
    for (const field of Object.values(fields)) field.show();
    find("record").value = state.record; find("support").value = state.support;
  };
  const number = (value, digits = 3) => (value === 0 ? "0" : Math.abs(value) >= 1000 ? value.toFixed(0) : String(Number(value.toPrecision(digits)))).replace("-", "−");

  // -- what a run becomes: poses for the view, lines for the graphs

  const bodyOf = (at, run, colour, opacity) => {
    const b = at.diameter / 2, body = { ...run, at, colour, copies: [], opacity, alpha: run.body.alpha, balance: Math.min(run.body.balance, Math.PI / 2) };
    let held = run.angle.find((angle) => !Number.isNaN(angle)) ?? 0;  // the view keeps it while the column stands
    body.rolling_angle = run.angle.map((angle) => { held = Number.isNaN(angle) ? held : angle; return held; });
    body.contact_x = run.x.map((x, i) => x + b * Math.cos(body.rolling_angle[i]));
    body.contact_y = run.y.map((y, i) => y + b * Math.sin(body.rolling_angle[i]));
    return body;
  };
  // extremes of each stretch, so that a graph has few points and no peak less
  const thinned = (x, y, most = 1200) => {
    if (x.length <= most) return [Array.from(x), Array.from(y)];
    const out = [[], []], stretch = 2 * x.length / most;
    for (let k = 0; k < most / 2; k++) {
      let low = Math.floor(k * stretch), high = low;
      for (let i = low; i < Math.min((k + 1) * stretch, x.length); i++) { if (!(y[i] >= y[low])) low = i; if (!(y[i] <= y[high])) high = i; }
      for (const i of [Math.min(low, high), Math.max(low, high)]) { out[0].push(x[i]); out[1].push(y[i]); }
    }
    return out;
  };
  const line = ([x, y], colour, name, more = {}) => ({ kind: "line", name, x, y, style: { colour, dash: "solid", symbol: "" }, width: 1.4, size: 5, opacity: 1, open: [0], steps: false, clip: true, notes: [], ...more });
  const rule = (axis, at, text, colour) => ({ kind: "rule", name: text, axis, at, until: null, text, colour, dash: "dash", side: "right" });

  const clock = rockwobbleClock(find, picture);
  let drawn = false, magnified = 1, laterTimer = 0;
  // a graph with a mark: in the map where the sliders stand, over time the moment that is seen
  class Graph extends Chart {
    draw() {
      if (this.place.id === "tilt") this.panel.height = this.place.clientWidth < 400 ? 150 : 230;  // beside the view, or below it
      super.draw();
      if (!this.at || this.panel.equal) return;
      const { top, bottom } = this.at.frame;
      this.mark = this.place.id === "map" ? element(this.sheet, "circle", { r: 6, fill: "#fff", stroke: "#000", "stroke-width": 2.5 })
        : element(this.sheet, "line", { y1: top, y2: bottom, stroke: "#222", "stroke-width": 1.2 });
      this.follow();
    }

    follow() {
      if (!this.mark) return;
      const { left, right } = this.at.frame;
      const shown = bodies[0] && bodies[0].at, onMap = this.place.id === "map";
      const [x, y] = onMap && shown ? [this.at.x(Math.hypot(shown.height, shown.diameter) / 2), this.at.y(shown.intensity * peaks[shown.record])] : [this.at.x(clock.now), 0];
      const inside = onMap ? shown && placeOf(shown) >= 0 : x >= left && x <= right;
      this.mark.setAttribute("visibility", inside ? "visible" : "hidden");
      if (inside) this.mark.setAttribute("transform", `translate(${x} ${y})`);
    }
  }
  for (const place of root.querySelectorAll(".unfilled")) place.className = "chart";  // after charts.js drew those that are filled
  const graphs = Object.fromEntries(["tilt", "ground", "path", "map"].map((name) => [name, new Graph(document.getElementById(name))]));
  graphs.tilt.linked = graphs.ground.linked = [graphs.tilt, graphs.ground];
  const redraw = (chart, layers, ends) => { chart.panel.layers = layers; chart.reset(); if (ends) chart.ends.x = ends; chart.whole.hidden = true; chart.draw(); };
  for (const chart of [graphs.tilt, graphs.ground]) {
    chart.sheet.addEventListener("click", (event) => {
      const u = event.clientX - chart.sheet.getBoundingClientRect().left;
      if (u > chart.at.frame.left && u < chart.at.frame.right) clock.seek(chart.at.x.back(u));
    });
  }

  function show() {
    const [main, beside] = bodies, { at } = main, first = !drawn, motion = motions[at.record];
    drawn = true;
    clock.length = Math.max(...bodies.map((body) => body.time[body.time.length - 1]), 0.01);
    clock.start = Math.max(0, (main.upliftTime || 0) - 0.2);
    const demand = demandOf(main);
    outcome(main, demand); results(main, motion, demand); parting();

    const ends = [0, clock.length];
    const slides = main.slides, values = (body) => (slides ? body.x.map((x, i) => Math.hypot(x, body.y[i])) : body.tilt.map((tilt) => tilt * DEG));
    const tilts = (body, colour, name) => line(thinned(body.time, values(body)), colour, name);
    const top = Math.max(...bodies.map((body) => Math.min(body.peak, 1.6 * body.balance))), alpha = main.alpha * DEG, near = !slides && top > 0.25 * main.alpha;
    graphs.tilt.place.previousElementSibling.textContent = `${slides ? "Displacement" : "Tilt"} over time`;
    Object.assign(graphs.tilt.panel.y, slides ? { title: "displacement [m]", unit: " m" } : { title: "tilt [deg]", unit: " deg" });
    graphs.tilt.panel.y.high = (slides ? 1.08 * Math.max(...bodies.map((body) => Math.max(...values(body)))) : Math.max(1.08 * top * DEG, near ? 1.15 * alpha : 0)) || 1;
    redraw(graphs.tilt, [...(beside ? [tilts(beside, GREY, "beside it")] : []), tilts(main, main.colour, slides ? "displacement" : "tilt"), ...(near ? [rule("y", alpha, `α = ${number(alpha)}°`, RED)] : [])], ends);
    clearTimeout(laterTimer);
    laterTimer = setTimeout(() => showFurther(main, motion, ends), first ? 0 : 80);  // once the sliders rest

    const most = Math.max(...bodies.map((body) => (body.outcome === "overturned" ? Math.PI / 2 : body.peak)));
    magnified = [30, 10, 3].find((factor) => factor * most < 30 / DEG) || 1;
    if (first || !clock.playing) clock.seek(first ? clock.start : clock.now);
    if (first && !matchMedia("(prefers-reduced-motion: reduce)").matches) clock.play();
  }
  // ground and paths
  function showFurther(main, motion, ends) {
    const { at } = main, scale = at.intensity / GRAVITY, key = String([at.record, at.intensity, ends]);
    if (key !== graphs.ground.key) {
      graphs.ground.key = key;
      const axis = motion && Float64Array.from(motion.x, (_, i) => i * motion.dt);
      const shakes = motion ? [["x", "east", BLUE], ["y", "north", ORANGE], ["z", "up", "#009E73"]].filter(([key]) => motion[key]) : [];
      redraw(graphs.ground, shakes.map(([key, name, colour]) => line(thinned(axis, motion[key].map((value) => value * scale)), colour, name, { width: 1 })), ends);
    }
    // in a recess the contact point stays on the circle, and its path says nothing
    const b = at.diameter / 2, circle = Array.from({ length: 73 }, (_, i) => i * Math.PI / 36), paths = [];
    const path = (points, colour, name) => line([points.map(([x]) => x), points.map(([, y]) => y)], colour, name, { width: 1.2 });
    for (const body of [...bodies].reverse()) {
      const { tilt, at: { height, diameter, support } } = body, [contact, top] = body === main ? [BLUE, ORANGE] : [GREY, GREY], step = Math.ceil(tilt.length / 2500);
      const upright = tilt.findIndex((value) => value > 1.3 * body.balance), last = (upright < 0 ? tilt.length : upright) - 1;  // not the fall
      if (support === "flat") for (const points of rockwobbleContactPaths(body, diameter / 2, 0, last, step)) paths.push(path(points, contact, "contact point (flat ground)"));
      const tops = [];
      for (let i = 0; i <= last; i += step) {
        const out = tilt[i] > 0 ? height * Math.sin(tilt[i]) + diameter / 2 * (1 - Math.cos(tilt[i])) : 0;
        tops.push([body.x[i] + out * Math.cos(body.rolling_angle[i]), body.y[i] + out * Math.sin(body.rolling_angle[i])]);
      }
      paths.push(path(tops, top, body === main ? "top of the column" : "beside it"));
    }
    redraw(graphs.path, [line([circle.map((angle) => b * Math.cos(angle)), circle.map((angle) => b * Math.sin(angle))], "#bbb", "base at rest", { width: 1 }), ...paths]);
    if (map) drawMap();
  }
  const say = (words, kind) => {
    if (find("outcome").textContent !== words) find("outcome").textContent = words;
    find("outcome").className = kind;
  };
  // most friction and least normal force of a run in motion, and the share of that time in which it needs more than there is
  const demandOf = ({ at, tilt, alpha, balance, outcome: end, normal, outward, across }) => {
    let friction = 0, least = Infinity, moving = 0, slipping = 0;
    for (let i = 0; i < normal.length; i++) if (tilt[i] > 1e-3 * alpha && !(end === "overturned" && tilt[i] > 1.2 * balance)) {
      const needed = normal[i] > 0 ? Math.hypot(outward[i], across[i]) / normal[i] : Infinity;
      friction = Math.max(friction, needed);
      least = Math.min(least, normal[i] / GRAVITY);
      moving++; slipping += at.support === "flat" && needed > at.friction;
    }
    return { friction, least, slips: slipping / Math.max(moving, 1) };
  };
  const outcome = (run, { friction, slips }) => {
    const { at, endTime, upliftTime, peak, alpha, relativePeak, copies, body, slides, displacement } = run, end = slips > SLIPS ? "slips" : run.outcome;
    const words = { overturned: `Overturns: on the ground at ${number(endTime, 4)} s`, undecided: `Not decided: followed for ${number(endTime || clock.length, 4)} s only`,
      mixed: body.gamma ? "Not known: no model slides under a slab" : "Not known: so near to b/h it rocks and slides at once, which takes an engine",
      slips: `Not known: it slips, which takes an engine (friction ${number(at.friction)}, up to ${friction === Infinity ? "no contact" : number(friction)} needed)`,
      yielded: `Not known: the tendon yields at a tilt of ${number(body.yieldTilt * DEG)}°` }[end]
      || (slides ? displacement ? `Slides up to ${number(displacement)} m, and cannot uplift` : "Stands, and does not slide" :Number.isNaN(upliftTime) ? "Stands, and does not uplift" : peak > alpha ? "Stands, after a tilt beyond α" : "Stands");
    const unknown = ["undecided", "yielded", "mixed", "slips"].includes(end), otherwise = unknown ? 0 : copies.filter((each) => Number.isFinite(each) !== Number.isFinite(relativePeak)).length;
    say(words + (otherwise ? `; but ${otherwise} of ${copies.length} runs with a 1 % change end otherwise` : ""), otherwise ? "sensitive" : unknown ? "undecided" : end);
  };
  const results = (body, motion, { friction, least, slips }) => {
    const { at, peak, alpha } = body, o = body.body, moved = !Number.isNaN(body.upliftTime);
    const end = { overturned: "overturns", undecided: "not decided", yielded: "not known, the tendon yields", mixed: "not known", slips: "not known" }[slips > SLIPS ? "slips" : body.outcome];
    const ends = o.gaps, topShift = ends * at.diameter / 2 * (1 - Math.cos(peak)) + at.height * Math.sin(peak), rows = [
      ["peak tilt", end || (moved ? `${number(peak * DEG)}° = ${number(peak / alpha)} α` : "0")],
      [ends > 1 ? "displacement of the slab" : "displacement of the top", end || (moved ? `${number(topShift)} m` : "0 m")],
      [motion ? "time of uplift" : "released", moved ? motion ? `${number(body.upliftTime, 4)} s` : "at 0 s" : "none"],
      ["peak ground acceleration", motion ? `${number(at.intensity * peaks[at.record])} g` : "still"],
      ["acceleration at uplift", `${number(o.slope * (1 + o.q / GRAVITY))} g`],
      ["friction demand", Number.isFinite(least) ? (friction === Infinity ? "contact is lost" : number(friction)) + (slips ? `, over ${number(at.friction)} for ${number(100 * slips, 2)} % of the motion` : "") : "none"],
      ["least normal force", Number.isFinite(least) ? `${number(least)} weights` : "1 weight"],
    ];
    if (body.slides) {
      const moved = ["displacement", "residual"].map((name) => end || `${number(body[name])} m`);
      rows.splice(0, Infinity, ["peak displacement", moved[0]], ["residual displacement", moved[1]], rows[3], ["acceleration that slides it", `${number(at.friction)} g`]);
    }
    const { prestress, stiffness } = problemOf(at);
    if (prestress || stiffness) rows.push(["tendon force", `${number(prestress + stiffness * o.gaps * 2 * Math.sin(Math.min(peak, Math.PI / 2) / 2))} weights`]);
    find("results").innerHTML = rows.map(([name, value]) => `<div><dt>${name}</dt><dd>${value}</dd></div>`).join("");
  };
  // first time at which both tilts differ by 1 % of alpha
  const parting = () => {
    const [main, beside] = bodies, place = find("parts");
    if (!beside) { place.textContent = ""; return; }
    if (JSON.stringify(beside.at) !== JSON.stringify(besideOf(main.at))) return;  // that of these sliders is on its way
    const n = Math.min(main.tilt.length, beside.tilt.length);
    let i = 0;
    while (i < n && Math.abs(main.tilt[i] - beside.tilt[i]) <= AGREEMENT * main.alpha) i++;
    const end = { overturned: "overturns", stands: "stands", undecided: "is not decided", yielded: "is not known, its tendon yields", mixed: "is not known" }[beside.outcome];
    place.textContent = `The gray column ${end}${beside.outcome === "stands" ? `, peak ${number(beside.peak / beside.alpha)} α` : ""}; ${i < n ? `the tilts diverge at ${number(main.time[i], 4)} s` : "the tilts do not diverge"}.`;
  };

  // -- the view and its clock

  const draw = rockwobbleStage(find("plot"), () => {
    const at = bodies[0] ? bodies[0].at : state, fell = bodies.some((body) => body.outcome === "overturned");
    return { b: at.diameter / 2, height: at.height, slab: at.slab > 0, tendon: at.support !== "flat" && at.prestress + at.stiffness > 0, reach: fell ? 0.75 * at.height + at.diameter : 0 };
  }, () => picture());
  function picture() {
    if (!bodies[0]) return;
    draw(bodies.map((body) => { const at = rockwobblePose(body, clock.now); return { body, at, first: at.sample - 400, last: at.sample }; }), Number(find("magnify").value) || magnified);
    graphs.tilt.follow(); graphs.ground.follow();
  }
  find("magnify").addEventListener("change", picture);
  find("beside").addEventListener("change", changed);
  find("pin").addEventListener("click", () => {
    pinned = { ...state };
    find("beside").options[1].disabled = false;
    find("beside").value = "pinned";
    changed();
  });
  find("reset").addEventListener("click", () => { Object.assign(state, standard); showFields(); changed(); });

  // -- the map: size by intensity, made in a worker of its own, a row at a time from that of the column outward

  const CELLS = 41, SIZES = [1 / 4, 4], palette = graphs.map.panel.legend.map((entry) => entry.colour);
  const classOf = (peak) => (Number.isNaN(peak) ? 7 : peak === Infinity ? 6 : peak > 1 ? 5 : peak === 0 ? 0 : 1 + Math.min(3, Math.floor(peak * 4)));
  let map = null, mapTimer = 0;
  const geometric = ([low, high], share) => low * (high / low) ** share, centre = (i) => (i + 0.5) / CELLS;
  const shareOf = ([low, high], value) => Math.log(value / low) / Math.log(high / low);
  // what a map is of: all but size and intensity
  const subjectOf = ({ height, diameter, intensity, ...others }) => JSON.stringify([others, (diameter / height).toPrecision(4)]);
  const placeOf = (at) => {
    if (!map || subjectOf(at) !== map.subject) return -1;
    const [column, row] = [shareOf(SIZES, at.height / map.at.height), shareOf(map.intensities, at.intensity)].map((share) => Math.floor(share * CELLS));
    return column >= 0 && column < CELLS && row >= 0 && row < CELLS ? row * CELLS + column : -1;
  };
  function askMap(at) {
    clearTimeout(mapTimer);
    if (map && subjectOf(at) === map.subject) return;
    map = null;  // the worker stops after the row that it is at
    graphs.map.place.classList.add("stale");
    if (at.record >= 0) mapTimer = setTimeout(() => {  // once the sliders rest
      // around the uplift of the column: from half of it on
      const uplift = at.diameter / at.height / peaks[at.record], intensities = [0.5 * uplift, 16 * uplift];
      const near = shareOf(intensities, at.intensity) * CELLS - 0.5, rows = Array.from({ length: CELLS }, (_, i) => i);
      map = { at, subject: subjectOf(at), intensities, values: Array(CELLS * CELLS), rows: rows.sort((i, j) => Math.abs(i - near) - Math.abs(j - near)) };
      askRow();
    }, 500);
  }
  const askRow = () => {
    const row = map.rows.shift(), { at, intensities } = map;
    const cellOf = (column) => ({ ...at, height: at.height * geometric(SIZES, centre(column)), diameter: at.diameter * geometric(SIZES, centre(column)), intensity: geometric(intensities, centre(row)) });
    mapper.postMessage({ subject: map.subject, row, problems: Array.from({ length: CELLS }, (_, column) => problemOf(cellOf(column))) });
  };
  const mapper = workerOf(({ data }) => {
    if (!map || data.subject !== map.subject) return;
    data.peaks.forEach((peak, column) => { map.values[data.row * CELLS + column] = peak; });
    drawMap();
    if (map.rows.length) askRow();
  });
  function drawMap() {
    graphs.map.place.classList.remove("stale");
    // each cell is coloured by a run in it: by that of the column where the dot lies
    const place = bodies[0] ? placeOf(bodies[0].at) : -1;
    if (place >= 0) map.values[place] = bodies[0].relativePeak;
    const R = (share) => geometric(SIZES, share) * Math.hypot(map.at.height, map.at.diameter) / 2, PGA = (share) => geometric(map.intensities, share) * peaks[map.at.record];
    const edges = Array.from({ length: CELLS + 1 }, (_, i) => i / CELLS), words = (peak) => (peak === undefined ? "not yet known" : Number.isNaN(peak) ? "not decided" : peak === Infinity ? "overturns" : `peak ${number(peak)} α`);
    redraw(graphs.map, [
      { kind: "heat", name: "map", x: edges.map(R), y: edges.map(PGA), cells: Array.from(map.values, (peak) => (peak === undefined ? -1 : classOf(peak))), palette, written: [],
        said: (column, row, i) => [`R = ${number(R(centre(column)))} m`, `peak ground acceleration ${number(PGA(centre(row)))} g`, words(map.values[i])] },
    ]);
  }
  graphs.map.sheet.addEventListener("click", (event) => {
    if (!map) return;
    const edges = graphs.map.sheet.getBoundingClientRect(), [R, pga] = [10 ** graphs.map.at.x.back(event.clientX - edges.left), 10 ** graphs.map.at.y.back(event.clientY - edges.top)];
    const factor = R / (Math.hypot(map.at.height, map.at.diameter) / 2), bound = (name, value) => Number(Math.min(Math.max(value, fields[name].low), fields[name].high).toPrecision(6));
    Object.assign(state, { height: bound("height", map.at.height * factor), diameter: bound("diameter", map.at.diameter * factor), intensity: bound("intensity", pga / peaks[map.at.record]) });
    showFields(); changed();
  });

  // -- taken along

  const options = (at) => {
    const problem = problemOf(at), record = records[at.record], planar = at.support === "planar", found = { diameter: at.diameter, height: at.height };
    if (at.slab) found["slab-mass-ratio"] = at.slab;
    if (problem.delta) found["rolling-resistance"] = problem.delta;
    if (problem.prestress) found["tendon-prestress"] = problem.prestress;
    if (problem.stiffness) found["tendon-stiffness"] = problem.stiffness;
    if (problem.yielding && (problem.prestress || problem.stiffness)) found["tendon-yield"] = problem.yielding;
    if (record) Object.assign(found, record.options, at.intensity === 1 ? {} : { scale: at.intensity });
    else Object.assign(found, { "release-tilt-deg": at.tilt, duration: given.free }, planar ? {} : { "release-azimuth-deg": at.lean, "rolling-rate": at.rate });
    if (GRAVITY !== 9.81) found.gravity = GRAVITY;
    if (record && given.duration) found.duration = given.duration;
    if (planar) found.plane = problem.azimuth; else if (at.support === "flat") Object.assign(found, { support: "flat", friction: at.friction });
    return found;
  };
  const commandOf = (at) => (at.record >= 0 && !records[at.record].options ? "# a synthetic motion is a matter of Python: copy that\n" : "")
    + `rockwobble simulate ${Object.entries(options(at)).map(([name, value]) => (value === true ? `--${name}` : `--${name} ${/^[\w./:,+-]+$/.test(value) ? value : `'${String(value).replaceAll("'", "'\\''")}'`}`)).join(" ")}`;
  const pythonOf = (at) => {
    const problem = problemOf(at), lines = ["import math", "", "import rockwobble as rw", "", `body = rw.Cylinder.from_dimensions(base_radius=${at.diameter / 2}, height=${at.height})`];
    if (at.slab) lines.push(`body = rw.WobblingFrame(body, slab_mass_ratio=${at.slab})`);
    if (at.record >= 0) lines.push(`motion = (${records[at.record].python}).scaled(${at.intensity})`);
    const more = [at.record >= 0 ? "motion" : "None"];
    if (problem.release) more.push(`initial=rw.InitialState(tilt=${problem.release.tilt}, rolling_angle=${problem.release.azimuth}, rolling_rate=${problem.release.rate})`);
    if (problem.release || given.duration) more.push(`duration=${problem.duration}`);
    if (at.support === "flat") more.push(`friction=${at.friction}`);
    if (problem.delta) more.push(`rolling_resistance=${problem.delta}`);
    if (GRAVITY !== 9.81) more.push(`gravity=${GRAVITY}`);
    if (problem.prestress || problem.stiffness) more.push(`tendon=rw.Tendon(prestress=${problem.prestress}, stiffness=${problem.stiffness}${problem.yielding ? `, yield_force=${problem.yielding}` : ""})`);
    const how = { recess: "", flat: ', support="flat"', planar: `, plane=${problem.azimuth}` }[at.support];
    lines.push(`case = rw.Case(body, ${more.join(", ")})`, `trace = rw.simulate(case${how})`, 'print(trace.outcome, math.degrees(trace.peak_tilt), "deg")', "");
    return lines.join("\n");
  };
  const copy = async (text, what) => {
    find("text").textContent = text; find("text").hidden = false;
    let words = `${what} copied`;
    try { await navigator.clipboard.writeText(text); } catch { words = `${what}: select and copy it below`; }
    find("copied").textContent = words;
  };
  const download = (name, content) => {
    const link = Object.assign(document.createElement("a"), { download: name, href: URL.createObjectURL(content) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  const taken = {
    link: () => copy(`${location.href.split("#")[0]}#${new URLSearchParams(differing())}`, "Link"),
    command: () => copy(commandOf(state), "Command"), python: () => copy(pythonOf(state), "Python"),
    csv: () => {
      const { time, tilt, angle, contact_x: x, contact_y: y, normal } = bodies[0], rows = ["time [s],tilt [rad],azimuth [rad],contact_x [m],contact_y [m],normal_force [weight]"];
      for (let i = 0; i < time.length; i++) rows.push([time[i], tilt[i], ...(Number.isNaN(angle[i]) ? ["", "", ""] : [angle[i], x[i], y[i]]), normal[i] / GRAVITY].map((value) => (value === "" ? "" : Number(value.toPrecision(12)))).join());
      download("rockwobble-trace.csv", new Blob([`${rows.join("\n")}\n`], { type: "text/csv" }));
    },
    png: () => find("plot").toBlob((blob) => download("rockwobble-view.png", blob)),
    svg: () => {
      const sheet = graphs.tilt.sheet.cloneNode(true);
      for (const [name, value] of [["xmlns", "http://www.w3.org/2000/svg"], ["font-family", "sans-serif"]]) sheet.setAttribute(name, value);
      download("rockwobble-tilt.svg", new Blob([sheet.outerHTML], { type: "image/svg+xml" }));
    },
  };
  for (const [name, act] of Object.entries(taken)) find(name).addEventListener("click", act);

  window.rockwobbleExplore = { state, set: (values) => { Object.assign(state, values); showFields(); changed(); }, commandOf, pythonOf };
  readAddress(); showFields(); changed();
}());
