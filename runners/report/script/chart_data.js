// What a chart shows, for who does not see it: a sentence as its text alternative, and its points as a table. The page
// shows the first rows of it; a CSV file has all.
{
  const mostRows = 200;
  const listed = (names, most = 8) =>
      names.slice(0, most).join(", ") + (names.length > most ? " and " + (names.length - most) + " more" : "");

  // What the library draws and what is drawn by hand, as rows [name, x, y, what is said of it].
  function rowsOf(figure, slot) {
    const rows = [], view = figure.viewOf(slot), {selected} = slot.drawn.legend;
    slot.chart.getModel().eachSeries((series) => {
      if (series.subType === "custom" || selected[series.name] === false) return;
      const data = series.getRawData(),
            along = (axis) =>
                data.mapDimensionsAll(axis).find((name) => !data.getDimensionInfo(name).isCalculationCoord),
            x = along("x"), y = along("y");
      const read = (dimension, i) => {
        const {ordinalMeta} = data.getDimensionInfo(dimension), value = data.get(dimension, i);
        return ordinalMeta ? ordinalMeta.categories[value] : value;
      };
      if (!x || !y) return;
      for (let i = 0; i < data.count(); ++i) {
        const item = data.getRawDataItem(i),
              row = [series.name, read(x, i), read(y, i), (item && !Array.isArray(item) && item.text) || ""];
        if (!Number.isNaN(row[1]) && !Number.isNaN(row[2])) rows.push(row);
      }
    });
    for (const {tags, values, glyph} of view.sources ? view.sources() : []) {
      if (tags.some((tag) => figure.hidden.has(tag))) continue;
      const parts = glyph.shape === "whisker" ? 3 : 2, name = tags.join(", ");
      for (let i = 0; i < values.length; i += parts)
        rows.push([
          name, values[i], values[i + parts - 1], parts === 3 ? "from " + ricochet.format.shown(values[i + 1]) : ""
        ]);
    }
    return rows;
  }
  const heads = (figure, slot) => {
    const {x, y} = figure.viewOf(slot), {withUnit} = ricochet.format;
    return ["of", withUnit(x), withUnit(y), "remark"];
  };
  const field = (value) => {
    const text = typeof value === "number" ? ricochet.format.exact(value) : String(value);
    return /[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
  };
  const csv = (rows) => rows.map((row) => row.map(field).join(",")).join("\n") + "\n";
  function download(name, ending, blob) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name.replace(/[^A-Za-z0-9.-]+/g, "-").replace(/^-|-$/g, "") + "." + ending;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  function table(figure, slot) {
    const {escape, shown} = ricochet.format, rows = rowsOf(figure, slot), head = heads(figure, slot),
                   some = rows.slice(0, mostRows), remarks = rows.some((row) => row[3] !== "");
    const cell = (value) =>
              (typeof value === "number" ? '<td class="number">' + shown(value, 9) : "<td>" + escape(value)) + "</td>",
          kept = (row) => (remarks ? row : row.slice(0, 3));
    const file = figure.description.id + "-" + figure.chartOf(slot).title, rest = rows.length - some.length,
          box = document.createElement("div");
    box.className = "chart-data";
    box.innerHTML = '<div class="scroll tall" style="max-height:18rem"><table><thead><tr>' +
        kept(head).map((name) => '<th scope="col">' + escape(name) + "</th>").join("") + "</tr></thead><tbody>" +
        some.map((row) => "<tr>" + kept(row).map(cell).join("") + "</tr>").join("") +
        '</tbody></table></div><p class="fine">' +
        (rows.length ? ricochet.format.count(rows.length, "point", "points") +
                 (rest > 0 ? ", of which " + some.length + " are shown. " : ". ") :
                       "Nothing here that is a point: what fills this chart is in the tables beside this page. ") +
        (rows.length ?
             '<button type="button" class="plain-button">CSV of ' + (rows.length === 1 ? "it" : "all") + "</button>" :
             "") +
        "</p>";
    const button = box.querySelector("button");
    if (button)
      button.addEventListener(
          "click", () => download(file, "csv", new Blob([csv([head].concat(rows))], {type: "text/csv"})));
    ricochet.watchWidth(box.querySelector(".scroll"));
    return box;
  }

  ricochet.download = download;
  ricochet.csvText = csv;
  ricochet.chartData = {
    mostRows,
    rowsOf,
    // A button beside those of the picture files, and Enter on the chart itself.
    attach(figure, slot) {
      const place = slot.element.closest("figure"),
            button = Object.assign(document.createElement("button"), {type: "button", textContent: "data"});
      button.setAttribute("aria-expanded", "false");
      button.title = "The chart's points as a table";
      button.dataset.points = "";
      place.querySelector(".export").prepend(button);
      slot.element.tabIndex = 0;
      const toggle = () => {
        const shown = place.querySelector(".chart-data");
        button.setAttribute("aria-expanded", String(!shown));
        if (shown) {
          shown.remove();
          return;
        }
        if (!slot.chart) figure.draw(slot);
        slot.element.after(table(figure, slot));
      };
      button.addEventListener("click", toggle);
      slot.element.addEventListener("keydown", (event) => {
        if (event.key === "Enter") {
          event.preventDefault();
          toggle();
        }
      });
    },
    // The text alternative: what is drawn, along which axes, over which ranges; a table that stands open follows.
    describe(figure, slot) {
      const {title} = figure.chartOf(slot), view = figure.viewOf(slot), {shown, unit, count} = ricochet.format,
            {selected} = slot.drawn.legend;
      const extent = (name) => {
        const part = slot.chart.getModel().getComponent(name, 0);
        return part && part.axis ? part.axis.scale.getExtent() : [];
      };
      const range = (name, quantity, [low, high]) => quantity[0] +
          (slot.drawn[name] && [].concat(slot.drawn[name])[0].type === "category" ?
               "" :
               " from " + shown(low, 4) + " to " + shown(high, 4) + unit(quantity));
      const tagged =
                figure.description.legend.filter((entry) => !figure.hidden.has(entry.name)).map((entry) => entry.name),
            drawn = ricochet.distinct(
                slot.drawn.series.filter((one) => one.type !== "custom" && selected[one.name] !== false)
                    .map((one) => one.name));
      const names = view.sources ? tagged : drawn;
      slot.element.setAttribute(
          "aria-label",
          figure.description.title + ", " + title + ": " + count(names.length, "series", "series") +
              (names.length ? " (" + listed(names) + ")" : "") + "; across " + range("xAxis", view.x, extent("xAxis")) +
              "; upwards " + range("yAxis", view.y, extent("yAxis")) + ". Enter shows the points as a table.");
      const open = slot.element.closest("figure").querySelector(".chart-data");
      if (open) open.replaceWith(table(figure, slot));
    },
  };
}
