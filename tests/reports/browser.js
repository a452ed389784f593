// A page looks at itself and tells its outer one: the number of its interactive figures, and a line for each
// thing that is wrong.
window.addEventListener("load", () => setTimeout(() => {
  const found = [];
  const edges = (element) => element.getBoundingClientRect();
  const inside = (part, whole) =>
    part.left > whole.left - 1 && part.right < whole.right + 1 && part.top > whole.top - 1 && part.bottom < whole.bottom + 1;
  const look = (chart) => {
    const say = (words) => found.push(`${chart.id}: ${words}`);
    const sheet = chart.querySelector("svg"), drawn = sheet && sheet.querySelector("[data-axis]");
    if (!drawn) { say("not drawn"); return; }
    if (edges(chart).right > edges(chart.parentElement).right + 1) say("wider than its place");
    const stated = JSON.parse(chart.querySelector("script").textContent);
    for (const axis of ["x", "y"]) {
      const title = sheet.querySelector(`[data-axis="${axis}"]`).textContent;
      // names of runs say what they are
      if (!/\[.+\]/.test(title) && !(stated[axis].ticks.length && !title)) say(`${axis} without a unit: "${title}"`);
    }
    if (!sheet.querySelector(".mark")) say("empty");
    for (const text of sheet.querySelectorAll("text")) {
      if (edges(text).width && !inside(edges(text), edges(sheet))) say(`text cut off: "${text.textContent}"`);
    }
  };
  const empty = (canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.every((value) => value === 0);
  };

  const charts = Array.from(document.querySelectorAll(".chart")).filter((chart) => chart.offsetParent);
  charts.forEach(look);
  const players = Array.from(document.querySelectorAll(".player canvas")).filter((canvas) => canvas.offsetParent);
  players.filter(empty).forEach(() => found.push("player: empty"));
  const wider = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  if (wider > 0) found.push(`the page scrolls sideways by ${wider} pixels`);
  for (const asked of performance.getEntriesByType("resource")) {
    const own = /^(data|blob|about):/.test(asked.name) || (window.home && asked.name.startsWith(window.home));
    if (!own) found.push(`asks for ${asked.name}`);
  }
  if (window.lookFurther) window.lookFurther(found);
  window.parent.postMessage([window.name, charts.length, ...found].join("\n"), "*");
}, 1200));
