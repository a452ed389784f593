// A page looks at itself and tells its outer one: the number of its interactive figures, and a line for each
// thing that is wrong.
window.addEventListener("load", () => setTimeout(() => {
  const found = [];
  const edges = (element) => element.getBoundingClientRect();
  const inside = (part, whole) =>
    part.left > whole.left - 1 && part.right < whole.right + 1 && part.top > whole.top - 1 && part.bottom < whole.bottom + 1;
  const MARKS = ".scatterlayer .point, .scatterlayer .js-line, .barlayer path, .boxlayer path, .heatmaplayer image";

  const look = (plot) => {
    const say = (words) => found.push(`${plot.id || "player"}: ${words}`);
    const sheet = plot.querySelector(".main-svg"), drawn = plot._fullLayout;
    if (!sheet || !drawn) { say("not drawn"); return; }
    if (edges(sheet).right > edges(plot.parentElement).right + 1) say("wider than its place");
    if (edges(sheet).bottom > edges(plot.parentElement).bottom + 1) say("taller than its place");
    if (plot._fullData.some((trace) => trace.type.endsWith("3d"))) return;
    for (const name of ["xaxis", "yaxis"]) {
      const title = drawn[name].title.text || "";
      // names of runs say what they are
      if ((drawn[name].type === "category" || drawn[name].ticktext) && !title) continue;
      if (!/\[.+\]/.test(title)) say(`${name} without a unit: "${title}"`);
    }
    if (!plot.querySelector(MARKS)) say("empty");
    for (const text of plot.querySelectorAll("text")) {
      if (edges(text).width && !inside(edges(text), edges(sheet))) say(`text cut off: "${text.textContent}"`);
    }
  };

  const plots = Array.from(document.querySelectorAll(".plotly-graph-div")).filter((plot) => plot.offsetParent);
  plots.forEach(look);
  const wider = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  if (wider > 0) found.push(`the page scrolls sideways by ${wider} pixels`);
  for (const asked of performance.getEntriesByType("resource")) {
    const own = /^(data|blob|about):/.test(asked.name) || (window.home && asked.name.startsWith(window.home));
    if (!own) found.push(`asks for ${asked.name}`);
  }
  if (window.lookFurther) window.lookFurther(found);
  window.parent.postMessage([window.name, plots.length, ...found].join("\n"), "*");
}, 1200));
