// Plays the motion of one case in three dimensions: one run solid, one reduced model translucent over it.
// A pose is R_z(rolling angle) R_y(tilt) R_z(twist - rolling angle) about the contact point on the rim.
function rockwobblePlayback(root, spec) {
  const b = spec.base_radius, height = spec.height, sides = 40;
  const numbers = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const unpack = (body) => {
    const open = { ...body };
    for (const name of ["time", "tilt", "rolling_angle", "twist", "contact_x", "contact_y"]) open[name] = numbers(body[name]);
    return open;
  };
  const runs = spec.runs.map(unpack), models = spec.models.map(unpack);
  const find = (name) => root.querySelector(`[data-part="${name}"]`);
  const plot = find("plot"), slider = find("time"), clock = find("clock"), button = find("play");
  const speed = find("speed"), magnify = find("magnify"), runChoice = find("run"), modelChoice = find("model");

  const options = (choice, labels) => labels.forEach((label, value) => choice.add(new Option(label, value)));
  options(runChoice, runs.map((run) => run.label));
  options(modelChoice, models.map((model) => model.label));
  spec.magnify.forEach((factor) => magnify.add(new Option(`${factor} ×`, factor)));
  if (runs.length) modelChoice.value = spec.partners[0];

  // the cylinder in its own axes, origin at the centre of the base: two rims, two centres, one stripe
  const shape = [];
  for (const z of [0, height]) {
    for (let i = 0; i < sides; i++) shape.push([b * Math.cos(2 * Math.PI * i / sides), b * Math.sin(2 * Math.PI * i / sides), z]);
  }
  shape.push([0, 0, 0], [0, 0, height]);
  const stripe = [[0, 0, height], [b, 0, height], [b, 0, 0], [0, 0, 0]];
  const faces = { i: [], j: [], k: [] };
  const face = (i, j, k) => { faces.i.push(i); faces.j.push(j); faces.k.push(k); };
  for (let i = 0; i < sides; i++) {
    const next = (i + 1) % sides;
    face(i, next, sides + i); face(next, sides + next, sides + i);
    face(2 * sides, next, i); face(2 * sides + 1, sides + i, sides + next);
  }

  const sample = (body, time) => {
    let low = 0, high = body.time.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (body.time[middle] <= time + 1e-6) low = middle; else high = middle - 1;
    }
    return low;
  };
  const place = (body, n, factor, points) => {
    const tilt = Math.min(body.tilt[n] * factor, Math.PI / 2), phi = body.rolling_angle[n], psi = body.twist[n] - phi;
    const [st, ct, sp, cp, ss, cs] = [Math.sin(tilt), Math.cos(tilt), Math.sin(phi), Math.cos(phi), Math.sin(psi), Math.cos(psi)];
    const origin = [body.contact_x[n] - b * ct * cp, body.contact_y[n] - b * ct * sp, b * st];
    const placed = { x: [], y: [], z: [] };
    for (const [x, y, z] of points) {
      const u = cs * x - ss * y, v = ss * x + cs * y, w = ct * u + st * z;
      placed.x.push(origin[0] + cp * w - sp * v);
      placed.y.push(origin[1] + sp * w + cp * v);
      placed.z.push(origin[2] - st * u + ct * z);
    }
    return placed;
  };
  const trail = (body, n) => {
    const path = { x: [], y: [], z: [] };
    for (let i = Math.max(0, n - 400); i <= n; i++) {
      const touches = body.tilt[i] > 0;
      path.x.push(touches ? body.contact_x[i] : null);
      path.y.push(touches ? body.contact_y[i] : null);
      path.z.push(touches ? 0 : null);
    }
    return path;
  };

  const chosen = () => [
    ...(runs.length ? [runs[runChoice.value]] : []),
    ...(models.length ? [models[modelChoice.value]] : []),
  ];
  const traces = (time) => {
    const factor = Number(magnify.value), list = [];
    for (const body of chosen()) {
      const n = sample(body, time);
      list.push({ type: "mesh3d", ...place(body, n, factor, shape), ...faces, color: body.colour, opacity: body.opacity,
        flatshading: true, hoverinfo: "skip", name: body.label, showlegend: true, lighting: { ambient: 0.7, diffuse: 0.6, specular: 0.1 }, lightposition: { x: 2000, y: -3000, z: 3000 } });
      list.push({ type: "scatter3d", mode: "lines", ...place(body, n, factor, stripe), line: { color: "#222222", width: 4 },
        hoverinfo: "skip", showlegend: false });
      list.push({ type: "scatter3d", mode: "lines", ...trail(body, n), line: { color: body.opacity < 1 ? "#000000" : body.colour, width: 5 },
        hoverinfo: "skip", showlegend: false });
    }
    return list;
  };
  const circle = () => {
    const ring = { x: [], y: [], z: [] };
    for (let i = 0; i <= 72; i++) {
      ring.x.push(b * Math.cos(2 * Math.PI * i / 72)); ring.y.push(b * Math.sin(2 * Math.PI * i / 72)); ring.z.push(0);
    }
    return { type: "scatter3d", mode: "lines", ...ring, line: { color: "#888888", width: 2, dash: "dash" },
      name: "original circle", hoverinfo: "skip" };
  };
  const reach = Math.max(2.2 * b, 0.35 * height), top = 1.1 * Math.hypot(height, b), largest = Math.max(2 * reach, top);
  const axis = (title, range) => ({ title: { text: title }, range, backgroundcolor: "#f6f6f6", showbackground: true, gridcolor: "#dddddd" });
  const layout = {
    margin: { l: 0, r: 0, t: 0, b: 0 }, height: window.innerWidth < 600 ? 420 : 560, uirevision: "kept",
    legend: { orientation: "h", x: 0, y: 0 },
    scene: {
      // equal lengths on all axes, the longest one filling the window
      aspectmode: "manual", aspectratio: { x: 2 * reach / largest, y: 2 * reach / largest, z: top / largest },
      camera: { eye: { x: 1.15, y: -1.35, z: 0.5 }, center: { x: 0, y: 0, z: -0.07 } },
      xaxis: axis("east-west [m]", [-reach, reach]), yaxis: axis("north-south [m]", [-reach, reach]),
      zaxis: axis("height [m]", [0, top]),
    },
  };

  let now = 0, playing = false, before = 0, drawing = false;
  const say = () => {
    clock.textContent = `${now.toFixed(2)} s of ${spec.length.toFixed(2)} s`;
    slider.value = now;
  };
  const show = () => {
    say();
    const list = traces(now), update = { x: [], y: [], z: [] };
    for (const trace of list) for (const name of ["x", "y", "z"]) update[name].push(trace[name]);
    drawing = true;
    return Plotly.restyle(plot, update, list.map((_, index) => index)).then(() => { drawing = false; });
  };
  const rebuild = () => Plotly.react(plot, [...traces(now), circle()], layout, { responsive: true, displaylogo: false });
  const tick = (stamp) => {
    if (!playing) return;
    // a slow machine shows fewer pictures, not a slower motion
    now += Math.min((stamp - before) / 1000, 0.25) * Number(speed.value);
    before = stamp;
    if (now >= spec.length) { now = spec.length; pause(); }
    if (!drawing) show();
    requestAnimationFrame(tick);
  };
  const pause = () => { playing = false; button.textContent = "Play"; };
  button.addEventListener("click", () => {
    if (playing) { pause(); return; }
    if (now >= spec.length) now = 0;
    playing = true;
    button.textContent = "Pause";
    requestAnimationFrame((stamp) => { before = stamp; tick(stamp); });
  });
  slider.max = spec.length;
  slider.addEventListener("input", () => { now = Number(slider.value); show(); });
  runChoice.addEventListener("change", () => { modelChoice.value = spec.partners[runChoice.value]; rebuild(); });
  modelChoice.addEventListener("change", rebuild);
  magnify.addEventListener("change", show);
  runChoice.parentElement.hidden = !runs.length;
  say();
  return rebuild();
}
