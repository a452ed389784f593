// Plays the motion of one case in three dimensions: one run solid, one reduced model translucent over it.
// A pose is R_z(rolling angle) R_y(tilt) R_z(twist - rolling angle) about the contact point on the rim.
function rockwobblePlayback(root, spec) {
  const b = spec.base_radius, height = spec.height, sides = 40;
  const numbers = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const MOVING = ["tilt", "rolling_angle", "twist", "contact_x", "contact_y"];
  const unpack = (body) => ({ ...body, ...Object.fromEntries(["time", ...MOVING].map((name) => [name, numbers(body[name])])) });
  const runs = spec.runs.map(unpack), models = spec.models.map(unpack);
  const find = (name) => root.querySelector(`[data-part="${name}"]`);
  const plot = find("plot"), slider = find("time"), clock = find("clock"), button = find("play");
  const speed = find("speed"), magnify = find("magnify"), runChoice = find("run"), modelChoice = find("model");

  const options = (choice, labels) => labels.forEach((label, value) => choice.add(new Option(label, value)));
  options(runChoice, runs.map((run) => run.label));
  options(modelChoice, models.map((model) => model.label));
  spec.magnify.forEach((factor) => magnify.add(new Option(`${factor} ×`, factor)));
  if (runs.length) modelChoice.value = spec.partners[0];

  // the cylinder in its own axes, origin at the centre of the base: two rims and one stripe
  const rim = (z) => Array.from({ length: sides }, (_, i) => [b * Math.cos(2 * Math.PI * i / sides), b * Math.sin(2 * Math.PI * i / sides), z]);
  const shape = [...rim(0), ...rim(height)];
  const stripe = [[0, 0, height], [b, 0, height], [b, 0, 0]];

  // pose at a time, between two samples
  const pose = (body, time) => {
    let low = 0, high = body.time.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (body.time[middle] <= time + 1e-6) low = middle; else high = middle - 1;
    }
    const next = Math.min(low + 1, body.time.length - 1), length = body.time[next] - body.time[low];
    const share = length > 0 ? Math.min((time - body.time[low]) / length, 1) : 0, found = { sample: low };
    for (const name of MOVING) found[name] = body[name][low] + share * (body[name][next] - body[name][low]);
    return found;
  };
  const place = (at, factor, points) => {
    const tilt = Math.min(at.tilt * factor, Math.PI / 2), phi = at.rolling_angle, psi = at.twist - phi;
    const [st, ct, sp, cp, ss, cs] = [Math.sin(tilt), Math.cos(tilt), Math.sin(phi), Math.cos(phi), Math.sin(psi), Math.cos(psi)];
    const origin = [at.contact_x - b * ct * cp, at.contact_y - b * ct * sp, b * st];
    return points.map(([x, y, z]) => {
      const u = cs * x - ss * y, v = ss * x + cs * y, w = ct * u + st * z;
      return [origin[0] + cp * w - sp * v, origin[1] + sp * w + cp * v, origin[2] - st * u + ct * z];
    });
  };

  // -- drawing: parallel projection of a camera that looks at the middle of the height
  const camera = { azimuth: -0.9, elevation: 0.28 };
  const reach = Math.max(2.2 * b, 0.35 * height), top = 1.05 * Math.hypot(height, 2 * b);
  const step = [1, 2, 5, 10].map((n) => n * 10 ** Math.floor(Math.log10(reach / 2))).find((n) => n >= reach / 4);
  const edge = step * Math.floor(reach / step);
  const circle = Array.from({ length: 73 }, (_, i) => [b * Math.cos(2 * Math.PI * i / 72), b * Math.sin(2 * Math.PI * i / 72), 0]);
  const pen = plot.getContext("2d");
  let project, light;
  const look = () => {
    const width = plot.clientWidth, tall = plot.clientHeight, ratio = window.devicePixelRatio || 1;
    [plot.width, plot.height] = [width * ratio, tall * ratio];
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const [sa, ca, se, ce] = [Math.sin(camera.azimuth), Math.cos(camera.azimuth), Math.sin(camera.elevation), Math.cos(camera.elevation)];
    const scale = Math.min(width / (3 * edge), tall / (top * ce + 2.6 * edge * Math.abs(se) + 0.4 * edge));
    project = ([x, y, z]) => [width / 2 + scale * (ca * y - sa * x), tall / 2 - scale * (ce * (z - 0.46 * top) - se * (ca * x + sa * y)), (ca * x + sa * y) * ce + z * se];
    light = [ca * 0.5 - sa * 0.6, sa * 0.5 + ca * 0.6, 0.6];
  };
  const path = (points, close) => {
    pen.beginPath();
    points.forEach(([u, v], i) => (i ? pen.lineTo(u, v) : pen.moveTo(u, v)));
    if (close) pen.closePath();
  };
  const stroke = (points, colour, width, dash = []) => {
    Object.assign(pen, { strokeStyle: colour, lineWidth: width });
    pen.setLineDash(dash);
    path(points.map(project));
    pen.stroke();
  };
  const ground = () => {
    for (let n = -edge; n <= edge + 1e-9; n += step) {
      stroke([[n, -edge, 0], [n, edge, 0]], "#ddd", 1);
      stroke([[-edge, n, 0], [edge, n, 0]], "#ddd", 1);
    }
    Object.assign(pen, { fillStyle: "#444", font: "12px system-ui, sans-serif", textAlign: "center" });
    for (const [name, x, y] of [["east", 1.3, 0], ["west", -1.3, 0], ["north", 0, 1.3], ["south", 0, -1.3]]) {
      const [u, v] = project([x * edge, y * edge, 0]);
      pen.fillText(name, u, v + 4);
    }
    pen.textAlign = "left";
    pen.fillText(`grid: ${step} m`, 8, plot.clientHeight - 8);
    stroke(circle, "#888", 1.5, [6, 4]);
  };
  const trail = (body, n) => {
    let points = [];
    const colour = body.opacity < 1 ? "#000" : body.colour;
    for (let i = Math.max(0, n - spec.trail); i <= n; i++) {
      if (body.tilt[i] > 0) points.push([body.contact_x[i], body.contact_y[i], 0]);
      else { stroke(points, colour, 2.5); points = []; }
    }
    stroke(points, colour, 2.5);
  };
  // of a convex solid the faces towards the eye are all that is seen, in any order
  const cylinder = (body, at, factor) => {
    const points = place(at, factor, shape), seen = points.map(project), [r, g, blue] = [1, 3, 5].map((i) => parseInt(body.colour.slice(i, i + 2), 16));
    const facing = (corners) => corners.reduce((area, [u, v], i) => {
      const [p, q] = corners[(i + 1) % corners.length];
      return area + u * q - p * v;
    }, 0) < 0;
    const fill = (corners, bright) => {
      path(corners, true);
      const colour = `rgba(${[r, g, blue].map((c) => Math.round(c * bright + 255 * 0.25 * bright)).map((c) => Math.min(c, 255)).join()},${body.opacity})`;
      Object.assign(pen, { fillStyle: colour, strokeStyle: colour, lineWidth: body.opacity < 1 ? 0.01 : 1 });
      pen.fill();
      if (body.opacity === 1) pen.stroke();
    };
    pen.setLineDash([]);
    const [base, lid] = [points.slice(0, sides), points.slice(sides)];
    for (let i = 0; i < sides; i++) {
      const next = (i + 1) % sides, face = [seen[i], seen[next], seen[sides + next], seen[sides + i]];
      if (!facing(face)) continue;
      const middle = [0, 1, 2].map((k) => (base[i][k] + base[next][k] - base[(i + sides / 2) % sides][k] - base[(next + sides / 2) % sides][k]) / (4 * b));
      fill(face, 0.6 + 0.35 * Math.max(0, middle[0] * light[0] + middle[1] * light[1] + middle[2] * light[2]));
    }
    for (const cap of [seen.slice(0, sides).reverse(), seen.slice(sides)]) if (facing(cap)) fill(cap, 1);
    for (const ring of [base, lid]) stroke([...ring, ring[0]], body.opacity < 1 ? "#666" : "#222", 0.8);
    stroke(place(at, factor, stripe), "#222", 2);
  };

  let now = 0, playing = false, before = 0;
  const say = () => {
    clock.textContent = `${now.toFixed(2)} s of ${spec.length.toFixed(2)} s`;
    slider.value = now;
  };
  const show = () => {
    say();
    look();
    ground();
    const bodies = [
      ...(runs.length ? [runs[runChoice.value]] : []),
      ...(models.length ? [models[modelChoice.value]] : []),
    ].map((body) => [body, pose(body, now)]);
    for (const [body, at] of bodies) trail(body, at.sample);
    for (const [body, at] of bodies) cylinder(body, at, Number(magnify.value));
  };
  const tick = (stamp) => {
    if (!playing) return;
    // a slow machine shows fewer pictures, not a slower motion
    now += Math.min((stamp - before) / 1000, 0.25) * Number(speed.value);
    before = stamp;
    if (now >= spec.length) { now = spec.length; pause(); }
    show();
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
  runChoice.addEventListener("change", () => { modelChoice.value = spec.partners[runChoice.value]; show(); });
  modelChoice.addEventListener("change", show);
  magnify.addEventListener("change", show);
  plot.addEventListener("pointerdown", (event) => plot.setPointerCapture(event.pointerId));
  plot.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    camera.azimuth -= 0.01 * event.movementX;
    camera.elevation = Math.min(Math.max(camera.elevation + 0.01 * event.movementY, 0), Math.PI / 2);
    show();
  });
  runChoice.parentElement.hidden = !runs.length;
  show();
  new ResizeObserver(() => requestAnimationFrame(show)).observe(plot);
}
