// one case at a time: its figures are drawn when it is first chosen, forty cases at once would take a minute
(function () {
  const sections = Array.from(document.querySelectorAll("section.case"));
  const chooser = document.getElementById("chooser");

  function draw(section) {
    const holders = Array.from(section.querySelectorAll("script[data-plot]"));
    const plots = holders.map((holder) => {
      const spec = JSON.parse(holder.textContent);
      holder.remove();
      spec.layout.template = PLOT_TEMPLATE;
      const plot = document.getElementById(holder.dataset.plot);
      Plotly.newPlot(plot, spec.data, spec.layout, PLOT_CONFIG);
      return plot;
    });
    linkTime(plots);
  }

  function show(id) {
    const chosen = sections.find((section) => section.id === id) || sections[0];
    sections.forEach((section) => { section.hidden = section !== chosen; });
    chooser.value = chosen.id;
    draw(chosen);
    return chosen;
  }

  function go(id) {
    // the address names the case, so that it can be passed on
    history.replaceState(null, "", "#" + id);
    show(id);
  }

  function step(by) {
    const at = sections.findIndex((section) => !section.hidden);
    go(sections[(at + by + sections.length) % sections.length].id);
  }

  chooser.addEventListener("change", () => go(chooser.value));
  document.getElementById("previous").addEventListener("click", () => step(-1));
  document.getElementById("next").addEventListener("click", () => step(1));
  window.addEventListener("hashchange", () => show(location.hash.slice(1)).scrollIntoView());
  const first = document.querySelector(".overview a");
  show(location.hash.slice(1) || (first ? first.getAttribute("href").slice(1) : ""));
})();
