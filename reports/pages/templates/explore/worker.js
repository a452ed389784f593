// Runs in the background: a problem is answered by its run, several are answered by their peaks over alpha.
let motions = [];
const motionOf = ({ record, intensity, factors = [1, 1] }) => (record < 0 ? null
  : { ...motions[record], scale: [intensity * factors[0], intensity * factors[1], intensity] });

onmessage = ({ data }) => {
  if (data.motions) { motions = data.motions; return; }
  if (data.problems) {
    postMessage({ ...data, peaks: data.problems.map((problem) => simulateMotion(problem, motionOf(problem), { rtol: 1e-6, sampleStep: 0 }).relativePeak) });
    return;
  }
  const run = simulateMotion(data.problem, motionOf(data.problem));
  postMessage({ run }, [run.time.buffer]);
};
