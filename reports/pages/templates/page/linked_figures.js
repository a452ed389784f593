// a stretch selected in one of the figures that share an axis is selected in all of them, and so is a point
function linkFigures(root) {
  const linked = new Map();
  root.querySelectorAll(".plotly-graph-div").forEach((plot) => {
    const link = plot.layout && plot.layout.meta && plot.layout.meta.link;
    if (link) linked.set(link, [...(linked.get(link) || []), plot]);
  });
  linked.forEach(linkPlots);
}
function linkPlots(plots) {
  let busy = false;
  const others = (plot) => plots.filter((other) => other !== plot);
  plots.forEach((plot) => {
    plot.on("plotly_relayout", (change) => {
      const range = [change["xaxis.range[0]"], change["xaxis.range[1]"]];
      const update = range[0] !== undefined ? { "xaxis.range": range } : { "xaxis.autorange": true };
      if (busy || (range[0] === undefined && !("xaxis.autorange" in change))) return;
      busy = true;
      Promise.all(others(plot).map((other) => Plotly.relayout(other, update))).finally(() => { busy = false; });
    });
    plot.on("plotly_hover", (event) => others(plot).forEach((other) => {
      Plotly.relayout(other, { shapes: [...pinned(other), pin(event.points[0].x)] });
    }));
    plot.on("plotly_unhover", () => others(plot).forEach((other) => {
      Plotly.relayout(other, { shapes: pinned(other) });
    }));
  });
}
function pinned(plot) {
  return (plot.layout.shapes || []).filter((shape) => shape.name !== "pin");
}
function pin(x) {
  return { name: "pin", type: "line", x0: x, x1: x, y0: 0, y1: 1, yref: "paper", line: { color: "#888", width: 1 } };
}
linkFigures(document);
// a figure that is folded has no width until it is opened
document.querySelectorAll("details").forEach((fold) => fold.addEventListener("toggle", () => {
  fold.querySelectorAll(".plotly-graph-div").forEach((plot) => Plotly.Plots.resize(plot));
}));
