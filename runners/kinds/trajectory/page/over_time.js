// A column of the sampled curves against time: a chart per method, a curve per step (or mass), the zoom of all charts linked.
{
  const { numberOf, measureOf, Interval } = ricochet;
  const drawnWhole = 4000;   // points of a curve up to which every one is drawn: a chart is about 500 pixels wide

  // The scales of a column: as it is, as a ratio to the start, as the modulus of its change. Subtracting first keeps an unchanged value exactly 0.
  const scaled = {
    value: () => (value) => value,
    ratio: (start) => (value) => (1 / start) * value,
    change: (start) => (value) => Math.abs((1 / start) * (value - start)),
  };
  const scaleNames = { ratio: ["E / E(0)", "1"], change: ["|E / E(0) − 1|", "1"] };

  class OverTime {
    constructor(data, subject) {
      const view = data.view;
      Object.assign(this, { data, view, subject });
      // Told apart within one chart: the step; else the mass; else the first axis that varies.
      const masses = view.varying.filter((column) => ricochet.roleOf(column) === "mass");
      this.columns = view.varies("step") ? ["step"] : masses.length ? masses : view.varying.slice(0, 1);
      this.byMass = this.columns.length > 0 && ricochet.roleOf(this.columns[0]) === "mass";
      // Finest step first; other values in order of appearance.
      const seen = new Map();
      for (const one of view.all) if (!seen.has(view.label(one, this.columns))) seen.set(view.label(one, this.columns), this.columns[0] === "step" ? numberOf(one, "step") || 0 : seen.size);
      this.ranks = Array.from(seen.keys()).sort((a, b) => seen.get(a) - seen.get(b));
      this.facets = view.group(view.all, view.varyingWithout(this.columns)).map((facet) => ({ title: facet.label || "all cases", cases: facet.cases, curves: this.curvesOf(facet) }));
    }
    rank(one) { return this.ranks.indexOf(this.view.label(one, this.columns)); }
    name(one) { return this.view.label(one, this.columns) || this.view.massLabel(one) || "curve"; }
    shade(rank) { return this.ranks.length < 2 ? 0 : 0.5 * rank / (this.ranks.length - 1); }
    curvesOf(facet) {
      const out = [];
      for (const one of facet.cases) {
        const curve = this.data.curve(one, this.subject.column);
        if (!curve) continue;
        const rank = this.rank(one), measured = measureOf(one, "energy_start"), start = measured === null ? curve.y[0] : measured;
        out.push({ one, t: curve.x, values: curve.y, rank, name: this.name(one), start: start > 0 ? start : null, colour: this.byMass ? this.view.colour(one) : ricochet.lighten(this.view.colour(one), this.shade(rank)) });
      }
      // The finest last, on top of the others.
      return out.sort((a, b) => b.rank - a.rank);
    }
    legend() {
      const out = new Map();
      for (const one of this.view.all) {
        const name = this.name(one), rank = this.rank(one), base = this.view.masses.length > 1 ? "#555555" : this.view.colour(one);
        if (!out.has(name)) out.set(name, { name, colour: this.byMass ? this.view.colour(one) : ricochet.lighten(base, this.shade(rank)), dash: this.byMass ? "" : ricochet.svgDash(rank), symbol: "" });
      }
      return Array.from(out.values());
    }

    figure() {
      const { subject } = this, curves = this.facets.flatMap((facet) => facet.curves);
      if (!curves.length) return null;
      const scales = subject.scales.filter((scale) => scale === "value" || curves.some((curve) => curve.start !== null));
      const charts = this.facets.map((facet) => ({ title: facet.title, views: [], notes: this.view.outcomeNotes(facet.cases, this.columns) }));
      for (const scale of scales) {
        const ranges = this.facets.map((facet) => this.range(facet, scale)), all = ranges.reduce((sum, range) => sum.join(range), new Interval());
        const frames = scale === "change" ? ranges.map(() => ({ range: all, own: false })) : ricochet.sharedFrames(ranges);
        this.facets.forEach((facet, f) => { if (facet.curves.length) charts[f].views.push(this.chart(facet, scale, frames[f])); });
      }
      const thinned = curves.some((curve) => curve.values.length > drawnWhole);
      const more = " Of curves over " + drawnWhole + " points the smallest and the largest of each pixel are drawn; zooming in shows every sample.";
      return { id: subject.id, title: subject.title, caption: subject.caption + (thinned ? more : ""), views: scales.map((scale) => ricochet.format.withUnit(this.quantity(scale))), charts, legend: this.legend(), overTime: true, linked: true };
    }
    quantity(scale) { return scaleNames[scale] || this.subject.quantity; }
    // null where a curve has no start to be compared with.
    scaleOf(scale, curve) { return scale === "value" ? scaled.value() : curve.start === null ? null : scaled[scale](curve.start); }

    // Of the finished curves, and of the others as far as they stay in sight: up to three times their start where none finished, up to a thousand times
    // the finished ones on a logarithmic axis.
    range(facet, scale) {
      const range = new Interval();
      const include = (finished, bound) => {
        for (const curve of facet.curves) {
          const of = this.scaleOf(scale, curve);
          if (!of || (curve.one.status === "done") !== finished) continue;
          for (const value of curve.values) {
            const y = of(value);
            if (Math.abs(y) <= bound && (scale !== "change" || y > 0)) range.include(y);
          }
        }
      };
      include(true, Infinity);
      if (scale === "change") {
        include(false, range.empty ? 1e6 : 1e3 * Math.max(1, range.high));
      } else if (range.empty) {
        const start = Math.max(0, ...facet.curves.map((curve) => { const of = this.scaleOf(scale, curve); return of ? Math.abs(of(curve.values[0])) : 0; }));
        include(false, start > 0 ? 3 * start : Infinity);
      }
      return range;
    }

    chart(facet, scale, frame) {
      const { subject } = this, quantity = this.quantity(scale), x = ["t", "s"];
      if (frame.range.empty && scale === "change")
        return Object.assign(ricochet.view(x, quantity, {}, {}), { option: null, notes: ["No sample differs from the start: a logarithmic axis has nothing to show."] });
      let range = frame.range.empty ? new Interval(0, 1) : frame.range.copy();
      const notes = [];
      let y;
      if (scale === "change") {
        range = ricochet.wholeDecades(range);
        y = ricochet.logAxis(quantity, range, true);
      } else {
        if (scale === "value" && subject.fromZero) range.include(0);
        if (subject.withStops) range.include(...this.stops().map((stop) => 1.04 * stop));
        range = ricochet.roundOutwards(range, scale === "ratio" ? 2e-3 : 1e-12);
        const fromZero = range.low <= 0 && range.high >= 0;
        y = ricochet.valueAxis([ricochet.format.withUnit(quantity) + (fromZero ? "" : ", axis not from 0"), "1"], range, true);
        if (frame.own) notes.push("This chart has its own scale: its values are over 4 times those of most others.");
      }
      const time = new Interval();
      for (const curve of facet.curves) time.include(curve.t[0], curve.t[curve.t.length - 1]);
      if (time.low > 0 && time.low < 0.01 * time.high) time.low = 0;
      const out = ricochet.view(x, quantity, ricochet.valueAxis(x, time, false), y, true), unseen = [];
      out.notes = notes;
      for (const curve of facet.curves) this.draw(out, curve, scale, range, unseen);
      if (unseen.length) out.notes.push("Samples equal to the start exactly, which a logarithmic axis cannot show: " + unseen.join(", ") + ".");
      if (subject.withStops && this.stops().length) out.option.series.push(this.stopLines());
      return out;
    }
    draw(out, curve, scale, range, unseen) {
      const { text } = ricochet.format, of = this.scaleOf(scale, curve);
      if (!of) { out.notes.push(curve.name + ": energy 0 at the start, so no ratio to it."); return; }
      // Coarser steps are wider and lighter: where curves coincide, each still shows beside the finest.
      const width = this.byMass ? 1.6 : 1.4 + 0.8 * Math.min(curve.rank, 3);
      const series = {
        type: "line", name: curve.name, showSymbol: curve.values.length < 2, color: curve.colour, emphasis: { disabled: true },
        lineStyle: { color: curve.colour, width, type: this.byMass ? "solid" : ricochet.dash(curve.rank) }, data: () => Array.from(curve.t, (t, i) => [t, of(curve.values[i])]),
      };
      if (curve.values.length > drawnWhole) series.sampling = "minmax";
      out.option.series.push(series);
      let zeros = 0, largest = 0;
      for (const value of curve.values) {
        const y = of(value);
        if (y === 0) ++zeros;
        if (Number.isFinite(y) && Math.abs(y) > Math.abs(largest)) largest = y;
      }
      if (scale === "change" && zeros > 0) unseen.push(curve.name + " " + zeros + " of " + curve.values.length);
      if (largest > range.high || largest < range.low) out.notes.push(curve.name + ": leaves the frame, up to " + text(largest) + ricochet.format.unit(out.y) + ".");
      if (curve.one.status !== "done") this.drawEnd(out, curve, of, range);
    }
    // A mark where a curve that did not finish stops.
    drawEnd(out, curve, of, range) {
      let last = curve.values.length - 1;
      while (last >= 0 && !Number.isFinite(of(curve.values[last]))) --last;
      if (last < 0) return;
      const t = curve.t[last], shown = Math.min(Math.max(of(curve.values[last]), range.low), range.high), { status, reason } = curve.one;
      out.option.series.push(ricochet.marks(curve.name, curve.colour, [{ value: [t, shown], mark: ricochet.format.mark(status), text: status + " at t = " + ricochet.format.text(t) + " s: " + reason }]));
    }
    // Positions of the stops where the study gives them as plain numbers.
    stops() {
      const stops = (this.data.study.resolved.scene || {}).stops || {};
      return ["lower", "upper"].map((side) => stops[side]).filter((stop) => stop !== null && stop !== undefined && String(stop).trim() !== "").map(Number).filter(Number.isFinite);
    }
    stopLines() {
      return {
        type: "line", name: "stops", data: [], silent: true, tooltip: { show: false },
        markLine: {
          silent: true, symbol: "none", animation: false, label: { show: true, formatter: "stop", position: "insideStartTop", fontSize: 10, color: "#777777" },
          lineStyle: { color: "#777777", type: "solid", width: 1 }, data: this.stops().map((stop) => ({ yAxis: stop })),
        },
      };
    }
  }

  ricochet.overTime = (data, subject) => [new OverTime(data, subject).figure()].filter(Boolean);
}
