// Plays the motion of one case in three dimensions: one run solid, one reduced model translucent over it.
function rockwobblePlayback(root, spec) {
  const numbers = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const MOVING = ["tilt", "rolling_angle", "twist", "contact_x", "contact_y"];
  const unpack = (body) => ({ ...body, ...Object.fromEntries(["time", ...MOVING].map((name) => [name, numbers(body[name])])) });
  const runs = spec.runs.map(unpack), models = spec.models.map(unpack);
  const find = (name) => root.querySelector(`[data-part="${name}"]`);
  const magnify = find("magnify"), runChoice = find("run"), modelChoice = find("model");

  const options = (choice, labels) => labels.forEach((label, value) => choice.add(new Option(label, value)));
  options(runChoice, runs.map((run) => run.label));
  options(modelChoice, models.map((model) => model.label));
  spec.magnify.forEach((factor) => magnify.add(new Option(`${factor} ×`, factor)));
  magnify.value = spec.shown;
  if (runs.length) modelChoice.value = spec.partners[0];

  const draw = rockwobbleStage(find("plot"), () => ({ b: spec.base_radius, height: spec.height, slab: spec.slab, tendon: spec.tendon }), () => show());
  const show = () => {
    const bodies = [
      ...(runs.length ? [runs[runChoice.value]] : []),
      ...(models.length ? [models[modelChoice.value]] : []),
    ].map((body) => {
      const at = rockwobblePose(body, clock.now);
      return { body, at, first: at.sample - spec.trail, last: at.sample };
    });
    draw(bodies, Number(magnify.value));
  };
  const clock = rockwobbleClock(find, show);
  Object.assign(clock, { length: spec.length, start: spec.start });
  runChoice.addEventListener("change", () => { modelChoice.value = spec.partners[runChoice.value]; show(); });
  modelChoice.addEventListener("change", show);
  magnify.addEventListener("change", show);
  runChoice.parentElement.hidden = !runs.length;
  clock.seek(spec.start);
}
