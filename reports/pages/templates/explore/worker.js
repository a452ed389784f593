// Runs in the background: a request is answered by a run, with the time that it took [ms], or by a row of the map.
let motions = [];
const motionOf = ({ record, intensity }) => (record < 0 ? null : { ...motions[record], scale: intensity });

onmessage = ({ data }) => {
  if (data.motions) { motions = data.motions; return; }
  if (data.row) {
    const peaks = data.row.map((problem) => {
      const run = simulateMotion(problem, motionOf(problem), { rtol: 1e-6, sampleStep: 0 });
      return run.outcome === "overturned" ? Infinity : run.peak / run.body.alpha;
    });
    postMessage({ id: data.id, level: data.level, place: data.place, peaks });
    return;
  }
  const begin = performance.now();
  const run = simulateMotion(data.problem, motionOf(data.problem));
  postMessage({ run, took: performance.now() - begin }, [run.time.buffer]);
};
