// What a chart shows, for who does not see it: a sentence as its text alternative, and its points as a table. The page
// shows the first rows of it; a CSV file has all.
{
  const mostRows = 200;
  const listed = (names, most = 8) =>
      names.slice(0, most).join(", ") + (names.length > most ? " and " + (names.length - most) + " more" : "");

  // Whether one chart has several quantities upwards, each on an axis of its own.
  const severalQuantities = (view) => view.yAxes.filter((axis) => axis.name).length > 1;
  // What is drawn as rows [name, x, y, what is said of it], the quantity before the last where there are several; a
  // mark whose place says nothing has neither, one on an axis without a name no height.
  function rowsOf(figure, slot) {
    const {countOf, reader, rowAt, isShown} = ricochet.plot, rows = [], view = figure.viewOf(slot),
                                   several = view && severalQuantities(view),
                                   known = (value) => value !== null && value !== undefined && !Number.isNaN(value);
    for (const mark of view ? view.marks : []) {
      if (!isShown(mark, figure.hidden) || mark.mark === "image" || Array.isArray(mark.x)) continue;
      const axis = view.yAxes[mark.yAxis || 0], before = rows.length, x = reader(mark, "x"), y = reader(mark, "y"),
            name = mark.tags ? mark.tags.join(", ") : mark.name,
            low = mark.mark === "whiskers" ? (i) => "from " + ricochet.format.shown(mark.values[3 * i + 1]) : () => "";
      for (let i = 0; i < countOf(mark); ++i)
        if (mark.apart !== undefined) rows.push([name, mark.apart ? "" : x(i), "", rowAt(mark, i).text || ""]);
        else if (known(x(i)) && known(y(i)))
          rows.push([name, x(i), axis.hidden ? "" : y(i), rowAt(mark, i).text || low(i)]);
      if (several)
        for (const row of rows.slice(before)) row.splice(3, 0, axis.name || "");
    }
    return rows;
  }
  const heads = (figure, slot) => {
    const view = figure.viewOf(slot), {x, y} = view, {withUnit} = ricochet.format;
    return severalQuantities(view) ? ["of", withUnit(x), "value", "quantity", "remark"] :
                                     ["of", withUnit(x), withUnit(y), "remark"];
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
                   some = rows.slice(0, mostRows), remarks = rows.some((row) => row[row.length - 1] !== "");
    const cell = (value) =>
              (typeof value === "number" ? '<td class="number">' + shown(value, 9) : "<td>" + escape(value)) + "</td>",
          kept = (row) => (remarks ? row : row.slice(0, -1));
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
    csv: (figure, slot) => csv([heads(figure, slot)].concat(rowsOf(figure, slot))),
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
      const view = figure.viewOf(slot), {title} = figure.chartOf(slot), {shown, unit, count} = ricochet.format,
            {hidden} = figure;
      if (!view)
        return slot.element.setAttribute("aria-label", figure.description.title + ", " + title + ": nothing to show");
      const range = (quantity, {axis}) => quantity[0] +
          (axis.type === "category" ? "" :
                                      " from " + shown(axis.min, 4) + " to " + shown(axis.max, 4) + unit(quantity));
      const tagged = view.marks.some((mark) => mark.values),
            names = tagged ?
          figure.description.legend.filter((one) => ricochet.inView(one, figure.view) && !hidden.has(one.name))
              .map((one) => one.name) :
          ricochet.distinct(view.marks.filter((mark) => mark.mark !== "rule" && ricochet.plot.isShown(mark, hidden))
                                .map((mark) => mark.name));
      slot.element.setAttribute(
          "aria-label",
          figure.description.title + ", " + title + ": " + count(names.length, "series", "series") +
              (names.length ? " (" + listed(names) + ")" : "") + "; across " + range(view.x, slot.chart.plot.xs[0]) +
              "; upwards " + range(view.y, slot.chart.plot.ys[0]) + ". Enter shows the points as a table.");
      const open = slot.element.closest("figure").querySelector(".chart-data");
      if (open) open.replaceWith(table(figure, slot));
    },
  };
}
