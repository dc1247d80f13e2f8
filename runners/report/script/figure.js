// A figure at work. It draws its charts when they come into sight, links their zoom, and filters by the legend.
//
// A figure is {id, title, caption, views, charts, legend, overTime, linked}. `views` are names. Each chart has as many
// views (plot.js), or the one that `only` names; a view with `nothing` is not drawn. `legend` has {name, colour, dash,
// symbol, hollow, heading, only}. The first of a page with `answers` may stand beside its answer, in the view
// `atFirst`.
{
  const all = (selector, from) => Array.from(from.querySelectorAll(selector));

  // Whether a chart, or an entry of a legend, belongs to a view: `only` names one or lists several.
  ricochet.inView = ({only}, view) => only === undefined || [].concat(only).includes(view);
  // The view with a vertical axis that fits its own marks.
  function ownScale(view) {
    const [axis, ...others] = view.yAxes, {reader, countOf} = ricochet.plot, range = new ricochet.Interval();
    for (const mark of view.marks) {
      if (mark.yAxis || mark.mark === "rule" || Array.isArray(mark.y)) continue;
      const y = reader(mark, "y");
      for (let i = 0; i < countOf(mark); ++i)
        if (axis.type !== "log" || y(i) > 0) range.include(y(i));
    }
    if (range.empty || axis.type === "category") return view;
    const {low, high} = axis.type === "log" ? ricochet.wholeDecades(range) : ricochet.roundOutwards(range, 1e-12);
    return {...view, yAxes: [{...axis, min: low, max: high}, ...others]};
  }

  class Figure {
    constructor(description, section) {
      Object.assign(this, {description, section, view: 0, own: false, zoom: null, hidden: new Set(), slots: []});
      for (const element of all(".chart", section))
        this.slots.push({element, chart: null, index: Number(element.dataset.chart)});
      all("[data-view]", section).forEach((b) => b.addEventListener("click", () => {
        this.show(Number(b.dataset.view));
        ricochet.address.ofFigure(this);
      }));
      all("[data-own]", section).forEach((b) => b.addEventListener("change", () => {
        this.own = b.checked;
        this.redraw();
        ricochet.address.ofFigure(this);
      }));
      all(".legend button", section).forEach((b) => b.addEventListener("click", () => this.toggle(b)));
      all("[data-export]", section).forEach((b) => b.addEventListener("click", () => this.save(b)));
      all("[data-facets]", section).forEach((b) => b.addEventListener("input", () => this.filter(b.value)));
      this.slots.forEach((slot) => ricochet.chartData.attach(this, slot));
    }
    chartOf(slot) { return this.description.charts[slot.index]; }
    // The view that a slot shows; null where it has nothing to show.
    viewOf(slot) {
      const {views} = this.chartOf(slot), view = views[Math.min(this.view, views.length - 1)];
      return view.nothing ? null : this.own ? ownScale(view) : view;
    }
    visible(slot) { return ricochet.inView(this.chartOf(slot), this.view); }
    get zoomsAsOne() { return this.description.linked || this.slots.length === 1; }
    // What of the axes is shown, for a drawing of it elsewhere.
    windows(slot) { return slot.chart ? slot.chart.windows : {x: this.zoom, y: null}; }
    draw(slot) {
      if (!this.visible(slot)) return;
      if (!slot.chart)
        slot.chart =
            new ricochet.Chart(slot.element, {zoomed: (chart) => this.follow(chart), reset: () => this.reset()});
      slot.chart.windows = {x: this.zoomsAsOne ? this.zoom : null, y: null};
      slot.chart.show(this.viewOf(slot), this.hidden);
      ricochet.chartData.describe(this, slot);
    }
    redraw() { this.slots.forEach((slot) => slot.chart && this.draw(slot)); }
    drawAll() { this.slots.forEach((slot) => slot.chart || this.draw(slot)); }
    follow({windows}) {
      if (!this.zoomsAsOne) return;
      this.zoom = windows.x;
      ricochet.address.ofFigure(this);
      for (const {chart} of this.slots)
        if (chart && chart.windows.x !== windows.x) chart.zoom({x: windows.x}, true);
    }
    reset() {
      this.zoom = null;
      ricochet.address.ofFigure(this);
      this.slots.forEach(({chart}) => chart && chart.zoom({x: null, y: null}, true));
    }
    show(view) {
      this.view = view;
      all("[data-view]", this.section)
          .forEach((b) => b.setAttribute("aria-pressed", String(Number(b.dataset.view) === view)));
      all("[data-notes]", this.section).forEach((n) => {
        n.hidden = n.dataset.notes !== "" && Number(n.dataset.notes) !== view;
      });
      all("[data-only]", this.section).forEach((f) => {
        f.hidden = !f.dataset.only.split(" ").includes(String(view));
      });
      this.redraw();
    }
    // Hides what the legend names, or shows it again.
    hide(name, hidden = true) {
      hidden ? this.hidden.add(name) : this.hidden.delete(name);
      for (const button of all(".legend button", this.section))
        if (button.dataset.name === name) button.setAttribute("aria-pressed", String(!hidden));
    }
    toggle({dataset: {name}}) {
      this.hide(name, !this.hidden.has(name));
      for (const {chart} of this.slots)
        if (chart) chart.draw();
      ricochet.address.ofFigure(this);
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
  ricochet.makeFigures = (data) => makers.flatMap(([, make]) => make(data));
  ricochet.Figure = Figure;
}
