// a stretch of time selected in one of these figures is selected in all of them
function linkTime(plots) {
  let busy = false;
  plots.forEach((plot) =>
    plot.on("plotly_relayout", (change) => {
      if (busy) return;
      const update = {};
      if ("xaxis.range[0]" in change) {
        update["xaxis.range"] = [change["xaxis.range[0]"], change["xaxis.range[1]"]];
      } else if ("xaxis.autorange" in change) {
        update["xaxis.autorange"] = true;
      } else {
        return;
      }
      busy = true;
      Promise.all(plots.filter((other) => other !== plot).map((other) => Plotly.relayout(other, update))).finally(
        () => { busy = false; }
      );
    })
  );
}
