// A figure at work. It draws its charts when they come into sight, links their zoom, and filters by the legend. It
// hands a click to what the chart knows of it.
//
// A figure is {id, title, caption, views, charts, legend, overTime, linked}. `views` are names. Each chart has as many
// views {option, x, y, notes}, or the one that `only` names. `legend` has {name, colour, dash, symbol, heading}.
// `atFirst`, where given, is the view that stands beside the answer. In an option, a data set's `source` may be a
// function: it is asked when the chart is drawn. A view may add `sources` (marks drawn by hand), `pick` (what lies at a
// place), `open` (shows it) and `hover` (says it).
{
  const all = (selector, from) => Array.from(from.querySelectorAll(selector));

  // Each chart gets an option of its own, down to the settings of its parts; rows are shared.
  function fresh(option) {
    const own = (part) => (Array.isArray(part) ? part.map(own) : part && typeof part === "object" ? {...part} : part);
    const out = Object.fromEntries(Object.entries(option).map(([name, part]) => [name, own(part)]));
    for (const one of out.dataset)
      if (typeof one.source === "function") one.source = one.source();
    return out;
  }

  class Figure {
    constructor(description, section) {
      Object.assign(this, {description, section, view: 0, own: false, zoom: null, hidden: new Set(), slots: []});
      for (const element of all(".chart", section))
        this.slots.push({element, chart: null, index: Number(element.dataset.chart)});
      all("[data-view]", section).forEach((b) => b.addEventListener("click", () => this.show(Number(b.dataset.view))));
      all("[data-own]", section).forEach((b) => b.addEventListener("change", () => {
        this.own = b.checked;
        this.redraw();
      }));
      all(".legend button", section).forEach((b) => b.addEventListener("click", () => this.toggle(b)));
      all("[data-export]", section).forEach((b) => b.addEventListener("click", () => this.save(b)));
      all("[data-facets]", section).forEach((b) => b.addEventListener("input", () => this.filter(b.value)));
      this.slots.forEach((slot) => ricochet.chartData.attach(this, slot));
    }
    chartOf(slot) { return this.description.charts[slot.index]; }
    viewOf(slot) {
      const {views} = this.chartOf(slot);
      return views[Math.min(this.view, views.length - 1)];
    }
    visible(slot) {
      const {only} = this.chartOf(slot);
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
    // `colour` carries colours over to where they are drawn; as they are said, they are for white paper.
    option(slot, colour = (said) => said) {
      const view = this.viewOf(slot);
      if (!view.option) return null;
      const option = fresh(view.option);
      if (view.sources)
        option.series.push(...ricochet.handDrawn.series(
            view.sources().map((source) => ({...source, colour: colour(source.colour)})), option, this.hidden));
      if (this.own)
        for (const axis of [].concat(option.yAxis).slice(0, 1)) {
          delete axis.min;
          delete axis.max;
        }
      option.legend.selected = this.selected(option.series);
      // The brush that a drag starts belongs to the toolbox; its icons stay out of sight.
      option.toolbox = {
        itemSize: 0,
        showTitle: false,
        feature: {
          dataZoom: {
            yAxisIndex: false,
            filterMode: this.description.overTime ? "filter" : "none",
            icon: {zoom: "path://", back: "path://"}
          }
        }
      };
      return option;
    }
    draw(slot) {
      if (!this.visible(slot)) return;
      const option = this.option(slot, ricochet.theme.colour);
      if (!option) {
        if (slot.chart) slot.chart.clear();
        return;
      }
      if (!slot.chart) {
        slot.chart = ricochet.openChart(slot.element, () => {
          if (this.visible(slot)) this.draw(slot);
        });
        slot.chart.on("datazoom", (event) => this.follow(slot, event));
        slot.chart.getZr().on("dblclick", () => this.reset());
        slot.chart.getZr().on("mousemove", (event) => this.hover(slot, [event.offsetX, event.offsetY], event.event));
        slot.chart.getZr().on("globalout", () => {
          if (this.viewOf(slot).hover) ricochet.sidePanel.hover("");
        });
        slot.chart.getZr().on("click", (event) => this.pick(slot, [event.offsetX, event.offsetY]));
      }
      slot.drawn = option;
      slot.chart.setOption(option, true);
      slot.chart.dispatchAction({type: "takeGlobalCursor", key: "dataZoomSelect", dataZoomSelectActive: true});
      if (this.zoom) this.applying(() => slot.chart.dispatchAction(this.zoom));
      ricochet.chartData.describe(this, slot);
    }
    redraw() {
      this.slots.forEach((slot) => {
        if (slot.chart && this.visible(slot)) {
          slot.chart.resize();
          this.draw(slot);
        }
      });
    }
    drawAll() { this.slots.forEach((slot) => slot.chart || this.draw(slot)); }
    hover(slot, at, event) {
      const view = this.viewOf(slot);
      view.mouse = {chart: slot.chart, at};
      if (!event || !view.hover) return;
      const found = view.pick(slot.chart, slot.drawn, this.hidden, at, true);
      ricochet.sidePanel.hover(found ? view.hover(found) : "", [event.clientX, event.clientY]);
    }
    pick(slot, at) {
      const view = this.viewOf(slot), found = view.pick && view.pick(slot.chart, slot.drawn, this.hidden, at, false);
      if (found) view.open(found);
      else ricochet.pickCase(slot, at);
    }
    applying(action) {
      this.busy = true;
      try {
        action();
      } finally { this.busy = false; }
    }
    follow(from, event) {
      if (this.busy || !this.description.linked) return;
      const window = from.chart.getOption().dataZoom[0], batch = event.batch ? event.batch[0] : event;
      const start = batch.startValue === undefined ? window.startValue : batch.startValue,
            end = batch.endValue === undefined ? window.endValue : batch.endValue;
      if (batch.dataZoomId === "along-y") return;
      this.zoom = {type: "dataZoom", dataZoomId: "along-x", startValue: start, endValue: end};
      this.applying(() => this.slots.forEach((slot) => {
        if (!slot.chart || (slot === from && batch.dataZoomId === "along-x")) return;
        slot.chart.dispatchAction(this.zoom);
      }));
    }
    reset() {
      this.zoom = null;
      this.applying(() => this.slots.forEach((slot) => {
        if (!slot.chart) return;
        const batch =
            (slot.chart.getOption().dataZoom || []).map((zoom) => ({dataZoomId: zoom.id, start: 0, end: 100}));
        slot.chart.dispatchAction({type: "dataZoom", batch});
      }));
    }
    show(view) {
      this.view = view;
      all("[data-view]", this.section)
          .forEach((b) => b.setAttribute("aria-pressed", String(Number(b.dataset.view) === view)));
      all("[data-notes]", this.section).forEach((n) => {
        n.hidden = n.dataset.notes !== "" && Number(n.dataset.notes) !== view;
      });
      all("[data-only]", this.section).forEach((f) => {
        f.hidden = Number(f.dataset.only) !== view;
      });
      this.redraw();
    }
    toggle(button) {
      const {name} = button.dataset, shown = this.hidden.has(name);
      shown ? this.hidden.delete(name) : this.hidden.add(name);
      button.setAttribute("aria-pressed", String(shown));
      this.slots.forEach((slot) => {
        if (!slot.chart || !slot.drawn) return;
        // Marks drawn by hand know nothing of the library's legend: they are drawn again.
        if (this.viewOf(slot).sources) {
          if (this.visible(slot)) this.draw(slot);
          return;
        }
        const before = slot.drawn.legend.selected, now = this.selected(slot.drawn.series);
        for (const one of Object.keys(now))
          if (now[one] !== before[one])
            slot.chart.dispatchAction({type: now[one] ? "legendSelect" : "legendUnSelect", name: one});
        slot.drawn.legend.selected = now;
      });
    }
    filter(text) {
      const words = text.toLowerCase().split(/\s+/).filter(Boolean);
      all("figure", this.section).forEach((f) => {
        f.hidden = !words.every((w) => f.dataset.title.toLowerCase().includes(w));
      });
    }
    save(button) {
      const element = button.closest("figure").querySelector(".chart"),
            slot = this.slots.find((s) => s.element === element),
            blob = ricochet.picture(this, slot, button.dataset.export);
      if (!blob) return;
      ricochet.download(this.description.id + "-" + this.chartOf(slot).title, button.dataset.export, blob);
    }
  }

  const makers = [];
  // Registers a figure: `make` takes the page's data and returns its figures, none where the results have nothing of
  // the kind.
  ricochet.figure = (name, make) => makers.push([name, make]);
  // Names figures that show a kind's answer, the best first: the first that a study has stands beside its answer.
  const answers = [];
  ricochet.answeredBy = (...ids) => {
    answers.push(...ids.filter((id) => !answers.includes(id)));
  };
  // Before all others: for the figure of what the answer says.
  ricochet.answeredFirst = (id) => {
    answers.unshift(id);
  };
  ricochet.answerAmong = (figures) => answers.map((id) => figures.find((figure) => figure.id === id)).find(Boolean);
  ricochet.makeFigures = (data) => makers.flatMap(([, make]) => make(data));
  ricochet.Figure = Figure;
}
