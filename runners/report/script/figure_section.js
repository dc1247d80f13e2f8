// A figure as a part of the page: heading, caption, choice of views, legend, and a place for each chart with its notes.
{
  const {escape} = ricochet.format;
  const mostEntries = 12;  // of each heading at first sight
  // Where a view or a list of them, `only`, is shown.
  const whereShown = ({only}) =>
      (only === undefined ?
           "" :
           ' data-only="' + [].concat(only).join(" ") + '"' + (ricochet.inView({only}, 0) ? "" : " hidden"));
  function legend(entries, used) {
    if (entries.length < 2) return "";
    const groups = ricochet.groupBy(entries, ({heading, only}) => [heading, only]);
    return '<div class="legend" role="group" aria-label="Show or hide curves">' +
        Array.from(groups.values(), (group) => legendGroup(group, used)).join("") + "</div>";
  }
  function legendGroup(entries, used) {
    const [first] = entries, {heading} = first, rest = entries.slice(mostEntries);
    return '<div class="entries"' + whereShown(first) + ">" +
        (heading ? '<span class="heading">' + escape(heading) + "</span>" : "") +
        legendEntries(entries.slice(0, mostEntries), used) +
        (rest.length ? "<details><summary>" + rest.length + ' more</summary><div class="entries">' +
                 legendEntries(rest, used) + "</div></details>" :
                       "") +
        "</div>";
  }
  const legendEntries = (entries, used) =>
      entries
          .map((entry) => {
            const line = '<line x1="0" y1="6" x2="30" y2="6" stroke="' + entry.colour + '" stroke-width="2.2"' +
                (entry.dash ? ' stroke-dasharray="' + entry.dash + '"' : "") + "/>";
            const shape = ricochet.plot.shapes[entry.symbol], open = entry.hollow || entry.symbol === "cross",
                  fill = open ? (entry.hollow ? "#ffffff" : "none") : entry.colour,
                  mark = shape ? '<path transform="translate(15 6)" d="' + shape(4) + '" fill="' + fill + '"' +
                    (open ? ' stroke="' + entry.colour + '" stroke-width="1.6"' : "") + "/>" :
                                 "";
            return '<button type="button" aria-pressed="true" data-name="' + escape(entry.name) + '" title="' +
                escape(entry.name) + '"><svg width="30" height="12" aria-hidden="true">' + line + mark + "</svg>" +
                escape(ricochet.shorten(entry.name, used)) + "</button>";
          })
          .join("");
  function controls(figure) {
    let out = "";
    if (figure.views.length > 1)
      out += '<span class="choice" role="group" aria-label="Scale of the vertical axis">' +
          figure.views
              .map(
                  (name, v) => '<button type="button" data-view="' + v + '" aria-pressed="' + (v === 0) + '">' +
                      escape(name) + "</button>")
              .join("") +
          "</span>";
    if (figure.charts.length > 1)
      out += '<label title="Off: the same vertical scale in all charts, so that they compare">' +
          '<input type="checkbox" data-own> each chart its own scale</label>';
    if (figure.charts.length > 12)
      out += '<label>Show <input type="search" data-facets placeholder="words of a chart\'s title"></label>';
    // Which of its forms the figure takes.
    (figure.choices || []).forEach(({name, options, at}) => {
      out += "<label>" + escape(name) + " <select data-choice>" +
          options
              .map(
                  (option, k) =>
                      "<option" + (k === at ? " selected" : "") + ">" + escape(ricochet.shorten(option)) + "</option>")
              .join("") +
          "</select></label>";
    });
    return '<div class="controls">' + out + "</div>";
  }
  function classes({charts, linked, overTime}, strips) {
    if (linked && !overTime) return charts.length === 1 ? "grid single broad" : "grid stacked";
    if (charts.length === 1) return "grid single";
    if (strips.length > 1) return "grid strips";
    return charts.length > 12 ? "grid many" : charts.length === 2 || charts.length === 4 ? "grid pair" : "grid";
  }
  const notes = (list) => (
      list.length ? '<ul class="notes">' + list.map((note) => "<li>" + escape(note) + "</li>").join("") + "</ul>" : "");
  function place(figure, {chart, index, label}, used) {
    const single = figure.charts.length === 1 && /^all /.test(label), apart = chart.only !== undefined,
          wide = apart && figure.charts.every((other) => other === chart || other.only !== chart.only),
          title = escape(chart.title);
    let out = '<figure data-title="' + title + '"' + whereShown(chart) + (wide ? ' class="wide"' : "") +
        '><figcaption><span title="' + title + '">' + (single ? "" : escape(ricochet.shorten(label, used))) + "</span>";
    if (chart.views.length)
      out += '<span class="export"><button type="button" data-export="svg">SVG</button>' +
          '<button type="button" data-export="png">PNG</button></span>';
    out += "</figcaption>";
    if (chart.views.length)
      out += '<div class="chart" data-chart="' + index + '"' +
          (chart.height ? ' style="height:' + chart.height + 'px"' : "") + ' role="img" aria-label="' +
          escape(figure.title) + ": " + title + '"></div>';
    else out += '<p class="nothing">No curve: no case of this chart has one.</p>';
    chart.views.forEach((view, v) => {
      if (view.notes.length)
        out += '<div data-notes="' + (apart ? "" : v) + '"' + (v > 0 ? " hidden" : "") + ">" + notes(view.notes) +
            "</div>";
    });
    return out + notes(chart.notes) + "</figure>";
  }

  ricochet.figureSection = (figure) => {
    const section = document.createElement("section");
    section.className = "figure";
    section.id = "figure-" + figure.id;
    section.dataset.figure = figure.id;
    const used = new Set(), strips = ricochet.strips(figure.charts),
          across = Math.max(...strips.map((strip) => strip.charts.length));
    const charts = strips
                       .map(
                           ({label, charts: own}) => (label ? '<h4 class="strip" title="' + escape(label) + '">' +
                                                              escape(ricochet.shorten(label, used)) + "</h4>" :
                                                              "") +
                               own.map((one) => place(figure, one, used)).join(""))
                       .join("");
    section.innerHTML = "<h3>" + escape(figure.title) + '</h3><p class="caption">' + escape(figure.caption) + "</p>" +
        controls(figure) + legend(figure.legend, used) + '<div class="' + classes(figure, strips) +
        '" style="--across:' + across + '">' + charts + "</div>" +
        (used.size ? '<p class="fine key">' + escape(ricochet.keyTo(used)) + "</p>" : "");
    return section;
  };
}
