// The reduced models of a cylinder, or of a slab on cylinders, that rocks and wobbles: recess, flat ground, one plane.
//
// Written from the equations of the documentation (Theory), not from the Python code, with which a test compares it.
// Lengths in m, angles in rad, and all else per unit of the mass w m that gravity and the ground move, w = 1 + 2 gamma.
// State: tilt, its rate, rolling angle phi, L = B phi' (on flat ground B phi' - G tau'), twist tau, S = M tau', and the
// centre X, Y of the circle that the rim rolls on. In a recess the last four stay zero. L = 0 is motion in one plane: it
// goes through upright, where phi jumps by pi, and any other motion has a smallest tilt above zero.

const HALF_PI = Math.PI / 2;
const IN_PLANE = 1e-13;  // of the acceleration that uplifts: across a plane, as much is rounding

// Constants of the equations. gamma: mass of the slab over that of the columns; delta: length of rolling resistance [m];
// prestress and yield force (0: none) in weights of one column, stiffness in these per base radius; rtol: relative tolerance of one step.
function bodyOf({ height, diameter, gamma = 0, delta = 0, prestress = 0, stiffness = 0, yielding = 0, gravity: g = 9.81 }, rtol) {
  const b = diameter / 2, h = height / 2, R = Math.hypot(b, h), w = 1 + 2 * gamma, mu = (1 + 4 * gamma) / w;
  const I1 = (3 * b * b + height * height) / 12 / w, I2 = b * b / 2 / w, gaps = gamma > 0 ? 2 : 1;
  const A = I1 + mu * R * R, J = I1 + mu * h * h, C = I2 + mu * b * b, E = mu * h * b;
  const q = gaps * prestress * g / w, k = gaps * gaps * stiffness * g / w;
  const alpha = Math.atan2(b, h), sa = b / R, ca = h / R, p = Math.sqrt(g * R / A);
  const body = { b, h, R, w, mu, I1, I2, A, J, C, E, g, q, k, alpha, sa, ca, p, gaps, gamma, delta, drive: R / A, rtol };
  body.nu = w / (1 + gamma);  // force at the base for an acceleration of S over that for one of the ground
  body.fastest = p * Math.sqrt(1 + k * sa / g);
  body.slope = b / h * (1 + delta / b);  // horizontal over vertical acceleration that uplifts
  body.balance = balanceOf(body);
  // tilt at which the tension, prestress + stiffness gaps 2 sin(theta/2), is the yield force
  const half = (yielding - prestress) / (2 * gaps * stiffness);
  body.yieldTilt = !yielding || !(prestress || stiffness) || half >= 1 ? Infinity : half <= 0 ? 0 : 2 * Math.asin(half);
  return body;
}

// what the tendon adds to the normal force of both ends of a tilted column, and over b to the couple
const pull = (o, s, c) => o.q * Math.sqrt((1 + c) / 2) + o.k * s;

// static couple over R: of the weight and of the tendon, whose gaps a tilt opens by 2 b sin(theta/2) each
const couple = (o, s, c, gravity) => gravity * (o.sa * c - o.ca * s) + o.sa * pull(o, s, c);

// last value before `f` is above zero, which it is at `high` and not at `low`
function lastBelow(f, low, high) {
  for (;;) {
    const middle = (low + high) / 2;
    if (middle <= low || middle >= high) return low;
    if (f(middle) > 0) high = middle; else low = middle;
  }
}

function balanceOf(o) {
  const falling = (tilt) => -couple(o, Math.sin(tilt), Math.cos(tilt), o.g);
  if (o.q === 0 && o.k === 0) return o.alpha;
  return falling(HALF_PI) > 0 ? lastBelow(falling, o.alpha, HALF_PI) : Infinity;
}

// energy above upright; B of the rolling angle is s^2 H
function energy(o, theta, omega, L, S) {
  const s = Math.sin(theta), v = 2 * Math.sin(theta / 2) ** 2, t = Math.tan(theta / 2), H = o.J + (2 * o.E + o.C * t) * t;
  const spin = L ? L * L / (2 * s * s * H) : 0, twist = S ? S * S * H / (2 * (o.J * o.C - o.E * o.E)) : 0;
  const tendon = o.b * (2 * o.q * Math.sin(theta / 2) + o.k * v);
  return o.A * omega * omega / 2 + spin + twist + o.g * (o.b * s - o.h * v) + tendon;
}

// rate far below which the couple of rolling resistance vanishes; it falls with small tilts, for the sake of uplift
const creepRate = (o, s) => 1e-6 * o.p * Math.max(1e-6, Math.min(1, s / (1e-6 * o.alpha)));

// whether a tilted body is held, but for that
function creeps(o, y, flat, slopes) {
  const s = Math.sin(y[0]);
  return Math.hypot(y[1], s * ((flat ? slopes[4] : 0) - slopes[2])) < creepRate(o, s);
}

// -- equations of motion: y' into `out` under the ground acceleration ax, ay, az

function derivative(o, flat, y, ax, ay, az, out) {
  const theta = y[0], omega = y[1], phi = y[2], L = y[3], S = flat ? y[5] : 0;
  const s2 = Math.sin(theta / 2), c2 = Math.cos(theta / 2), s = 2 * s2 * c2, v = 2 * s2 * s2, c = 1 - v, t = s2 / c2, sec = 1 + t * t;
  const roll = o.E + o.C * t, H = o.J + (2 * o.E + o.C * t) * t, H1 = roll * sec, reach = o.h + o.b * t, rise = o.b * s + o.h * c;
  const sp = Math.sin(phi), cp = Math.cos(phi), ar = ax * cp + ay * sp;
  let at = ay * cp - ax * sp;
  if (L === 0 && S === 0 && Math.abs(at) <= IN_PLANE * (Math.abs(ax) + Math.abs(ay) + o.g * o.b / o.h)) at = 0;
  const spin = L ? L / (s * s * H) : 0;
  let tilting = spin * spin * s * (c * H + s * H1 / 2) / o.A;
  tilting -= o.drive * (couple(o, s, c, o.g + az) + (o.ca * c + o.sa * s) * ar);
  let phiRate = spin, lRate = -s * reach * at, tauRate = 0, sRate = 0;
  if (flat) {
    const det = o.J * o.C - o.E * o.E;
    tauRate = S * H / det;
    if (S) {
      const ratio1 = (o.C * sec * s * H / 2 - roll * (c * H + s * H1)) / (s * s * H * H);  // (G/B)'
      tilting += (-det * H1 / (2 * H * H) * tauRate - ratio1 * L) * tauRate / o.A;
      phiRate += roll / (s * H) * tauRate;
      lRate -= o.mu * o.b * rise * omega * tauRate;
    }
    const N1 = o.mu * o.b * o.b * o.I1 + t * (-2 * o.I2 * o.E + t * (o.C * (o.I1 - o.I2) + o.mu * o.I2 * o.h * o.h));
    sRate = (o.b * o.I1 - o.h * o.I2 * t) / H * at + (L ? sec * N1 / (2 * t * H * H) * omega * L : 0);
  }
  if (o.delta > 0) {  // a couple of delta N against the rolling of the rim; N has theta'' and theta'' has the couple
    const across = s * (tauRate - phiRate), lift = o.b * c - o.h * s;
    const load = o.delta * o.A * Math.max(0, o.g + az + pull(o, s, c) - o.mu * rise * omega * omega + o.mu * lift * tilting);
    const share = load / (o.A * Math.hypot(omega, across, creepRate(o, s)) + o.delta * lift * o.mu * omega);
    const first = -share * omega, second = -share * across;  // on the tilt and along the lean
    tilting += first / o.A;
    lRate -= s * second;
    if (flat) sRate += (s - roll / H) * second;
  }
  out[0] = omega; out[1] = tilting; out[2] = phiRate; out[3] = lRate;
  if (flat) { out[4] = tauRate; out[5] = sRate; out[6] = o.b * tauRate * sp; out[7] = -o.b * tauRate * cp; }
}

// -- uplift: series in the time since, as upright is a singular point of the polar coordinates with a regular solution

const standing = (o, az) => o.g + az + o.q;
const excess = (o, ax, ay, az) => Math.hypot(ax, ay) - standing(o, az) * o.slope;

// first time in a piece at which the excess reaches zero and rises, from `from` to `end`; -1 if none. It is convex in a piece.
function upliftIn(o, piece, from, end) {
  const f = (time) => excess(o, piece.x + piece.sx * time, piece.y + piece.sy * time, piece.z + piece.sz * time);
  if (f(from) > 0) return from;
  if (f(end) <= 0) return -1;
  return lastBelow(f, from, end);
}

function upliftOf(o, piece, at) {
  const ax = piece.x + piece.sx * at, ay = piece.y + piece.sy * at, az = piece.z + piece.sz * at;
  const size = Math.max(Math.hypot(ax, ay), 1e-12 * o.g), along = (ax * piece.sx + ay * piece.sy) / size;
  let cross = ax * piece.sy - ay * piece.sx;
  if (Math.abs(cross) * piece.step <= IN_PLANE * (Math.abs(ax) + Math.abs(ay) + o.g * o.b / o.h) * size) cross = 0;
  const turning = cross / (size * size), heavier = 1 + o.delta * o.mu * o.b / o.A, factor = o.drive * o.ca / heavier;
  const held = o.delta * standing(o, az) / (o.h * size), behind = held / (3 + held), rolling = turning * (1 - behind);
  const F0 = factor * Math.max(excess(o, ax, ay, az), 0), F1 = factor * (along - piece.sz * o.slope);
  const F2 = factor * size * turning * turning * (1 - behind * behind) + o.delta * standing(o, az) * rolling * rolling / (9 * o.A * heavier);
  const F3 = -3 * F2 * along / size;
  let Q = o.drive * (o.g + az) / o.ca * (1 + o.delta * o.b / (o.R * o.R)) / heavier;
  Q += o.drive * o.sa * (1 + o.delta / o.b) / heavier * (o.q * o.sa / o.ca - o.k) + o.J / o.A / heavier * rolling * rolling;
  const unit = 1 / Math.max(o.fastest, Math.hypot(piece.sx, piece.sy) / size), jumps = Math.abs(F1) * 1e-6 * unit < F0;
  let length = unit * (jumps ? 1e-6 : Math.min(Math.cbrt(o.rtol), 5e-3));
  if (jumps && F1) length = Math.min(length, 1e-3 * F0 / Math.abs(F1));
  return { ax, ay, az, size, cross, behind, F0, F1, F2, F3, Q, jumps, length, heavier };
}

function lifted(o, piece, up, time, last, y) {
  const { F0, F1, F2, F3, Q } = up, t = time;
  const theta = t * t * (F0 / 2 + t * (F1 / 6 + t * ((F2 + Q * F0) / 24 + t * (F3 + Q * F1) / 120)));
  const rate = t * (F0 + t * (F1 / 2 + t * ((F2 + Q * F0) / 6 + t * (F3 + Q * F1) / 24)));
  const second = F0 + t * (F1 + t * ((F2 + Q * F0) / 2 + t * (F3 + Q * F1) / 6));
  const bx = up.ax + piece.sx * t, by = up.ay + piece.sy * t, now = Math.max(Math.hypot(bx, by), 1e-12 * o.g);
  let angle = Math.atan2(-by, -bx), W = up.cross / (now * now), phiRate;
  if (up.jumps) {
    phiRate = W / (1 + 2 * o.J * F0 / (o.h * up.size) + o.delta * (standing(o, up.az) + o.mu * o.b * F0) / (2 * o.h * up.size));
    angle -= (W - phiRate) * t;
  } else {  // the contact lags behind the inertia force, which turns at the rate W
    angle -= up.behind * W * t;
    W *= 1 - up.behind;
    const W1 = -2 * W * (bx * piece.sx + by * piece.sy) / (now * now), lag = o.J / (o.h * now);
    const lag1 = -lag * (2 * second * W + 3 * rate * W1), lag2 = -lag * (2 * F1 * W + 5 * second * W1);
    angle -= lag * (2 * rate * (W + lag1) + theta * (W1 + lag2));
    phiRate = W + lag1;
  }
  angle += 2 * Math.PI * Math.round((last - angle) / (2 * Math.PI));
  const s = Math.sin(theta), tan = Math.tan(theta / 2);
  y[0] = theta; y[1] = rate; y[2] = angle; y[3] = s * s * (o.J + (2 * o.E + o.C * tan) * tan) * phiRate; y[5] = 0;
}

// -- steps: the pair of order 5(4) by J. R. Dormand and P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19-26

const A21 = 1 / 5, A31 = 3 / 40, A32 = 9 / 40, A41 = 44 / 45, A42 = -56 / 15, A43 = 32 / 9;
const A51 = 19372 / 6561, A52 = -25360 / 2187, A53 = 64448 / 6561, A54 = -212 / 729;
const A61 = 9017 / 3168, A62 = -355 / 33, A63 = 46732 / 5247, A64 = 49 / 176, A65 = -5103 / 18656;
const B1 = 35 / 384, B3 = 500 / 1113, B4 = 125 / 192, B5 = -2187 / 6784, B6 = 11 / 84;
const E1 = 71 / 57600, E3 = -71 / 16695, E4 = 71 / 1920, E5 = -17253 / 339200, E6 = 22 / 525, E7 = -1 / 40;
const [K2, K3, K4, K5, K6, AT] = Array.from({ length: 6 }, () => new Float64Array(8));

// From y with slope k1 over h, from `elapsed` of a piece on; returns the least tilt of all stages.
function step(o, flat, n, y, k1, h, piece, elapsed, out, k7, error) {
  const run = (share, k) => {
    const time = elapsed + share * h;
    derivative(o, flat, AT, piece.x + piece.sx * time, piece.y + piece.sy * time, piece.z + piece.sz * time, k);
  };
  let lowest = y[0];
  for (let i = 0; i < n; i++) AT[i] = y[i] + h * A21 * k1[i];
  lowest = Math.min(lowest, AT[0]); run(1 / 5, K2);
  for (let i = 0; i < n; i++) AT[i] = y[i] + h * (A31 * k1[i] + A32 * K2[i]);
  lowest = Math.min(lowest, AT[0]); run(3 / 10, K3);
  for (let i = 0; i < n; i++) AT[i] = y[i] + h * (A41 * k1[i] + A42 * K2[i] + A43 * K3[i]);
  lowest = Math.min(lowest, AT[0]); run(4 / 5, K4);
  for (let i = 0; i < n; i++) AT[i] = y[i] + h * (A51 * k1[i] + A52 * K2[i] + A53 * K3[i] + A54 * K4[i]);
  lowest = Math.min(lowest, AT[0]); run(8 / 9, K5);
  for (let i = 0; i < n; i++) AT[i] = y[i] + h * (A61 * k1[i] + A62 * K2[i] + A63 * K3[i] + A64 * K4[i] + A65 * K5[i]);
  lowest = Math.min(lowest, AT[0]); run(1, K6);
  for (let i = 0; i < n; i++) out[i] = AT[i] = y[i] + h * (B1 * k1[i] + B3 * K3[i] + B4 * K4[i] + B5 * K5[i] + B6 * K6[i]);
  lowest = Math.min(lowest, AT[0]); run(1, k7);
  for (let i = 0; i < n; i++) error[i] = h * (E1 * k1[i] + E3 * K3[i] + E4 * K4[i] + E5 * K5[i] + E6 * K6[i] + E7 * k7[i]);
  return lowest;
}

// Error over what is allowed. Near upright the motion is that of a point at the polar distance theta with one speed in
// all directions; near the balance, where differences grow as exp(p t), the distance from it takes the place of theta.
function ratioOf(o, flat, y, e, inPlane) {
  const rtol = o.rtol;
  const theta = Math.abs(y[0]), lever = inPlane ? 0 : 1 / (o.J * theta), away = Math.abs(o.balance - theta);
  const speed = Math.abs(y[1]) + Math.abs(y[3]) * lever, velocity = speed + o.p * Math.min(Math.sqrt(o.sa * theta), away);
  const distance = Math.min(inPlane ? theta + velocity / o.p : theta, away + speed / o.p), least = 2.3e-16 * theta;
  const perRate = 1 / Math.max(rtol * velocity, o.p * least);
  let ratio = Math.max(Math.abs(e[0]) / Math.max(rtol * distance, least), Math.abs(e[1]) * perRate, Math.abs(e[2]) / rtol, Math.abs(e[3]) * lever * perRate);
  if (flat) {
    ratio = Math.max(ratio, Math.abs(e[4]) / rtol, Math.abs(e[5]) * perRate / Math.sqrt(o.A * (o.C - o.E * o.E / o.J)));
    ratio = Math.max(ratio, Math.abs(e[6]) / (rtol * o.b), Math.abs(e[7]) / (rtol * o.b));
  }
  return ratio;
}
