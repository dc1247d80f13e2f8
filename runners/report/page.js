// The page's own script: draws the charts that the page describes, links their zoom, exports them, sorts and filters the table.
(function () {
  "use strict";
  const errors = [];
  window.addEventListener("error", (e) => errors.push(String(e.message)));
  window.addEventListener("unhandledrejection", (e) => errors.push(String(e.reason)));
  document.addEventListener("securitypolicyviolation", (e) => errors.push("policy: " + e.violatedDirective + " " + e.blockedURI));

  const all = (selector, from) => Array.from((from || document).querySelectorAll(selector));
  const read = (id) => { const e = document.getElementById(id); return e ? JSON.parse(e.textContent) : null; };
  const escapeText = (s) => String(s).replace(/[&<>"']/g, (c) => "&#" + c.charCodeAt(0) + ";");

  // ---- numbers ------------------------------------------------------------------------------------------------------
  function number(value, digits) {
    if (!Number.isFinite(value)) return "–";
    let text = Number(value.toPrecision(digits || 6));
    text = text !== 0 && (Math.abs(text) < 1e-3 || Math.abs(text) >= 1e6) ? text.toExponential() : String(text);
    return text.replace("e+", "e").replace("-", "−").replace("e-", "e−");
  }
  const superscript = (n) => String(n).replace(/./g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
  function power(value) {
    const k = Math.log10(value);
    if (Math.abs(k - Math.round(k)) > 1e-6) return "";
    return k >= 0 && k <= 2 ? String(Math.round(value)) : "10" + superscript(Math.round(k));
  }

  // ---- data ---------------------------------------------------------------------------------------------------------
  const decoded = new Map();
  let blocks = null;
  const types = { f32: Float32Array, u8: Uint8Array, u16: Uint16Array, u32: Uint32Array };
  // Numbers of a named type; null where the page has no such block. The bytes are little-endian, as every browser's machine is.
  function block(name) {
    if (!decoded.has(name)) {
      const type = Object.keys(types).find((t) => blocks[name + ":" + t] !== undefined);
      if (!type) return null;
      const binary = atob(blocks[name + ":" + type]), bytes = new Uint8Array(binary.length);
      for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
      decoded.set(name, new types[type](bytes.buffer));
    }
    return decoded.get(name);
  }
  function column(key) {
    if (!decoded.has(key)) {
      const binary = atob(blocks[key]), bytes = new Uint8Array(binary.length);
      for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
      const view = new DataView(bytes.buffer), values = new Float64Array(bytes.length / 8);
      for (let i = 0; i < values.length; ++i) values[i] = view.getFloat64(8 * i, true);
      decoded.set(key, values);
    }
    return decoded.get(key);
  }
  function points(reference) {
    const x = column(reference.x), y = column(reference.y), out = new Array(x.length);
    const scale = reference.scale || 1, base = reference.base || 0;
    for (let i = 0; i < x.length; ++i) {
      const value = scale * (y[i] - base);
      out[i] = [x[i], reference.modulus ? Math.abs(value) : value];
    }
    return out;
  }

  // ---- options ------------------------------------------------------------------------------------------------------
  function unit(quantity) { return quantity[1] === "1" || quantity[1] === "" ? "" : " " + quantity[1]; }
  function tooltip(view) {
    const row = (p) => {
      const value = Array.isArray(p.value) ? p.value[1] : p.value;
      if (p.data && p.data.text) return '<div class="tip-row">' + p.marker + escapeText(p.seriesName) + '</div><div class="tip-text">' + escapeText(p.data.text) + "</div>";
      return '<div class="tip-row">' + p.marker + escapeText(p.seriesName) + "<b>" + number(value, 9) + escapeText(unit(view.y)) + "</b></div>";
    };
    return (given) => {
      const list = Array.isArray(given) ? given : [given];
      const first = list.find((p) => Array.isArray(p.value));
      if (!first) return "";
      const head = escapeText(view.x[0]) + " = " + number(first.value[0], 7) + escapeText(unit(view.x));
      return "<div>" + head + '</div><div class="fine">' + escapeText(view.y[0]) + "</div>" + list.filter((p) => Array.isArray(p.value)).map(row).join("");
    };
  }
  function revive(view, value) {
    if (value === "@number") return (v) => number(v);
    if (value === "@power") return power;
    if (value === "@tooltip") return tooltip(view);
    if (value === "@orbit-tooltip") return ricochetDynamics.tooltip(view);
    if (value === "@cell") return ricochetDynamics.drawCell;
    if (value === "@image") return ricochetDynamics.drawImage(view);
    if (value === "@cell-tooltip") return ricochetDynamics.cellTooltip(view);
    if (Array.isArray(value)) return value.map((v) => revive(view, v));
    if (value && typeof value === "object") {
      if (typeof value.x === "string" && typeof value.y === "string") return points(value);
      if (typeof value.sweep === "string") return value;
      return Object.fromEntries(Object.entries(value).map(([k, v]) => [k, revive(view, v)]));
    }
    return value;
  }

  // ---- figures ------------------------------------------------------------------------------------------------------
  const figures = [];
  class Figure {
    constructor(description, section) {
      Object.assign(this, { description, section, view: 0, own: false, zoom: null, hidden: new Set(), slots: [] });
      for (const element of all(".chart", section)) this.slots.push({ element, chart: null, index: Number(element.dataset.chart) });
      all("[data-view]", section).forEach((b) => b.addEventListener("click", () => this.show(Number(b.dataset.view))));
      all("[data-own]", section).forEach((b) => b.addEventListener("change", () => { this.own = b.checked; this.redraw(); }));
      all(".legend button", section).forEach((b) => b.addEventListener("click", () => this.toggle(b)));
      all("[data-export]", section).forEach((b) => b.addEventListener("click", () => this.save(b)));
      all("[data-facets]", section).forEach((b) => b.addEventListener("input", () => this.filter(b.value)));
    }
    viewOf(slot) {
      const views = this.description.charts[slot.index].views;
      return views[Math.min(this.view, views.length - 1)];
    }
    visible(slot) {
      const only = this.description.charts[slot.index].only;
      return only === undefined || only === this.view;
    }
    selected(series) {
      const names = {};
      for (const one of series) {
        const off = this.hidden.has(one.name) || (one.tags || []).some((tag) => this.hidden.has(tag));
        names[one.name] = !off && names[one.name] !== false;
      }
      return names;
    }
    option(slot) {
      const view = this.viewOf(slot);
      const option = revive(view, view.option);
      if (!option.series) return null;
      ricochetDynamics.dress(view, option, this.hidden);
      if (this.own) for (const axis of [].concat(option.yAxis).slice(0, 1)) { delete axis.min; delete axis.max; }
      option.legend.selected = this.selected(option.series);
      // The brush that a drag starts belongs to the toolbox; its icons stay out of sight.
      option.toolbox = { itemSize: 0, showTitle: false, feature: { dataZoom: { yAxisIndex: false, filterMode: this.description.overTime ? "filter" : "none", icon: { zoom: "path://", back: "path://" } } } };
      return option;
    }
    draw(slot) {
      if (!this.visible(slot)) return;
      const option = this.option(slot);
      if (!option) { if (slot.chart) slot.chart.clear(); return; }
      if (!slot.chart) {
        slot.chart = echarts.init(slot.element, null, { renderer: "canvas" });
        slot.chart.on("datazoom", (event) => this.follow(slot, event));
        slot.chart.getZr().on("dblclick", () => this.reset());
        slot.chart.getZr().on("mousemove", (event) => this.hover(slot, [event.offsetX, event.offsetY], event.event));
        slot.chart.getZr().on("globalout", () => ricochetDynamics.leave());
        slot.chart.getZr().on("click", (event) => this.pick(slot, [event.offsetX, event.offsetY]));
      }
      slot.drawn = option;
      slot.chart.setOption(option, true);
      slot.chart.dispatchAction({ type: "takeGlobalCursor", key: "dataZoomSelect", dataZoomSelectActive: true });
      if (this.zoom) this.applying(() => slot.chart.dispatchAction(this.zoom));
    }
    redraw() { this.slots.forEach((slot) => { if (slot.chart && this.visible(slot)) { slot.chart.resize(); this.draw(slot); } }); }
    drawAll() { this.slots.forEach((slot) => slot.chart || this.draw(slot)); }
    byHand(slot) {
      const view = this.viewOf(slot);
      return Boolean(view.sources && view.sources.some((source) => source.glyph));
    }
    hover(slot, at, event) {
      const view = this.viewOf(slot);
      view.mouse = { chart: slot.chart, at };
      if (event && this.byHand(slot)) ricochetDynamics.hover(slot.chart, view, slot.drawn, this.hidden, at, [event.clientX, event.clientY]);
    }
    pick(slot, at) {
      const view = this.viewOf(slot);
      if (!view.sources || !view.sources.length) return;
      const found = ricochetDynamics.pick(slot.chart, view, slot.drawn, this.hidden, at);
      if (found) ricochetDynamics.show(view, found);
    }
    applying(action) { this.busy = true; try { action(); } finally { this.busy = false; } }
    follow(from, event) {
      if (this.busy || !this.description.linked) return;
      const window = from.chart.getOption().dataZoom[0];
      const batch = event.batch ? event.batch[0] : event;
      const start = batch.startValue === undefined ? window.startValue : batch.startValue;
      const end = batch.endValue === undefined ? window.endValue : batch.endValue;
      if (batch.dataZoomId === "along-y") return;
      this.zoom = { type: "dataZoom", dataZoomId: "along-x", startValue: start, endValue: end };
      this.applying(() => this.slots.forEach((slot) => {
        if (!slot.chart) return;
        if (slot === from && batch.dataZoomId === "along-x") return;
        slot.chart.dispatchAction(this.zoom);
      }));
    }
    reset() {
      this.zoom = null;
      this.applying(() => this.slots.forEach((slot) => {
        if (!slot.chart) return;
        const batch = (slot.chart.getOption().dataZoom || []).map((zoom) => ({ dataZoomId: zoom.id, start: 0, end: 100 }));
        slot.chart.dispatchAction({ type: "dataZoom", batch });
      }));
    }
    show(view) {
      this.view = view;
      all("[data-view]", this.section).forEach((b) => b.setAttribute("aria-pressed", String(Number(b.dataset.view) === view)));
      all("[data-notes]", this.section).forEach((n) => { n.hidden = n.dataset.notes !== "" && Number(n.dataset.notes) !== view; });
      all("[data-only]", this.section).forEach((f) => { f.hidden = Number(f.dataset.only) !== view; });
      this.redraw();
    }
    toggle(button) {
      const name = button.dataset.name, shown = this.hidden.has(name);
      shown ? this.hidden.delete(name) : this.hidden.add(name);
      button.setAttribute("aria-pressed", String(shown));
      this.slots.forEach((slot) => {
        if (!slot.chart || !slot.drawn) return;
        // Points know nothing of the library's legend: they are drawn again.
        if (this.byHand(slot)) { if (this.visible(slot)) this.draw(slot); return; }
        const before = slot.drawn.legend.selected, now = this.selected(slot.drawn.series);
        for (const one of Object.keys(now))
          if (now[one] !== before[one]) slot.chart.dispatchAction({ type: now[one] ? "legendSelect" : "legendUnSelect", name: one });
        slot.drawn.legend.selected = now;
      });
    }
    filter(text) {
      const words = text.toLowerCase().split(/\s+/).filter(Boolean);
      all("figure", this.section).forEach((f) => { f.hidden = !words.every((w) => f.dataset.title.toLowerCase().includes(w)); });
    }
    // The same option once more off screen, with title and legend, in the renderer of the format.
    picture(slot, format) {
      const description = this.description.charts[slot.index], option = this.option(slot);
      if (!option) return null;
      const heading = description.title === "all cases" ? this.description.title : this.description.title + ": " + description.title;
      option.title = { text: heading, left: 12, top: 8, textStyle: { fontSize: 14, fontWeight: "normal", color: "#222" } };
      Object.assign(option.legend, { show: true, type: "plain", left: 12, top: 32, itemWidth: 34, textStyle: { fontSize: 11 } });
      option.series.forEach((s) => { if (s.showSymbol === false) s.symbol = "none"; });   // the legend shows symbols even where the curve has none
      let names = Array.from(new Set(option.series.map((s) => s.name))).filter((name) => name !== "stops");
      const tagged = new Set(option.series.concat(this.viewOf(slot).sources || []).flatMap((s) => s.tags || []));
      if (tagged.size) {   // one entry per meaning instead of one per series
        const entries = this.entries().filter((entry) => tagged.has(entry.name) && !this.hidden.has(entry.name));
        names = entries.map((entry) => entry.name);
        for (const entry of entries) option.series.push({ type: "scatter", name: entry.name, symbol: entry.symbol, symbolRotate: entry.rotate, color: entry.colour, itemStyle: { color: entry.colour }, data: [] });
        option.legend.itemWidth = 12;
      }
      option.legend.data = names;
      const legend = 58 + 20 * Math.ceil(names.reduce((sum, name) => sum + 60 + 6.2 * name.length, 0) / 860);
      const size = { width: 900, height: 480 };
      if (Array.isArray(option.grid)) {
        size.height = Math.max(...option.grid.map((g) => g.top + g.height)) + legend + 48;
        option.grid.forEach((g) => { g.top += legend; });
      } else option.grid.top = legend;
      delete option.toolbox;
      if (this.zoom) Object.assign(option.dataZoom[0], { startValue: this.zoom.startValue, endValue: this.zoom.endValue });
      if (format === "svg") {
        const chart = echarts.init(null, null, Object.assign({ renderer: "svg", ssr: true }, size));
        chart.setOption(option);
        const text = chart.renderToSVGString();
        chart.dispose();
        return new Blob([text], { type: "image/svg+xml" });
      }
      const chart = echarts.init(document.createElement("div"), null, Object.assign({ renderer: "canvas", devicePixelRatio: 3 }, size));
      chart.setOption(option);
      chart.getZr().flush();
      const url = chart.getDataURL({ type: "png", pixelRatio: 3, backgroundColor: "#fff" });
      chart.dispose();
      const binary = atob(url.slice(url.indexOf(",") + 1));
      return new Blob([Uint8Array.from(binary, (c) => c.charCodeAt(0))], { type: "image/png" });
    }
    entries() {
      return all(".legend button", this.section).map((b) => ({ name: b.dataset.name, colour: b.dataset.colour, rotate: b.dataset.symbol === "triangle-down" ? 180 : 0, symbol: { "triangle-down": "triangle", cross: "path://M0,0L10,10M10,0L0,10", "": "rect" }[b.dataset.symbol] || b.dataset.symbol }));
    }
    save(button) {
      const element = button.closest("figure").querySelector(".chart"), slot = this.slots.find((s) => s.element === element);
      const blob = this.picture(slot, button.dataset.export);
      if (!blob) return;
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      const name = this.description.id + "-" + this.description.charts[slot.index].title;
      link.download = name.replace(/[^A-Za-z0-9.-]+/g, "-").replace(/^-|-$/g, "") + "." + button.dataset.export;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }
  }

  function startFigures() {
    const described = read("figure-data");
    if (!described) return;
    blocks = read("curve-data");
    ricochetDynamics.start({ read, block, number, escapeText });
    const later = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        later.unobserve(entry.target);
        const [figure, slot] = owner.get(entry.target);
        if (!slot.chart) figure.draw(slot);
      }
    }, { rootMargin: "400px" });
    const owner = new Map();
    for (const description of described) {
      const figure = new Figure(description, document.querySelector('[data-figure="' + description.id + '"]'));
      figures.push(figure);
      for (const slot of figure.slots) { owner.set(slot.element, [figure, slot]); later.observe(slot.element); }
    }
    let pending = 0;
    window.addEventListener("resize", () => {
      clearTimeout(pending);
      pending = setTimeout(() => figures.forEach((f) => f.slots.forEach((s) => s.chart && s.chart.resize())), 120);
    });
    window.addEventListener("beforeprint", () => figures.forEach((f) => f.drawAll()));
  }

  // ---- the table ----------------------------------------------------------------------------------------------------
  function startTable() {
    const table = document.getElementById("cases");
    if (!table) return;
    const body = table.tBodies[0], rows = Array.from(body.rows), headers = all("thead th", table);
    const words = document.getElementById("filter"), shown = document.getElementById("shown");
    const statuses = all("[data-status]", document.querySelector("#all-cases .controls"));
    function filter() {
      const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
      const off = new Set(statuses.filter((s) => !s.checked).map((s) => s.dataset.status));
      let count = 0;
      for (const row of rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = off.has(row.dataset.status) || !wanted.every((w) => text.includes(w));
        count += row.hidden ? 0 : 1;
      }
      shown.textContent = count === rows.length ? "" : count + " of " + rows.length + " rows shown";
    }
    function sort(header) {
      const index = headers.indexOf(header), up = header.getAttribute("aria-sort") !== "ascending";
      headers.forEach((h) => h.setAttribute("aria-sort", "none"));
      header.setAttribute("aria-sort", up ? "ascending" : "descending");
      const key = (row) => { const cell = row.cells[index], v = cell.dataset.value; return v !== undefined ? Number(v) : cell.textContent.trim(); };
      const absent = (v) => v === "–" || v === "";
      const compare = (a, b) => {
        const x = key(a), y = key(b);
        if (absent(x) || absent(y)) return absent(x) - absent(y);   // rows without a value last, either way
        if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;
        const order = typeof x === "number" ? x - y : x.localeCompare(y);
        return up ? order : -order;
      };
      Array.from(rows).sort(compare).forEach((row) => body.appendChild(row));
    }
    words.addEventListener("input", filter);
    statuses.forEach((s) => s.addEventListener("change", filter));
    headers.forEach((h) => h.querySelector("button").addEventListener("click", () => sort(h)));
    document.getElementById("all-columns").addEventListener("change", (e) => table.classList.toggle("full", e.target.checked));
  }

  // ---- selfcheck: opened as report.html#selfcheck, the page says in an attribute what it really drew -----------------
  function coloured(slot) {
    const layers = all("canvas", slot.element), canvas = layers[0];
    if (!canvas || !canvas.width || !canvas.height) return 0;
    const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
    const context = copy.getContext("2d", { willReadFrequently: true });
    for (const layer of layers) context.drawImage(layer, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4)   // grey is axes and text; curves have a hue
      if (data[i + 3] > 0 && Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 24) ++count;
    return count;
  }
  // A click on a drawn point opens that very orbit.
  function checkPanel(figure, slot, view, index) {
    const source = view.sources[index], middle = source.orbits.length >> 1;
    const at = slot.chart.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, [source.values[2 * middle], source.values[2 * middle + 1]]);
    figure.pick(slot, at);
    const panel = ricochetDynamics.panel(), shown = ricochetDynamics.shown();
    const out = { opened: Boolean(panel), orbit: shown && shown.id === source.reference.case && ricochetDynamics.cases()[shown.id].columns.parameter[shown.orbit] === source.values[2 * middle],
      canvases: panel ? all("canvas", panel).length : 0, command: panel ? panel.querySelector("pre").textContent : "", facts: panel ? all("dt", panel).length : 0 };
    if (location.hash !== "#selfcheck-panel") ricochetDynamics.close();
    out.closed = !ricochetDynamics.panel();
    return out;
  }
  // A click in an image of basins opens the cell that lies there.
  function checkCell(figure, slot, view) {
    const about = view.option.cells, column = about.xs.length >> 1, row = about.ys.length >> 2;
    figure.pick(slot, slot.chart.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, [about.xs[column], about.ys[row]]));
    const panel = ricochetDynamics.panel(), shown = ricochetDynamics.shown();
    const out = { opened: Boolean(panel), cell: shown ? shown.column === column && shown.row === row : false, command: panel ? panel.querySelector("pre").textContent : "", lines: panel ? all("p", panel).length : 0,
      wanted: about.xs[column] + "," + about.ys[row] };
    if (location.hash !== "#selfcheck-panel") ricochetDynamics.close();
    return out;
  }
  function selfcheck() {
    const result = { figures: [], table: null, errors };
    for (const figure of figures) {
      figure.drawAll();
      const views = Math.max(1, all("[data-view]", figure.section).length), drawn = [];
      for (let view = 0; view < views; ++view) {
        if (view > 0) { figure.show(view); figure.drawAll(); }
        drawn.push(figure.slots.filter((slot) => figure.visible(slot)).map((slot) => { if (slot.chart) slot.chart.getZr().flush(); return coloured(slot); }));
      }
      if (views > 1) figure.show(0);
      const report = { id: figure.description.id, charts: figure.slots.length, drawn };
      const seen = figure.slots.filter((slot) => figure.visible(slot)), first = seen[0], last = seen[seen.length - 1];
      const legend = figure.section.querySelector(".legend button");
      if (legend) {
        legend.click();
        const name = legend.dataset.name, named = (one) => one.name === name || (one.tags || []).includes(name);
        report.hidden = figure.slots.every((s) => !s.chart || !figure.visible(s) || s.drawn.series.filter(named).every((one) => s.chart.getOption().legend[0].selected[one.name] === false));
        legend.click();
      }
      if (first && figure.byHand(first)) {   // without any entry of the legend nothing coloured is left, and with all of them everything is back
        const full = coloured(first), hidden = Array.from(figure.hidden), redraw = () => { figure.draw(first); first.chart.getZr().flush(); };
        all(".legend button", figure.section).forEach((b) => figure.hidden.add(b.dataset.name));
        redraw();
        report.hidden = report.hidden && coloured(first) < full / 10;
        figure.hidden.clear();
        hidden.forEach((name) => figure.hidden.add(name));
        redraw();
        report.hidden = report.hidden && coloured(first) === full;
      }
      if (figure.description.linked && first && last) {
        const range = first.chart.getOption().xAxis[0], low = range.min || 0, wide = range.max - low;
        const from = low + 0.25 * wide, to = low + 0.5 * wide;
        first.chart.dispatchAction({ type: "dataZoom", dataZoomId: "along-x", startValue: from, endValue: to });
        const zoom = last.chart.getOption().dataZoom[0], axes = last.chart.getOption().xAxis;
        report.linked = Math.abs(zoom.startValue - from) < 1e-6 * wide && Math.abs(zoom.endValue - to) < 1e-6 * wide;
        report.aligned = axes.every((axis, k) => Math.abs(last.chart.convertToPixel({ xAxisIndex: k }, from) - last.chart.convertToPixel({ xAxisIndex: 0 }, from)) < 0.5);
        figure.reset();
        report.reset = last.chart.getOption().dataZoom[0].start === 0 && last.chart.getOption().dataZoom[0].end === 100;
      }
      if (first) {
        report.svg = figure.picture(first, "svg").size;
        report.png = figure.picture(first, "png").size;
        const option = figure.option(first);
        const sample = option.series.find((s) => s.data.length);
        const value = sample && (Array.isArray(sample.data[0]) ? sample.data[0] : sample.data[0].value || [sample.data[0], sample.data[1]]);
        report.tooltip = sample ? option.tooltip.formatter([{ value, seriesName: sample.name, marker: "", data: {} }]) : "";
      }
      const view = first && figure.viewOf(first), points = view && view.sources && view.sources.findIndex((s) => s.values && s.reference.sweep === "points" && s.values.length);
      if (points !== undefined && points !== null && points >= 0) report.panel = checkPanel(figure, first, view, points);
      if (view && view.option.cells) report.cell = checkCell(figure, first, view);
      result.figures.push(report);
    }
    const table = document.getElementById("cases");
    if (table) {
      const body = table.tBodies[0], order = () => Array.from(body.rows, (r) => r.cells[0].textContent).join();
      const words = document.getElementById("filter");
      let sorts = body.rows.length < 2;
      for (const header of all("thead button", table)) {
        header.click();
        const up = order();
        header.click();
        sorts = sorts || up !== order();
      }
      words.value = "no row says this";
      words.dispatchEvent(new Event("input"));
      const filtered = Array.from(body.rows).filter((r) => !r.hidden).length;
      words.value = "";
      words.dispatchEvent(new Event("input"));
      result.table = { rows: body.rows.length, sorts, filtered, restored: Array.from(body.rows).filter((r) => !r.hidden).length };
    }
    document.documentElement.setAttribute("data-selfcheck", JSON.stringify(result));
  }

  document.addEventListener("DOMContentLoaded", () => {
    startTable();
    startFigures();
    if (location.hash.startsWith("#selfcheck")) {
      try { selfcheck(); } catch (e) { errors.push(String(e && e.stack || e)); document.documentElement.setAttribute("data-selfcheck", JSON.stringify({ errors })); }
    }
  });
})();
