// Draws cylinders on their ground in three dimensions, and is turned by dragging or by the arrow keys.
// A pose is R_z(rolling angle) R_y(tilt) R_z(twist - rolling angle) about the contact point on the rim.
// `shape()` returns { b, height, slab, tendon, reach }: radius, height, whether there is a slab and a tendon, and, if more is
// to be seen, how far.
function rockwobbleStage(plot, shape, changed) {
  const sides = 40;
  let b, height, edge, step, top, rims, stripe, circle;
  const measure = () => {
    const now = shape();
    if (rims && now.b === b && now.height === height && now.reach === measure.reach) return;
    ({ b, height } = now);
    measure.reach = now.reach;
    const ring = (n, z) => Array.from({ length: n }, (_, i) => [b * Math.cos(2 * Math.PI * i / sides), b * Math.sin(2 * Math.PI * i / sides), z]);
    // in its own axes, origin at the centre of the base: two rims and one stripe
    rims = [...ring(sides, 0), ...ring(sides, height)];
    stripe = [[0, 0, height], [b, 0, height], [b, 0, 0]];
    circle = ring(sides + 1, 0);
    const reach = now.reach || Math.max(2.2 * b, 0.35 * height);
    top = 1.05 * Math.hypot(height, 2 * b);
    step = [1, 2, 5, 10].map((n) => n * 10 ** Math.floor(Math.log10(reach / 2))).find((n) => n >= reach / 4);
    edge = step * Math.floor(reach / step);
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


  // parallel projection of a camera that looks at the middle of the height
  const camera = { azimuth: -0.9, elevation: 0.28 };
  const pen = plot.getContext("2d");
  let project, light, narrow;
  const look = () => {
    narrow = plot.clientWidth < 200;  // then words are short, and have two lines below
    const width = plot.clientWidth, tall = plot.clientHeight - (narrow ? 26 : 0), ratio = window.devicePixelRatio || 1;
    [plot.width, plot.height] = [width * ratio, plot.clientHeight * ratio];
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
  const ground = (factor) => {
    for (let n = -edge; n <= edge + 1e-9; n += step) {
      stroke([[n, -edge, 0], [n, edge, 0]], "#ddd", 1);
      stroke([[-edge, n, 0], [edge, n, 0]], "#ddd", 1);
    }
    Object.assign(pen, { fillStyle: "#444", font: "12px system-ui, sans-serif", textAlign: "center" });
    for (const [name, x, y] of [["east", 1.3, 0], ["west", -1.3, 0], ["north", 0, 1.3], ["south", 0, -1.3]]) {
      const [u, v] = project([x * edge, y * edge, 0]);
      pen.fillText(narrow ? name[0].toUpperCase() : name, u, v + 4);
    }
    pen.textAlign = "left";
    const scales = [`grid: ${step} m`, ...(factor > 1 ? [`tilt drawn ${factor} ×`] : [])], lines = narrow ? scales : [scales.join(", ")];
    lines.forEach((line, i) => pen.fillText(line, 8, plot.clientHeight - 8 - 14 * (lines.length - 1 - i)));
    stroke(circle, "#888", 1.5, [6, 4]);
  };
  const trail = (body, first, last) => {
    for (const points of rockwobbleContactPaths(body, b, Math.max(0, first), last)) stroke(points.map(([x, y]) => [x, y, 0]), body.opacity < 1 ? "#000" : body.colour, 2.5);
  };
  // of a convex solid the faces towards the eye are all that is seen, in any order
  const cylinder = (body, at, factor) => {
    const points = place(at, factor, rims), seen = points.map(project), [r, g, blue] = [1, 3, 5].map((i) => parseInt(body.colour.slice(i, i + 2), 16));
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

  // the slab moves without turning, by twice what the mass centre does
  const slab = (body, at, factor) => {
    const tilt = Math.min(at.tilt * factor, Math.PI / 2), [s, c] = [Math.sin(tilt), Math.cos(tilt)];
    const out = 2 * s * (height / 2 + b * Math.tan(tilt / 2)), z = 2 * (b * s + height / 2 * c), thick = 0.25 * b, half = 1.5 * b;
    const [x, y] = [out * Math.cos(at.rolling_angle), out * Math.sin(at.rolling_angle)];
    const corner = (i, level) => [x + (i === 0 || i === 3 ? -half : half), y + (i < 2 ? -half : half), z + level * thick];
    const lines = [0, 1].map((level) => [0, 1, 2, 3].map((i) => corner(i, level)));
    pen.fillStyle = `rgba(150,150,150,${0.5 * body.opacity})`;
    path(lines[1].map(project), true);
    pen.fill();
    for (const ring of lines) stroke([...ring, ring[0]], "#444", 1);
    for (let i = 0; i < 4; i++) stroke([lines[0][i], lines[1][i]], "#444", 1);
  };

  // from its anchor in the ground through the gap of the base along the axis
  const tendon = (at, factor) => stroke([[0, 0, 0], ...place(at, factor, [[0, 0, 0], [0, 0, height]])], "#b3261e", 2.5);

  const turn = (u, v) => {
    camera.azimuth -= 0.01 * u;
    camera.elevation = Math.min(Math.max(camera.elevation + 0.01 * v, 0), Math.PI / 2);
    changed();
  };
  plot.addEventListener("pointerdown", (event) => plot.setPointerCapture(event.pointerId));
  plot.addEventListener("pointermove", (event) => { if (event.buttons) turn(event.movementX, event.movementY); });
  plot.addEventListener("keydown", (event) => {
    const [u, v] = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, 8], ArrowDown: [0, -8] }[event.key] || [0, 0];
    if (!u && !v) return;
    event.preventDefault();
    turn(u, v);
  });
  new ResizeObserver(() => requestAnimationFrame(changed)).observe(plot);

  // `bodies` are drawn in their order: { body, at, first, last }, where a body has colour, opacity and the contact points
  return (bodies, factor) => {
    measure();
    look();
    ground(factor);
    for (const { body, first, last } of bodies) trail(body, first, last);
    for (const { body, at } of bodies) {
      cylinder(body, at, factor);
      if (shape().tendon) tendon(at, factor);
      if (shape().slab) slab(body, at, factor);
    }
  };
}

// Paths of the contact point: between two samples it runs along the rim, whose centre moves; broken where the cylinder stands.
function rockwobbleContactPaths(body, b, first, last, step = 1) {
  const paths = [[]], centre = (i) => [body.contact_x[i] - b * Math.cos(body.rolling_angle[i]), body.contact_y[i] - b * Math.sin(body.rolling_angle[i])];
  for (let i = first; i <= last; i += step) {
    if (!(body.tilt[i] > 0)) { if (paths.at(-1).length) paths.push([]); continue; }
    const from = paths.at(-1).length ? i - step : i, angle = body.rolling_angle[from], turn = body.rolling_angle[i] - angle;
    const [[x, y], [u, v]] = [centre(from), centre(i)], parts = Math.ceil(Math.abs(turn) / 0.1) || 1;
    for (let n = 1; n <= parts; n++) {
      const share = n / parts, now = angle + share * turn;
      paths.at(-1).push([x + share * (u - x) + b * Math.cos(now), y + share * (v - y) + b * Math.sin(now)]);
    }
  }
  return paths;
}
