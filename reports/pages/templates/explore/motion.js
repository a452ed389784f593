// One run through a record: uplift, steps, turning points, rest, overturning, and what is asked of the ground.

const REST = 1e-8;  // of alpha: at rest again below the energy of a standstill at this tilt
const CLOSED = 1e-3;  // of alpha: no demand is taken below
const HAIR = 1e-6;  // of 1/p: an uplift so near to the next sample is taken up there
const FIRST_STEP = 1e-3;  // of 1/p
const FOLLOWED = 40;  // of 1/p: for so long a motion that goes on when its time is over is followed to a maximum
const BUDGET = 400000;  // steps
const COLUMNS = ["time", "tilt", "angle", "twist", "x", "y", "outward", "across", "normal"];

// Least spin over still ground: that of a steady wobble of the same energy times ten times the tolerance. Rolling resistance
// takes spin by orders of magnitude in a pass, but never its sense.
function leastSpin(o, y) {
  const lever = (o.g + o.q) * o.b, level = Math.max(energy(o, y[0], y[1], y[3], 0), 0) / (1.5 * lever);
  return 10 * o.rtol * Math.sqrt(o.J * lever * level) * level;
}

// -- rest: too little energy is left to matter, and the ground holds the base

function sitsDown(o, y, flat, ax, ay, az) {
  const limit = REST * o.alpha;
  if (y[0] > 10 * limit) return false;
  const held = 1 + o.delta / o.b;
  let share = (1 + az / o.g) * held - Math.hypot(ax, ay) * o.ca / (o.g * o.sa);
  share = (share + held * o.q / o.g) / (1 + o.q / o.g);
  if (share <= 0 || excess(o, ax, ay, az) >= 0) return false;
  return energy(o, y[0], y[1], y[3], flat ? y[5] : 0) < share * energy(o, limit, 0, 0, 0);
}

// -- forces on the base, over the mass that it carries: outward, across, up

function contactForce(o, flat, y, ax, ay, az, slopes) {
  const theta = y[0], omega = y[1], S = flat ? y[5] : 0, s = Math.sin(theta), c = Math.cos(theta), t = Math.tan(theta / 2), sec = 1 + t * t;
  const roll = o.E + o.C * t, reach = o.h + o.b * t, H = o.J + (2 * o.E + o.C * t) * t, H1 = roll * sec;
  const D = s * reach, D1 = o.b * s + o.h * c, D2 = o.b * c - o.h * s, phiRate = slopes[2], twist = flat ? slopes[4] : 0;
  const ar = ax * Math.cos(y[2]) + ay * Math.sin(y[2]), at = ay * Math.cos(y[2]) - ax * Math.sin(y[2]);
  const spin = y[3] ? y[3] / (s * s * H) : 0, q = reach * roll / H, q1 = 0.5 * sec * (o.b * roll + o.C * reach) / H - q * H1 / H;
  const twisting = flat ? (slopes[5] * H + S * H1 * omega) / (o.J * o.C - o.E * o.E) : 0;
  const outward = D1 * slopes[1] + D2 * omega * omega - phiRate * (D * phiRate - o.b * twist);
  const across = spin * omega * (2 * o.b * t - D * H1 / H) + omega * twist * (0.5 * D1 * o.I2 * sec / H + q1) + (q - o.b) * twisting;
  let sideways = o.nu * across + at * (1 - o.nu * reach * reach / H);
  // what the couple takes off L' is all of L' beyond the push of the ground and the twist
  if (o.delta > 0 && s > 0) {
    const free = -s * reach * at - (flat ? o.mu * o.b * D1 * omega * twist : 0);
    sideways -= o.nu * reach / H * (free - slopes[3]) / s;
  }
  const half = Math.sin(theta / 2), pull = (o.q + 2 * o.k * half) * o.nu / o.gaps;
  return [o.nu * outward + ar + pull * half, sideways, o.g + az + o.nu * (D2 * slopes[1] - D1 * omega * omega) + pull * Math.cos(theta / 2)];
}

// -- the run

// In `problem`: what `bodyOf` takes; friction on flat ground (none: enough); support "recess", "flat" or "planar" with an azimuth; release { tilt, azimuth, rate } or
// none; restitution of impacts in a plane; duration. `motion` has samples x, y, z (or none), dt and a scale of each, or is null.
// Returns the outcome, the peak over alpha (infinite where it overturns, NaN where that is not decided) and, at each
// `sampleStep`, the motion.
function simulateMotion(problem, motion, { rtol = 1e-10, sampleStep = 0.01 } = {}) {
  const o = bodyOf(problem, rtol), planar = problem.support === "planar", flat = problem.support === "flat", n = flat ? 8 : 4;
  const azimuth = planar ? problem.azimuth || 0 : 0, release = problem.release, scale = motion ? motion.scale : [0, 0, 0];
  const length = motion ? motion.x.length : 0, dt = motion ? motion.dt : 1, ca = Math.cos(azimuth), sa = Math.sin(azimuth);
  const [gx, gy, gz] = [0, 1, 2].map(() => new Float64Array(length));
  for (let i = 0; i < length; i++) {
    const x = scale[0] * motion.x[i], y = scale[1] * motion.y[i];
    gx[i] = planar ? x * ca + y * sa : x; gy[i] = planar ? 0 : y; gz[i] = motion.z ? scale[2] * motion.z[i] : 0;
  }
  const pieceAfter = (i) => {
    if (i >= length - 1) return { x: 0, y: 0, z: 0, sx: 0, sy: 0, sz: 0, begin: Math.max(length - 1, 0) * dt, length: Infinity, step: dt };
    const x = gx[i], y = gy[i], z = gz[i];
    return { x, y, z, sx: (gx[i + 1] - x) / dt, sy: (gy[i + 1] - y) / dt, sz: (gz[i + 1] - z) / dt, begin: i * dt, length: dt, step: dt };
  };
  const shakes = (i) => gx[i] || gy[i] || gz[i];
  let last = Math.max(length - 1, 0);
  while (last > 0 && !shakes(last - 1) && !shakes(last)) last--;
  const stillFrom = last * dt, duration = problem.duration;
  const impact = Math.max(0, (o.A * (problem.restitution ?? 1) - o.delta * o.mu * o.b) / (o.A + o.delta * o.mu * o.b));

  const y = new Float64Array(8), k = new Float64Array(8), out = new Float64Array(8), kOut = new Float64Array(8);
  const error = new Float64Array(8), part = new Float64Array(8), kPart = new Float64Array(8);
  const run = { outcome: "stands", peak: 0, upliftTime: NaN, endTime: NaN, steps: 0 };
  let resting = true, h = FIRST_STEP / o.p, restart = true, lastMaximum = -1;
  let now = 0, index = 0, piece = pieceAfter(0), elapsed = 0, nextSample = 0, following = false, end = duration;

  if (release && release.tilt > 0) {
    const s = Math.sin(release.tilt), t = Math.tan(release.tilt / 2);
    y[0] = release.tilt;
    y[2] = planar ? (Math.cos(release.azimuth - azimuth) >= 0 ? 0 : Math.PI) : release.azimuth;
    y[3] = planar ? 0 : s * s * (o.J + (2 * o.E + o.C * t) * t) * (release.rate || 0);
    resting = false; run.upliftTime = 0; run.peak = y[0];
    derivative(o, flat, y, piece.x, piece.y, piece.z, k);
    if (k[1] < 0) lastMaximum = 0;
  }

  const most = sampleStep ? Math.ceil((duration + FOLLOWED / o.p) / sampleStep) + 4 : 0, buffer = new Float64Array(COLUMNS.length * most);
  const [times, tilts, angles, twists, xs, ys, outwards, acrosses, normals] = COLUMNS.map((_, i) => buffer.subarray(i * most, (i + 1) * most));
  let count = 0;
  const record = () => {
    if (!sampleStep) return;
    const ax = piece.x + piece.sx * elapsed, ay = piece.y + piece.sy * elapsed, az = piece.z + piece.sz * elapsed, i = count++;
    times[i] = now; tilts[i] = y[0]; angles[i] = resting ? NaN : y[2] + azimuth; twists[i] = y[4]; xs[i] = y[6]; ys[i] = y[7];
    if (restart && !resting) derivative(o, flat, y, ax, ay, az, k);
    [outwards[i], acrosses[i], normals[i]] = resting ? [Math.hypot(ax, ay), 0, o.g + az + o.q * o.nu / o.gaps] : contactForce(o, flat, y, ax, ay, az, k);
  };
  const isPlanar = (state) => state[3] === 0 && (!flat || state[5] === 0);
  const partial = (time) => step(o, flat, n, y, k, time, piece, elapsed, part, kPart, error);
  // time in a step at which `value` of the state changes its sign from that at `low`
  const crossing = (value, low, high, sign) => {
    let at = (low + high) / 2;
    for (let i = 0; i < 60 && high - low > 1e-13 * high; i++) {
      partial(at);
      const miss = value(part), slope = value(kPart, true);
      if (miss * sign > 0) low = at; else high = at;
      const guess = at - miss / slope;
      if (Math.abs(guess - at) <= 1e-13 * high) break;
      at = guess > low && guess < high ? guess : (low + high) / 2;
    }
    partial(at);
    return at;
  };
  const sitDown = () => { y.fill(0, 0, 2); y[3] = y[5] = 0; resting = true; };

  const border = o.b / o.h, slips = flat && !release && problem.friction < border;
  if (slips && !o.gamma) {
    if (sampleStep) { run.slides = true; count = slideMotion(problem, run, pieceAfter, sampleStep, [times, tilts, angles, twists, xs, ys, outwards, acrosses, normals]); }
    return finish();
  }
  record(); nextSample = 1;
  for (;;) {
    if (now >= end) {
      const grows = flat && o.delta > 0 && energy(o, y[0], y[1], y[3], y[5]) > energy(o, Math.min(run.peak, o.alpha), 0, 0, 0);
      if (resting || (lastMaximum >= stillFrom && !grows)) break;
      if (o.delta > 0 && creeps(o, y, flat, k)) break;
      if (following) { run.outcome = energy(o, y[0], y[1], y[3], flat ? y[5] : 0) < energy(o, Math.min(o.balance, HALF_PI), 0, 0, 0) && y[0] < o.balance ? "stands" : "undecided"; break; }
      following = true; end = now + FOLLOWED / o.p;
      index = length; piece = pieceAfter(index); piece.begin = now; elapsed = 0; restart = true;
    }
    // to the next record sample or the next sample asked for, at the latest
    const pieceEnd = piece.begin + piece.length, sampleTime = sampleStep ? nextSample * sampleStep : Infinity;
    let until = Math.min(pieceEnd, sampleTime, end);
    if (pieceEnd - until < 1e-9 * dt) until = Math.min(pieceEnd, end);
    const stop = until >= pieceEnd ? piece.length : until - piece.begin;
    while (elapsed < stop) {
      if (run.steps > BUDGET) { run.outcome = "undecided"; run.endTime = now; return finish(); }
      if (resting) {
        const at = upliftIn(o, piece, elapsed, stop);
        if (at < 0 || (at > elapsed && stop - at < HAIR / o.p)) { elapsed = stop; now = until; break; }
        const up = upliftOf(o, piece, at), time = Math.min(up.length, stop - at);
        lifted(o, piece, up, time, y[2], y);
        if (Number.isNaN(run.upliftTime)) run.upliftTime = piece.begin + at;
        elapsed = at + time; run.steps++;
        if (y[0] <= 0) { y[0] = y[1] = y[3] = 0; continue; }
        resting = false; restart = true; h = 0.1 * time; lastMaximum = -1;
        run.peak = Math.max(run.peak, y[0]);
        now = Math.min(piece.begin + elapsed, until);
        continue;
      }
      const still = piece.x === 0 && piece.y === 0 && piece.sx === 0 && piece.sy === 0;
      if (o.delta > 0 && !flat && still && y[3]) {
        const least = leastSpin(o, y);
        if (Math.abs(y[3]) < least) { y[3] = Math.sign(y[3]) * least; restart = true; }
      }
      if (restart) { derivative(o, flat, y, piece.x + piece.sx * elapsed, piece.y + piece.sy * elapsed, piece.z + piece.sz * elapsed, k); restart = false; }
      let size = Math.min(h, stop - elapsed);
      if (stop - elapsed - size < 1e-3 * size) size = stop - elapsed;
      const lowest = step(o, flat, n, y, k, size, piece, elapsed, out, kOut, error);
      run.steps++;
      const inPlane = isPlanar(y) && isPlanar(out);
      let ratio = ratioOf(o, flat, y, error, inPlane);
      if (!inPlane && lowest <= 0) ratio = NaN;
      if (!(ratio <= 1)) {
        h = size * (Number.isNaN(ratio) ? 0.1 : Math.max(0.1, 0.9 * ratio ** -0.2));
        if (h < 1e-15 * Math.max(1, now)) { run.outcome = "undecided"; run.endTime = now; return finish(); }
        continue;
      }
      const grown = size * Math.min(4, 0.9 * Math.max(ratio, 1e-4) ** -0.2);
      h = size < h ? Math.max(h, grown) : grown;
      let taken = size, landed = false, fell = out[0] >= HALF_PI, turned = 0;
      if (y[1] * out[1] < 0) {
        turned = crossing((state) => state[1], 0, size, Math.sign(y[1]));
        const tilt = part[0];
        if (y[1] > 0 && (!inPlane || tilt > 0)) {
          run.peak = Math.max(run.peak, tilt); lastMaximum = piece.begin + elapsed + turned;
          if (following && !(flat && o.delta > 0) && tilt < HALF_PI) return finish();
        }
        if (tilt >= HALF_PI) fell = true;  // it turns back beyond, within the step
      }
      if (inPlane && out[0] <= 0) {
        landed = true;
        const hops = turned && y[1] > 0;
        taken = crossing((state) => state[0], hops ? turned : 0, size, 1);
        out.set(part);
      } else if (fell) { taken = crossing((state) => state[0] - (state === part ? HALF_PI : 0), 0, turned || size, -1); out.set(part); }
      y.set(out); k.set(kOut);
      if (taken !== size) restart = true;
      elapsed = taken === size && size === stop - elapsed ? stop : elapsed + taken;
      now = elapsed >= stop ? until : piece.begin + elapsed;
      if (fell) { y[0] = HALF_PI; run.outcome = "overturned"; run.peak = HALF_PI; run.endTime = now; if (sampleStep) record(); return finish(); }
      run.peak = Math.max(run.peak, y[0]);
      if (landed) {
        y[0] = 0; y[1] = impact * Math.abs(y[1]); y[2] += y[2] > 0 ? -Math.PI : Math.PI; y[3] = 0;
        if (y[1] === 0) { sitDown(); continue; }
      }
      if (sitsDown(o, y, flat, piece.x + piece.sx * elapsed, piece.y + piece.sy * elapsed, piece.z + piece.sz * elapsed)) sitDown();
    }
    now = until;
    if (sampleStep && now >= sampleTime - 1e-9 * sampleStep) { if (now < duration - 1e-9) record(); else if (following) record(); nextSample++; }
    if (elapsed >= piece.length) {
      index++;
      piece = pieceAfter(index);
      if (index >= length - 1 && !following) piece.begin = now;
      elapsed = 0;
      if (index === length - 1 || index === 0) restart = true;
    }
    if (now >= end && !following) record();
  }
  return finish();

  function finish() {
    if (run.outcome !== "overturned") while (count && times[count - 1] > duration * (1 + 1e-12)) count--;
    COLUMNS.forEach((name, i) => { run[name] = buffer.subarray(i * most, i * most + count); });
    run.body = o;
    // a tendon that yields leaves no answer, but of what overturns before
    if (run.peak > o.yieldTilt && !(run.outcome === "overturned" && o.yieldTilt >= Math.min(o.balance, HALF_PI))) run.outcome = "yielded";
    // from b/h to 1.1 b/h it rocks and slides, and under a slab it slides as no model does
    if (slips ? o.gamma : flat && !release && problem.friction < 1.1 * border && !Number.isNaN(run.upliftTime)) run.outcome = "mixed";
    run.relativePeak = { stands: run.peak / o.alpha, overturned: Infinity }[run.outcome] ?? NaN;
    return run;
  }
}
