// The panel beside the page that shows what a click chose: an orbit, a cell of an image, or a case.
{
  let panel = null, charts = [], shown = null, before = null;  // before: what had the focus
  const element = (name, classes, text) => {
    const e = document.createElement(name);
    if (classes) e.className = classes;
    if (text !== undefined) e.textContent = text;
    return e;
  };

  function clear() {
    charts.forEach((chart) => chart.dispose());
    charts = [];
    if (panel) panel.remove();
    panel = shown = null;
  }
  // The focus goes back to where it was.
  function close() {
    const back = panel ? before : null;
    clear();
    before = null;
    if (back && back.isConnected) back.focus({preventScroll: true});
  }
  function button(text, label, action) {
    const out = element("button", "", text);
    out.type = "button";
    out.setAttribute("aria-label", label);
    out.addEventListener("click", action);
    return out;
  }
  // An empty panel under a title; `keys` stand beside it, `what` is what it shows.
  function open(what, label, colour, title, keys) {
    if (!panel) before = document.activeElement;
    clear();
    panel = element("aside", "orbit");
    panel.setAttribute("aria-label", label);
    panel.tabIndex = -1;
    const head = element("div", "orbit-head"), words = element("h3", "", title), swatch = element("span", "swatch"),
          beside = element("span", "orbit-keys");
    swatch.style.background = colour;
    words.prepend(swatch);
    for (const key of keys) beside.appendChild(key);
    beside.appendChild(button("×", "close", close));
    head.append(words, beside);
    panel.appendChild(head);
    document.body.appendChild(panel);
    shown = what;
    return panel;
  }
  const say = (text) => panel.appendChild(element("p", "fine", text));
  // A command, and a button that copies it.
  function command(text) {
    const line = element("pre", "", text), copy = button("copy", "copy this command", () => ricochet.copy(text, () => {
                                             copy.textContent = "copied";
                                           }));
    copy.className = "copy";
    const box = element("div", "command");
    box.append(line, copy);
    panel.appendChild(box);
  }
  const heading = (text) => panel.appendChild(element("h4", "", text));
  function list(facts, into = panel) {
    const out = element("dl", "glossary");
    for (const [name, value] of facts) out.append(element("dt", "", name), element("dd", "", value));
    into.appendChild(out);
  }
  // What is there for who asks.
  function more(summary, facts) {
    const box = element("details");
    box.appendChild(element("summary", "", summary));
    list(facts, box);
    panel.appendChild(box);
  }
  // Rows of cells, the columns as [name, whether they are numbers].
  function table(columns, rows) {
    const box = element("div", "scroll"), out = element("table"), line = (into, cells, name) => {
      const row = into.insertRow();
      cells.forEach((cell, c) => row.appendChild(element(name, columns[c][1] ? "number" : "text", cell)));
    };
    line(out.createTHead(), columns.map(([name]) => name), "th");
    const body = out.createTBody();
    for (const cells of rows) line(body, cells, "td");
    box.appendChild(out);
    panel.appendChild(box);
  }
  // Marks over axes that fit them.
  function plot(x, y, marks, classes) {
    const box = element("div", classes), {reader, countOf} = ricochet.plot, range = (along) => {
      const out = new ricochet.Interval();
      for (const mark of marks) {
        const at = reader(mark, along);
        for (let i = 0; i < countOf(mark); ++i) out.include(at(i));
      }
      return ricochet.roundOutwards(out.empty ? new ricochet.Interval(0, 1) : out, 1e-12);
    };
    panel.appendChild(box);
    const chart = new ricochet.Chart(box),
          view = ricochet.view(x, y, ricochet.valueAxis(x, range("x")), ricochet.valueAxis(y, range("y")));
    chart.show(Object.assign(view, {marks}));
    charts.push(chart);
  }
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") close();
  });

  const quoted = (text) => (/^[\w./+-]+$/.test(text) ? text : "'" + text.replace(/'/g, "'\\''") + "'");
  // Words of a command, `point` or `case`, that speaks of a case of this study.
  function commandOf(study, id, word = "point") {
    const folder = location.protocol === "file:" ?
        decodeURIComponent(location.pathname).replace(/\/[^/]*$/, "") || "/" :
        "results/" + study;
    return "ricochet " + word + " " + quoted(folder) + " " + quoted(id);
  }

  ricochet.sidePanel = {
    open,
    close,
    say,
    command,
    heading,
    list,
    more,
    table,
    plot,
    button,
    quoted,
    commandOf,
    panel: () => panel,
    shown: () => shown,
    charts: () => charts
  };
}
