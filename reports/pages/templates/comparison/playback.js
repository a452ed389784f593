// Plays the motion of one case in three dimensions: one run solid, one reduced model translucent over it.
function rockwobblePlayback(root, spec) {
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
  magnify.value = spec.shown;
  if (runs.length) modelChoice.value = spec.partners[0];

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

  let now = spec.start, playing = false, before = 0;
  const say = () => {
    clock.textContent = `${now.toFixed(2)} s of ${spec.length.toFixed(2)} s`;
    slider.value = now;
  };
  const draw = rockwobbleStage(plot, () => ({ b: spec.base_radius, height: spec.height, slab: spec.slab, tendon: spec.tendon }), () => show());
  const show = () => {
    say();
    const bodies = [
      ...(runs.length ? [runs[runChoice.value]] : []),
      ...(models.length ? [models[modelChoice.value]] : []),
    ].map((body) => {
      const at = pose(body, now);
      return { body, at, first: at.sample - spec.trail, last: at.sample };
    });
    draw(bodies, Number(magnify.value));
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
    if (now >= spec.length) now = spec.start;
    playing = true;
    button.textContent = "Pause";
    requestAnimationFrame((stamp) => { before = stamp; tick(stamp); });
  });
  slider.max = spec.length;
  slider.addEventListener("input", () => { now = Number(slider.value); show(); });
  runChoice.addEventListener("change", () => { modelChoice.value = spec.partners[runChoice.value]; show(); });
  modelChoice.addEventListener("change", show);
  magnify.addEventListener("change", show);
  runChoice.parentElement.hidden = !runs.length;
  show();
}
