// The bifurcation diagram: tip displacement on the section against the parameter, coloured by the regime of the orbit.
// Panels under it share its horizontal axis: exponents, regimes and verdicts. Views: a chart per case, all cases in one
// chart, a chart per case and kind of start.
{
  const {Interval, diagramPanels, methodColours} = ricochet;
  const mostLanes = 24, mostStartCharts = 24;  // rows of a band of regimes; charts of the view by start
  const tip = ["tip displacement", "m"];

  class Diagram {
    constructor(data) {
      const orbits = new ricochet.Orbits(data);
      Object.assign(this, {
        data,
        view: data.view,
        orbits,
        cases: orbits.cases,
        verdicts: data.rows("intervals").filter((row) => row.from !== null && row.to !== null)
      });
      const all = this.cases.map((one) => orbits.of(one.id)),
            present = (list) => ricochet.distinct(list).sort((a, b) => a - b);
      this.parameters = all.reduce((sum, one) => sum.include(...one.columns.parameter), new Interval());
      this.kinds = present(all.flatMap((one) => one.kind));
      this.groups = present(all.flatMap((one) => one.group));
      this.changes = this.cases.some((one) => data.ownRows("bifurcations", one.id).some((row) => row.value !== null));
      this.twins = all.some((one) => one.columns.exponent_twin);
      this.mostExponents = 0;
      while (all.some((one) => one.columns["exponent_" + (this.mostExponents + 1)])) ++this.mostExponents;
      this.frameExponents(this.cases.flatMap(
          (one) => orbits.chosen(one.id)
                       .map((o) => orbits.number(one.id, "exponent_1", o))
                       .filter((value) => value !== null)));
    }
    // Orbits that contract almost at once have exponents far below all others, which must not flatten these.
    frameExponents(values) {
      this.exponents = null;
      this.below = 0;
      if (!values.length) return;
      values.sort((a, b) => a - b);
      const median = values[values.length >> 1], high = Math.max(values[values.length - 1], 0),
            least = Math.min(median, 0) - 4 * Math.max(high, Math.abs(median), 1e-12);
      this.exponents =
          ricochet.roundOutwards(new Interval().include(0, ...values.filter((value) => value >= least)), 1e-12);
      this.below = values.filter((value) => value < this.exponents.low).length;
    }
    title(one) { return (this.view.label(one) || "all cases") + (one.partial ? " (partial)" : ""); }
    colourOf(one) { return methodColours[this.cases.indexOf(one) % methodColours.length]; }
    methodName(one) { return this.view.label(one) || "the one method"; }
    unfinished(id, o) {
      const status = this.orbits.cell(id, "status", o);
      return Boolean(status) && status !== "done";
    }

    figure() {
      const {cases, kinds} = this, several = cases.length > 1, frames = this.frames();
      const out = {
        id: "diagram",
        answers: true,
        title: "Bifurcation diagram",
        caption: this.caption(),
        views: [several ? "side by side" : "diagram"],
        linked: true
      };
      out.charts = cases.map((one, c) => this.chart({title: this.title(one), cases: [one]}, frames[c], 0));
      if (several) {
        const all = frames.reduce((sum, frame) => sum.join(frame.range), new Interval());
        out.atFirst = out.views.push("overlaid") - 1;  // beside the answer
        out.charts.push(
            this.chart({title: "all methods", cases, byMethod: true}, {range: all, own: false}, out.atFirst));
      }
      if (kinds.length > 1 && kinds.length * cases.length <= mostStartCharts) {
        const view = out.views.push("by start") - 1;
        cases.forEach(
            (one, c) => kinds.forEach(
                (kind) => out.charts.push(this.chart(
                    {title: (several ? this.title(one) + " · " : "") + this.orbits.kinds[kind][0], cases: [one], kind},
                    frames[c], view))));
      }
      if (cases.length > methodColours.length)
        out.caption +=
            " Overlaid, colours repeat after " + methodColours.length + " methods: the legend shows any of them alone.";
      out.legend = this.legend(out);
      return out;
    }
    caption() {
      const {text, count} = ricochet.format, study = this.data.study.resolved, section = study.section || "",
                   methods = this.data.rows("exponent_methods");
      let when = {impact: "at each impact", extremum: "at each extremum of the tip"}[section] ||
          "once in each forcing period";
      if (section === "strobe" && study.phase) when += " (phase " + text(study.phase) + " rad)";
      let out = "Tip displacement " + when + ", against " + this.orbits.parameter[0] +
          "; absolute, support motion included. Under it: ";
      if (this.exponents) {
        const by = methods
                       .map(
                           (row) => (row.method || "method not said") +
                               (methods.length > 1 ? " (" + row.orbits + " of " + row.all + ")" : ""))
                       .join(", ");
        out += "the largest Lyapunov exponent (1/s) with its interval, by " + by;
        const marginal = methods.length ? methods[0].marginal : 0;
        if (marginal > 0)
          out += "; at " + count(marginal, "value and start", "values and starts") +
              " an exponent of a marginal root, the scheme's own, is set apart";
        out += "; then the regime of each start.";
      } else {
        out += "the regime of each start.";
      }
      if (this.verdicts.length) out += " Last: what all methods together say of each interval.";
      if (this.changes) out += " ▼: where a change of the regime is located.";
      return [out + " Symbols tell starts apart; dense clouds are dots. Click a point for its orbit."]
          .concat(this.data.page.orbits.said)
          .filter(Boolean)
          .join(" ");
    }
    frames() {
      const extents = this.cases.map((one) => {
        const extent = this.orbits.of(one.id).extent;
        return extent ? new Interval(...extent) : new Interval();
      });
      return ricochet.sharedFrames(extents).map(
          (frame) =>
              ({own: frame.own, range: frame.range.empty ? frame.range : ricochet.roundOutwards(frame.range, 1e-9)}));
    }
    // The rows of a panel's band of regimes.
    lanes(panel) {
      return panel.cases.flatMap(
          (one) => this.orbits.starts(one.id)
                       .filter((start) => panel.kind === undefined || this.orbits.kindOfStart(start) === panel.kind)
                       .map((start) => ({
                              id: one.id,
                              start,
                              name: panel.cases.length > 1 ? this.methodName(one) + ", " + start : start
                            })));
    }

    chart(panel, frame, only) {
      const lanes = this.lanes(panel), view = this.draw(panel, frame, lanes), height = view.height,
            {count, text} = ricochet.format;
      if (this.exponents && this.below > 0)
        view.notes.push(
            "Over all cases, " + count(this.below, "exponent lies", "exponents lie") + " below " +
            text(this.exponents.low) + " 1/s, outside the panel.");
      if (lanes.length > mostLanes)
        view.notes.push(
            lanes.length +
            " starts and methods are too many for a band of regimes here: it stands in the views with fewer.");
      if (frame.own) view.notes.push("Own vertical scale: its points reach far beyond those of the other charts.");
      return {
        title: panel.title,
        cases: panel.cases,
        only,
        bands: panel.byMethod && lanes.length <= mostLanes,
        height,
        views: [view],
        notes: panel.cases.flatMap((one) => this.outcomes(one, panel))
      };
    }
    // "⊘ refused (3 orbits), between 0.11 and 0.12: the support passes the stop".
    outcomes(one, panel) {
      const {orbits} = this, {text, count, mark} = ricochet.format,
            who = panel.cases.length > 1 ? this.methodName(one) + ": " : "";
      const unfinished = orbits.chosen(one.id, undefined, panel.kind).filter((o) => this.unfinished(one.id, o)),
            cell = (name, o) => orbits.cell(one.id, name, o);
      const out =
          one.partial ? [who + "partial: this case is still being worked on; what it has so far is drawn."] : [];
      for (const found of ricochet.groupBy(unfinished, (o) => [cell("status", o), cell("reason", o)]).values()) {
        const status = cell("status", found[0]), reason = cell("reason", found[0]),
              range = new Interval().include(...found.map((o) => cell("parameter", o)));
        const at = range.low === range.high ? "at " + text(range.low, 7) :
                                              "between " + text(range.low, 7) + " and " + text(range.high, 7);
        out.push(
            mark(status) + " " + who + status + " (" + count(found.length, "orbit", "orbits") + "), " + at +
            (reason ? ": " + reason : ""));
      }
      return out;
    }

    draw(panel, frame, lanes) {
      const {orbits} = this, withBand = lanes.length <= mostLanes, frames = [],
            unfinished = diagramPanels.unfinished(this, panel).filter(({rows}) => rows.length),
            yAxes = [ricochet.valueAxis(tip, frame.range), ricochet.gutterAxis()];
      let top = 10;
      const place = (height, gap, pad = 0) => {
        const index = frames.push({left: 74, right: 14, top, height, pad}) - 1;
        top += height + gap;
        return index;
      };
      place(panel.byMethod || this.cases.length === 1 ? 380 : 270, 16);
      const growth = this.exponents ? place(110, 8) : -1;
      const strip = unfinished.length ? place(18, 6, 10) : -1;
      const band = withBand ? place(Math.max(10, lanes.length * (lanes.length > 6 ? 8 : 14)), 6) : -1;
      const verdict = this.verdicts.length ? place(14, 6) : -1;
      const out = Object.assign(
          ricochet.view(orbits.parameter, tip, frames.map((_, f) => this.xAxis(f + 1 === frames.length)), yAxes),
          {frames});
      const axis = (more) => out.yAxes.push(more) - 1,
            names = (rows, frame, bare) => axis({type: "category", frame, data: rows, bare, plain: true});
      diagramPanels.changeMarks(this, out, panel);
      if (strip >= 0) {
        const yAxis = names(["no value"], strip, false);
        out.marks.push(ricochet.strip("no value", yAxis));
        for (const {rows, tags} of unfinished)
          ricochet.drawMarks(out, {name: "not finished", colour: diagramPanels.dark}, rows, {tags, yAxis});
      }
      const growthAxis =
          growth < 0 ? -1 : axis({...ricochet.valueAxis(["exponent", "1/s"], this.exponents), frame: growth});
      if (growth >= 0) out.marks.push(ricochet.rule("zero", {y: 0}, "", {colour: "#555555", yAxis: growthAxis, z: 1}));
      if (band >= 0)
        diagramPanels.regimes(
            this, out, lanes, names(lanes.map((lane) => lane.name), band, panel.cases.length > 1 || lanes.length > 6));
      if (verdict >= 0) diagramPanels.verdictBand(this, out, names(["verdict"], verdict, false));
      out.open = ({mark, row, i}) => {
        const id = row.id || mark.id, orbit = mark.orbits ? mark.orbits[i] : row.orbit;
        if (id !== undefined) ricochet.showOrbit(orbits, id, orbit);
      };
      out.words = (found) => this.words(out, found);
      out.height = top - 6 + 48;
      // Points are unpacked when the chart is drawn.
      const {marks} = out;
      let all = null;
      Object.defineProperty(out, "marks", {
        enumerable: true,
        get: () => all ||
            (all =
                 [
                   ...diagramPanels.points(this, panel),
                   ...(growth < 0 ? [] : diagramPanels.exponents(this, panel, growthAxis)), ...marks
                 ])
      });
      return out;
    }
    xAxis(last) {
      let range = this.parameters;
      if (!(range.high > range.low)) {
        const slack = range.low === 0 ? 1 : 0.01 * Math.abs(range.low);
        range = new Interval(range.low - slack, range.high + slack);
      }
      const logarithmic = ricochet.logarithmicSweep(this.parameters),
            out = ricochet.axisOf(logarithmic, this.orbits.parameter, range), slack = 0.012 * (range.high - range.low);
      if (!logarithmic) Object.assign(out, {min: range.low - slack, max: range.high + slack});
      return {...out, bare: !last};
    }
    words(view, {mark, row, i, x, y}) {
      const {escape, shown} = ricochet.format, id = row.id || mark.id;
      if (row.text)
        return "<div>" + escape(view.x[0]) + " = " + shown(x, 8) + '</div><div class="tip-row">' + escape(mark.name) +
            '</div><div class="tip-text">' + escape(row.text) + "</div>";
      return id === undefined ?
          "" :
          this.orbits.words(id, mark.orbits ? mark.orbits[i] : row.orbit, tip, mark.what === "points" ? y : undefined) +
              '<div class="fine">click: its orbit</div>';
    }

    // Overlaid, points have the colours of methods, and only a band those of regimes.
    legend({views, atFirst: overlaid, charts}) {
      const {groups, kinds} = this.orbits, used = new Set(this.verdicts.map((row) => row.verdict));
      const {swatch} = ricochet, mark = (name, colour, symbol) => out.push(swatch(name, colour, symbol, "Marks"));
      const regimes = (heading, only) =>
                this.groups.map((group) => ({...swatch(...groups[group], "rect", heading), only})),
            out = regimes("Regime", [...views.keys()].filter((view) => view !== overlaid));
      if (charts.some(({bands}) => bands)) out.push(...regimes("Regime (band)", [overlaid]));
      if (this.kinds.length > 1)
        out.push(...this.kinds.map((kind) => swatch(kinds[kind][0], "#555555", kinds[kind][1], "Start")));
      if (this.cases.length > 1)
        out.push(...this.cases.map(
            (one) => ({...swatch(this.methodName(one), this.colourOf(one), "roundRect", "Method"), only: [overlaid]})));
      for (const [word, colour] of diagramPanels.verdicts)
        if (used.has(word)) out.push(swatch(word, colour, "rect", "Verdict"));
      if (this.changes) mark("located change", diagramPanels.dark, "triangle-down");
      if (this.exponents && this.mostExponents > 1) mark("further exponents", ricochet.faint, "circle");
      if (this.exponents && this.twins) mark("twin check", diagramPanels.dark, "cross");
      return out;
    }
  }

  ricochet.figure("diagram", (data) => {
    if (!data.page.orbits) return [];
    const diagram = new Diagram(data);
    return diagram.cases.length && !diagram.parameters.empty ? [diagram.figure()] : [];
  });
}
