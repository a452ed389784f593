// What plays a motion, in a report and in the page to play with: its clock, and its pose at a time.

// Takes from `find` a button that plays, a slider over the time, a text and a choice of speed; `show()` draws the moment `now`
// of `length` [s]. A motion that has come to its end is played again from `start`.
function rockwobbleClock(find, show) {
  const [button, slider, text, speed] = ["play", "time", "clock", "speed"].map(find);
  const clock = { now: 0, length: 1, start: 0, playing: false, seek, play, pause };
  let before = 0;
  function seek(time) {
    clock.now = Math.min(Math.max(time, 0), clock.length);
    text.textContent = `${clock.now.toFixed(2)} s of ${clock.length.toFixed(2)} s`;
    slider.max = clock.length;
    slider.value = clock.now;
    show();
  }
  function pause() {
    clock.playing = false;
    button.textContent = "Play";
  }
  function play() {
    if (clock.now >= clock.length - 1e-9) clock.now = clock.start;
    clock.playing = true;
    button.textContent = "Pause";
    requestAnimationFrame((stamp) => { before = stamp; tick(stamp); });
  }
  function tick(stamp) {
    if (!clock.playing) return;
    // a slow machine shows fewer pictures, not a slower motion
    const next = clock.now + Math.min((stamp - before) / 1000, 0.25) * Number(speed.value);
    before = stamp;
    if (next >= clock.length) pause();
    seek(next);
    requestAnimationFrame(tick);
  }
  button.addEventListener("click", () => (clock.playing ? pause() : play()));
  slider.addEventListener("input", () => { pause(); seek(Number(slider.value)); });
  return clock;
}

// pose between two samples of `body`
function rockwobblePose(body, time) {
  let low = 0, high = body.time.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (body.time[middle] <= time + 1e-6) low = middle; else high = middle - 1;
  }
  const next = Math.min(low + 1, body.time.length - 1), length = body.time[next] - body.time[low];
  const share = length > 0 ? Math.min((time - body.time[low]) / length, 1) : 0, found = { sample: low };
  for (const name of ["tilt", "rolling_angle", "twist", "contact_x", "contact_y"]) found[name] = body[name][low] + share * (body[name][next] - body[name][low]);
  return found;
}
