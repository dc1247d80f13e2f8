// Goes into a copy of a report. It draws every figure in every view, reads back what the charts then hold, and
// works the page's controls. It promises all of it as `probed`.
(() => {
  "use strict";
  const errors = [];
  window.addEventListener("error", (e) => errors.push(String(e.message)));
  window.addEventListener("unhandledrejection", (e) => errors.push(String(e.reason)));
  document.addEventListener(
      "securitypolicyviolation", (e) => errors.push("policy: " + e.violatedDirective + " " + e.blockedURI));
  const {all, coloured, pick, marksIn, readBack, notesIn} = window.readback;

  function checkLegend(figure, first, out) {
    const buttons = all(".legend button", figure.section), legend = buttons[0];
    if (!legend) return;
    legend.click();
    const name = legend.dataset.name, named = (one) => one.name === name || (one.tags || []).includes(name);
    out.hidden =
        figure.slots.every((s) => !s.chart || !figure.visible(s) || !s.chart.plot || !s.chart.plot.marks.some(named));
    legend.click();
    if (!first || !figure.viewOf(first) || !figure.viewOf(first).marks.some((mark) => mark.values)) return;
    // Without any entry of the legend nothing coloured is left, and with all of them everything is back.
    const full = coloured(first), redraw = () => figure.draw(first);
    buttons.forEach((b) => figure.hidden.add(b.dataset.name));
    redraw();
    out.hidden = out.hidden && coloured(first) < full / 10;
    figure.hidden.clear();
    redraw();
    out.hidden = out.hidden && coloured(first) === full;
  }
  // A drag over a chart shows that part of its axis, in all charts that are linked; a double click shows all.
  function checkZoom(figure, {chart: first}, {chart: last}, out) {
    const axis = () => first.plot.xs[0].axis, {min, max} = axis(), wide = max - min, frame = first.plot.frames[0],
          [left, right] = [0.25, 0.5].map((share) => first.plot.xs[0].at(min + share * wide)),
          middle = frame.y + 0.5 * frame.height, place = first.canvas.getBoundingClientRect();
    const send = (name, x) => first.canvas.dispatchEvent(new PointerEvent(name, {
      clientX: place.left + x,
      clientY: place.top + middle,
      pointerType: "mouse",
      pointerId: 1,
      button: 0,
      bubbles: true
    }));
    first.canvas.setPointerCapture = () => {};
    send("pointerdown", left);
    send("pointermove", 0.5 * (left + right));
    send("pointerup", right);
    const {windows, plot} = last, near = (value, share) => Math.abs(value - min - share * wide) < 0.01 * wide,
                    [from] = windows.x || [NaN];
    out.linked = Boolean(windows.x) && near(windows.x[0], 0.25) && near(windows.x[1], 0.5) && near(axis().min, 0.25);
    out.aligned = plot.xs.every((x) => Math.abs(x.at(from) - plot.xs[0].at(from)) < 0.5);
    first.canvas.dispatchEvent(new MouseEvent("dblclick", {bubbles: true}));
    out.reset = last.windows.x === null && last.plot.xs[0].axis.min === last.view.xAxes[0].min;
  }
  // A click on a drawn point opens that very orbit.
  function checkPanel(figure, slot, view) {
    const source = view.marks.find((one) => one.what === "points" && one.values.length),
          middle = source.orbits.length >> 1, parameter = source.values[2 * middle];
    slot.chart.pick(slot.chart.plot.pixel([parameter, source.values[2 * middle + 1]]));
    const panel = ricochet.sidePanel.panel(), shown = ricochet.sidePanel.shown(),
          charts = panel ? ricochet.sidePanel.charts() : [];
    const out = {
      opened: Boolean(panel),
      point: [parameter, source.values[2 * middle + 1]],
      charts: charts.map(marksIn),
      orbit: Boolean(shown) && shown.id === source.id &&
          ricochet.data.page.orbits.cases[shown.id].columns.parameter[shown.orbit] === parameter,
      canvases: panel ? all("canvas", panel).length : 0,
      command: panel ? panel.querySelector("pre").textContent : "",
      facts: panel ? all("dt", panel).length : 0
    };
    ricochet.sidePanel.close();
    return Object.assign(out, {closed: !ricochet.sidePanel.panel()});
  }
  // A click on a branch opens its orbit, one whose portrait the page carries.
  function checkBranch(figure, slot) {
    const {page} = ricochet.data, [id] = Object.keys(page.branches.cases),
          branches = new ricochet.Branches(ricochet.data), rows = Array.from(branches.portrayed(id).keys()),
          row = rows[rows.length >> 1];
    if (row === undefined) return null;
    const column = (name) => branches.column(id, name)[row];
    slot.chart.pick(slot.chart.plot.pixel([column("parameter"), column("tip")]));
    const panel = ricochet.sidePanel.panel(), shown = ricochet.sidePanel.shown() || {},
          charts = panel ? ricochet.sidePanel.charts() : [];
    const out = {
      opened: Boolean(panel),
      has: branches.portrayed(shown.id).has(shown.orbit),
      charts: charts.map(marksIn),
      commands: panel ? all("pre", panel).map((pre) => pre.textContent) : [],
      text: panel ? panel.textContent : "",
      tables: panel ? all("table", panel).map((table) => table.rows.length) : [],
      arc: String(branches.column(shown.id, "arc")[shown.orbit]),
      name: branches.branch(shown.id, shown.orbit).name
    };
    ricochet.sidePanel.close();
    return out;
  }
  // A click in an image of basins opens the cell that lies there.
  function checkCell(figure, slot) {
    const {xs, ys} = ricochet.data.page.basins, column = xs.length >> 1, row = ys.length >> 2;
    slot.chart.pick(slot.chart.plot.pixel([xs[column], ys[row]]));
    const panel = ricochet.sidePanel.panel(), shown = ricochet.sidePanel.shown();
    const out = {
      opened: Boolean(panel),
      cell: Boolean(shown) && shown.column === column && shown.row === row,
      command: panel ? panel.querySelector("pre").textContent : "",
      lines: panel ? all("p", panel).length : 0,
      wanted: xs[column] + "," + ys[row]
    };
    ricochet.sidePanel.close();
    return out;
  }
  // A map has a cell for every case; a click on one of its rows draws the charts of that row.
  function checkMap(figure) {
    const before = ricochet.figures.length, out = {
      rows: all(".map tbody tr", figure.section).length,
      cells: all("td[data-case]", figure.section).length,
      marks: all("td[data-case]", figure.section).filter((cell) => cell.textContent).length
    };
    all("[data-row]", figure.section)[0].click();
    out.charts = ricochet.figures.slice(before).map((one) => one.description.charts.length);
    ricochet.figures.slice(before).forEach(ricochet.unmount);
    return out;
  }
  // Another overlay makes the figure anew in its place, and back.
  function checkOverlay(figure) {
    const place = () => ricochet.figures.find((one) => one.section.id === figure.section.id), pick = (k) => {
      const [choice] = all("[data-choice]", place().section);
      choice.selectedIndex = k;
      choice.dispatchEvent(new Event("change"));
    };
    const first = figure.description.charts.length;
    pick(1);
    const next = place(), out = {
      charts: next.description.charts.length,
      names: next.description.legend.map((entry) => entry.name),
      anew: next !== figure && next.section.isConnected && !figure.section.isConnected
    };
    pick(0);
    out.back = place().description.charts.length === first;
    return out;
  }
  // The "?" beside a word opens what it means, and closes it.
  function checkExplained() {
    const [button] = all(".why");
    if (!button) return null;
    button.click();
    const note = document.getElementById(button.getAttribute("aria-controls")),
          out = {label: button.getAttribute("aria-label"), text: note ? note.textContent : ""};
    button.click();
    return Object.assign(out, {closed: !all(".meaning").length, count: all(".why").length});
  }
  // A click on a drawn point, or on a curve, of a case opens that case.
  function checkDoor(figure, slot) {
    const {rowsOf, countOf, reader} = ricochet.plot, {plot} = slot.chart;
    for (const mark of plot.marks.filter((one) => !one.values && (one.rows || one.case) && one.mark !== "cells")) {
      const rows = rowsOf(mark), x = reader(mark, "x"), y = reader(mark, "y"),
            isDrawn = (i) => (mark.case || (Array.isArray(rows) && rows[i].case)) && Number.isFinite(y(i)),
            at = Array.from({length: countOf(mark)}, (_, i) => i).filter(isDrawn), i = at[at.length >> 1];
      if (i === undefined || mark.mark === "bars") continue;
      const pixel = plot.pixel([x(i), y(i)], mark.yAxis);
      if (!pixel.every(Number.isFinite)) continue;
      slot.chart.pick(pixel);
      const panel = ricochet.sidePanel.panel(), shown = ricochet.sidePanel.shown() || {},
            text = panel ? panel.textContent : "";
      // Curves of other cases may pass through the same pixel.
      const there =
          plot.marks.flatMap((one) => one.case || (Array.isArray(one.rows) ? one.rows.map((row) => row.case) : []));
      const out = {
        opened: Boolean(panel),
        id: shown.id || "",
        one_of: there.includes(shown.id),
        says_id: text.includes("case " + shown.id),
        facts: panel ? all("dt", panel).length : 0,
        plots: ricochet.sidePanel.charts().length,
        headings: panel ? all("h4", panel).map((h) => h.textContent) : [],
        commands: panel ? all("pre", panel).map((pre) => pre.textContent) : [],
        text
      };
      ricochet.sidePanel.close();
      return out;
    }
    return null;
  }
  // A row of the table opens its case by Enter; › goes to the next; Escape closes and gives the focus back.
  function checkRowDoor() {
    const table = document.getElementById("cases"),
          row = table && Array.from(table.tBodies[0].rows).find((one) => one.dataset.case);
    if (!row) return null;
    const press = (target, key) =>
        target.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true, cancelable: true}));
    row.focus();
    press(row, "Enter");
    const {sidePanel} = ricochet, shown = sidePanel.shown(),
          out = {opened: Boolean(shown) && shown.id === row.dataset.case};
    if (!out.opened) return out;
    const next = sidePanel.panel().querySelector('[aria-label="next case"]'),
          index = ricochet.data.byId.get(row.dataset.case).index;
    next.click();
    out.next = index + 1 < ricochet.data.cases.length ? sidePanel.shown().id === ricochet.data.cases[index + 1].id :
                                                        next.disabled;
    press(document.body, "Escape");
    out.closed = !sidePanel.panel();
    out.focus = document.activeElement === row;
    return out;
  }
  // What hovering says somewhere over a chart.
  function hovered({chart}) {
    const {x, y, width, height} = chart.plot.frames[0];
    for (const share of [0.5, 0.25, 0.75, 0.1, 0.9])
      for (let at = 0; at < height; at += 2) {
        const said = chart.words([x + share * width, y + at]);
        if (said) return said;
      }
    // Marks may be few.
    const {reader, countOf} = ricochet.plot,
                   mark = chart.plot.marks.find((one) => !one.silent && one.x && !Array.isArray(one.x) && countOf(one));
    return mark ? chart.words(chart.plot.pixel([reader(mark, "x")(0), reader(mark, "y")(0)], mark.yAxis)) : "";
  }
  // The film: what the slider's place shows is the state of that instant, the map has its marks, and playing goes on.
  async function checkFilm() {
    const {film} = ricochet;
    if (!film) return null;
    film.load();
    const slider = film.time, last = Number(slider.max), places = [0, last >> 2, last >> 1, last], states = [];
    for (const place of places) {
      slider.value = String(place);
      slider.dispatchEvent(new Event("input"));
      const {films} = film.state(), {one} = film.films[0].shots, curve = ricochet.data.curve(one, "tip_displacement");
      let sample = -1;
      if (curve)
        curve.x.forEach((t, i) => {
          if (Math.abs(t - films[0].t) <= 1e-6 * curve.x[curve.x.length - 1]) sample = i;
        });
      states.push({place, ...films[0], curve: sample < 0 ? null : curve.y[sample], said: film.now.textContent});
    }
    const key = (name) =>
        film.stage.dispatchEvent(new KeyboardEvent("keydown", {key: name, bubbles: true, cancelable: true}));
    film.go(1);
    key("ArrowRight");
    const stepped = film.state().k;
    key("ArrowLeft");
    key("ArrowLeft");
    const back = film.state().k;
    film.length.value = "5";
    key(" ");
    const playing = film.state().playing;
    // Until it has moved, or has had time to.
    await new Promise((done) => {
      const until = performance.now() + 300000;
      (function
           look() { film.state().k > back || performance.now() > until ? done() : requestAnimationFrame(look); })();
    });
    const moved = film.state().k;
    if (film.state().playing) key(" ");  // unless it came to its end
    const hue = (canvas) => {
      const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      let count = 0;
      for (let i = 0; i < data.length; i += 4)
        if (data[i + 3] &&
            Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 24)
          ++count;
      return count;
    };
    const maps = film.maps.map((map) => {
      const {one} = map.shots;
      return {
        id: one.id,
        marks: Number(map.canvas.dataset.marks),
        impacts: one.measures.impacts,
        coloured: hue(map.canvas)
      };
    });
    return {
      states,
      stepped,
      back,
      playing,
      moved,
      stopped: !film.state().playing,
      maps,
      stage: hue(film.stage),
      scale: film.scale.textContent,
      cases: film.cases.length
    };
  }
  function checkFigure(figure, controls) {
    const {description} = figure, views = Math.max(1, all("[data-view]", figure.section).length);
    const out = {
      id: description.id,
      title: description.title,
      caption: figure.section.querySelector(".caption").textContent,
      views: description.views,
      linked_along: Boolean(description.linked),
      legend: all(".legend button[aria-pressed=true]", figure.section).map((b) => b.dataset.name),
      entries: description.legend.map((entry) => pick(entry, ["name", "colour", "symbol", "heading"])),
      charts: description.charts.map((chart) => Object.assign(pick(chart, ["title", "only"]), {views: []}))
    };
    const links = all("nav a").map((a) => a.getAttribute("href"));
    out.anchored = links.includes("#" + figure.section.id);
    if (description.map) out.map = checkMap(figure);
    for (let view = 0; view < views; ++view) {
      if (figure.view !== view) figure.show(view);  // what stands beside the answer may begin with another
      figure.drawAll();
      for (const slot of figure.slots)
        if (figure.visible(slot))
          out.charts[slot.index].views.push(
              Object.assign(readBack(figure, slot), {notes: notesIn(figure, slot.index)}));
    }
    description.charts.forEach((chart, index) => {
      if (!chart.views.length) out.charts[index].notes = notesIn(figure, index);
    });
    if (views > 1) figure.show(0);
    if (!controls) return out;
    const seen = figure.slots.filter((slot) => figure.visible(slot) && slot.chart && slot.chart.view), first = seen[0];
    checkLegend(figure, first, out);
    // A chart whose curves all ended early has a shorter axis of its own.
    const end = (slot) => slot.chart.plot.xs[0].axis.max;
    if (description.linked && first)
      checkZoom(figure, first, seen.filter((slot) => end(slot) === end(first)).pop(), out);
    if (!first) return out;
    out.svg = ricochet.picture(figure, first, "svg").size;
    out.png = ricochet.picture(figure, first, "png").size;
    out.hovered = hovered(first);
    const apart = figure.viewOf(first).open;  // has a panel of its own
    out.door = apart ? null : seen.map((slot) => checkDoor(figure, slot)).find(Boolean) || null;
    if (description.id === "diagram") out.panel = checkPanel(figure, first, figure.viewOf(first));
    if (description.id === "branches") out.branch = checkBranch(figure, first);
    if (description.id === "basins") out.cell = checkCell(figure, first);
    if ((description.choices || []).some((choice) => choice.name === "Overlay")) out.overlay = checkOverlay(figure);
    return out;
  }
  function checkTable() {
    const table = document.getElementById("cases");
    if (!table) return null;
    const body = table.tBodies[0], order = () => Array.from(body.rows, (r) => r.cells[0].textContent).join(),
          visible = () => Array.from(body.rows).filter((r) => !r.hidden).length;
    const words = document.getElementById("filter"), say = (text) => {
      words.value = text;
      words.dispatchEvent(new Event("input"));
    };
    let sorts = body.rows.length < 2;
    for (const header of all("thead button", table)) {
      header.click();
      const up = order();
      header.click();
      sorts = sorts || up !== order();
    }
    say("no row says this");
    const filtered = visible();
    say("");
    return {rows: body.rows.length, sorts, filtered, restored: visible()};
  }
  // Numbers written as the page writes them, for comparison with the program's own.
  function checkWords(given) {
    const {text, exact} = ricochet.format, {roundOutwards, wholeDecades, Interval} = ricochet;
    return given.map(([low, high]) => ({
                       text: text(low),
                       exact: exact(low),
                       round: pick(roundOutwards(new Interval(low, high), 0), ["low", "high"]),
                       decades: low > 0 ? pick(wholeDecades(new Interval(low, high)), ["low", "high"]) : null
                     }));
  }

  window.probed = new Promise((done) => window.addEventListener("load", async () => {
    const asked = JSON.parse(document.documentElement.dataset.asked),
          size = () => ({height: document.documentElement.scrollHeight, nodes: all("*").length});
    let out = null;
    try {
      const opened = size();
      ricochet.later.fillAll();
      out = {
        opened,
        ...size(),
        explained: checkExplained(),
        answer: all("#answer-figure .figure").map((section) => section.dataset.figure),
        figures: ricochet.figures.slice().map((figure) => checkFigure(figure, asked.controls)),
        row: asked.controls ? checkRowDoor() : null,
        film: await checkFilm(),
        table: checkTable(),
        words: checkWords(asked.numbers || []),
        canvases: all("canvas").length
      };
    } catch (e) { errors.push(String((e && e.stack) || e)); }
    done(Object.assign({errors}, out));
  }));
})();
