// From rest on flat ground with friction below b/h: x'' = -a - friction (g + az) v/|v|, exact and without tilt.

const SLIDE_STEP = 2e-4;  // [s]: within 1e-3 of the peak displacement

// Steps with friction at their middle: what it holds there stops, what it cannot hold starts. Returns the number of samples.
function slideMotion({ friction, gravity: g = 9.81, duration }, run, pieceAfter, sampleStep, [times, , angles, , xs, ys, outwards, , normals]) {
  let x = 0, y = 0, vx = 0, vy = 0, now = 0, count = 0;
  const at = ({ x: ax, y: ay, z: az, sx, sy, sz }, time) => [ax + sx * time, ay + sy * time, az + sz * time];
  const record = (ax, ay, az) => {
    const i = count++;
    times[i] = now; angles[i] = NaN; xs[i] = x; ys[i] = y; normals[i] = g + az;
    outwards[i] = vx || vy ? friction * (g + az) : Math.hypot(ax, ay);
  };
  record(...at(pieceAfter(0), 0));
  run.displacement = 0;
  for (let index = 0; now < duration * (1 - 1e-12); index++) {
    const piece = pieceAfter(index), whole = Math.min(piece.length, duration - now), parts = Math.ceil(whole / SLIDE_STEP), h = whole / parts, begin = now;
    for (let k = 0; k < parts; k++) {
      const [ax, ay, az] = at(piece, (k + 0.5) * h), px = vx - ax * h / 2, py = vy - ay * h / 2, speed = Math.hypot(px, py);
      if (g + az <= 0) { run.outcome = "undecided"; run.endTime = now; return count; }
      const share = Math.max(0, 1 - friction * (g + az) * h / (2 * speed)) || 0, mx = px * share, my = py * share;
      x += h * mx; y += h * my; vx = share && 2 * mx - vx; vy = share && 2 * my - vy;
      now = begin + (k + 1) * h;
      run.displacement = Math.max(run.displacement, Math.hypot(x, y));
      if (now >= count * sampleStep * (1 - 1e-12)) record(...at(piece, (k + 1) * h));
    }
  }
  const speed = Math.hypot(vx, vy), way = friction > 0 ? speed / (2 * friction * g) : 0;  // over still ground to rest
  run.residual = Math.hypot(x + way * vx, y + way * vy);
  run.displacement = Math.max(run.displacement, run.residual);
  return count;
}
