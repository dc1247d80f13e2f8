// The page as files, for papers. Opened at #export its text is a list of {name, svg, csv}, one for each chart in each
// view and one for each figure of an answer. Opened at #export-pages it is these alone, a sheet of its size for each.
{
  // A drawing of the page, which its style colours, as a file that stands alone.
  function alone(svg) {
    const out = svg.cloneNode(true),
          kept =
              [
                "fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-weight", "text-anchor",
                "opacity", "paint-order", "stroke-linejoin"
              ],
          copies = out.querySelectorAll("*"), {width, height} = svg.viewBox.baseVal;
    svg.querySelectorAll("*").forEach((one, k) => {
      const style = getComputedStyle(one);
      for (const name of kept) copies[k].setAttribute(name, style.getPropertyValue(name));
    });
    for (const [name, value] of Object.entries({width, height, "font-family": "system-ui, sans-serif"}))
      out.setAttribute(name, value);
    return new XMLSerializer().serializeToString(out);
  }
  function chartFiles(figure) {
    const {description} = figure, out = [];
    for (const view of description.views.map((_, v) => v)) {
      figure.view = view;
      for (const slot of figure.slots.filter((one) => figure.visible(one) && figure.viewOf(one))) {
        const {title, views} = figure.chartOf(slot),
                      words = [description.id, title, views.length > 1 ? description.views[view] : ""];
        out.push({
          name: words.filter(Boolean).join("-"),
          svg: ricochet.pictureText(figure, slot),
          csv: ricochet.chartData.csv(figure, slot)
        });
      }
    }
    return out;
  }
  function files() {
    const asked = Array
                      .from(
                          document.querySelectorAll(".asked"),
                          (ask, k) => [ask.querySelector("svg.ask-figure"), ask.querySelector("table"), k])
                      .filter(([svg, table]) => svg && table);
    return asked
        .map(([svg, table, k]) => ({name: "ask-" + (k + 1), svg: alone(svg), csv: ricochet.tableText(table, "CSV")}))
        .concat(ricochet.figures.flatMap(chartFiles));
  }
  // Whether the page was opened so.
  ricochet.startExport = () => {
    if (!location.hash.startsWith("#export")) return false;
    const found = files(), place = document.createElement(location.hash === "#export" ? "script" : "main");
    ricochet.figures.splice(0);
    document.querySelectorAll("style").forEach((one) => one.remove());
    if (location.hash === "#export") {
      Object.assign(
          place,
          {type: "application/json", id: "exported", textContent: JSON.stringify(found).replace(/</g, "\\u003c")});
    } else {
      const style = document.createElement("style");
      found.forEach(({svg}, k) => {
        const sheet = Object.assign(document.createElement("div"), {innerHTML: svg}),
              {width, height} = sheet.firstElementChild.viewBox.baseVal;
        style.textContent += "@page f" + k + " { size: " + Math.ceil(width) + "px " + Math.ceil(height) +
            "px; margin: 0 } .f" + k + " { page: f" + k + "; break-inside: avoid } ";
        sheet.className = "f" + k;
        place.append(sheet);
      });
      style.textContent += "body { margin: 0 } svg { display: block }";
      document.head.append(style);
    }
    document.body.replaceChildren(place);
    return true;
  };
}
