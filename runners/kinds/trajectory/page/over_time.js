// A column of the sampled curves against time: a chart per method, a curve per step (or mass), the zoom of all charts linked.
{
  const { numberOf, measureOf, Interval } = ricochet;
  const drawnWhole = 4000;   // points of a curve up to which every one is drawn: a chart is about 500 pixels wide

  // The scales of a column: as it is, as a ratio to the start, as the modulus of its change. Subtracting first keeps an unchanged value exactly 0.
  const scaled = { value: (y) => y, ratio: (y, start) => (1 / start) * y, change: (y, start) => Math.abs((1 / start) * (y - start)) };
  const scaleNames = { ratio: ["E / E_in", "1"], change: ["|E / E_in − 1|", "1"] };
  const startless = (curve, scale) => scale !== "value" && curve.start === null;   // no start to be compared with
  const valuesOf = (curve, scale) => (startless(curve, scale) ? [] : Float64Array.from(curve.values, (y) => scaled[scale](y, curve.start)));

  class OverTime {
    constructor(data, subject) {
      const { view } = data;
      Object.assign(this, { data, view, subject });
      // Told apart within one chart: the step; else the mass; else the first axis that varies.
      const masses = view.varying.filter((column) => ricochet.roleOf(column) === "mass"), byStep = view.varies("step"), step = (one) => numberOf(one, "step") || 0;
      this.columns = byStep ? ["step"] : masses.length ? masses : view.varying.slice(0, 1);
      this.byMass = !byStep && masses.length > 0;
      // Finest step first; other values in order of appearance.
      const ranked = byStep ? view.all.slice().sort((a, b) => step(a) - step(b)) : view.all;
      this.ranks = ricochet.distinct(ranked.map((one) => view.label(one, this.columns)));
      this.facets = view.group(view.all, view.varyingWithout(this.columns)).map((facet) => ({ title: facet.label || "all cases", cases: facet.cases, curves: this.curvesOf(facet) }));
    }
    // Coarser steps are wider and lighter: where curves coincide, each still shows beside the finest.
    look(one, colour) {
      const { view, ranks, byMass } = this, label = view.label(one, this.columns), rank = ranks.indexOf(label), shade = ranks.length < 2 ? 0 : 0.5 * rank / (ranks.length - 1);
      return {
        name: label || view.massLabel(one) || "curve", rank, colour: byMass ? view.colour(one) : ricochet.lighten(colour, shade),
        width: byMass ? 1.6 : 1.4 + 0.8 * Math.min(rank, 3), dash: byMass ? 0 : rank,
      };
    }
    curvesOf(facet) {
      const out = [];
      for (const one of facet.cases) {
        const curve = this.data.curve(one, this.subject.column), measured = measureOf(one, "energy_brought_in"), start = curve && (measured === null ? curve.y[0] : measured);
        if (curve) out.push({ one, t: curve.x, values: curve.y, start: start > 0 ? start : null, ...this.look(one, this.view.colour(one)) });
      }
      // The finest last, on top of the others.
      return out.sort((a, b) => b.rank - a.rank);
    }

    figure() {
      const { subject, view, facets } = this, curves = facets.flatMap((facet) => facet.curves);
      if (!curves.length) return null;
      const scales = subject.scales.filter((scale) => curves.some((curve) => !startless(curve, scale)));
      const frames = scales.map((scale) => ricochet.sharedFrames(facets.map((facet) => this.range(facet, scale)), scale === "change"));
      const charts = facets.map((facet, f) => ({
        title: facet.title, views: facet.curves.length ? scales.map((scale, k) => this.chart(facet, scale, frames[k][f])) : [], notes: view.outcomeNotes(facet.cases, this.columns),
      }));
      const thinned = curves.some((curve) => curve.values.length > drawnWhole);
      const more = " Of curves over " + drawnWhole + " points the smallest and the largest of each pixel are drawn; zooming in shows every sample.";
      const entries = view.all.map((one) => this.look(one, view.masses.length > 1 ? "#555555" : view.colour(one))).map(({ name, colour, dash }) => ({ name, colour, dash: ricochet.svgDash(dash) }));
      return {
        id: subject.id, title: subject.title, caption: subject.caption + (thinned ? more : ""), views: scales.map((scale) => ricochet.format.withUnit(this.quantity(scale))), charts,
        legend: ricochet.firstOfName(entries), overTime: true, linked: true,
      };
    }
    quantity(scale) { return scaleNames[scale] || this.subject.quantity; }

    // Of the finished curves, and of the others as far as they stay in sight: up to three times their start where none finished, up to a thousand times
    // the finished ones on a logarithmic axis.
    range(facet, scale) {
      const range = new Interval(), logarithmic = scale === "change";
      const include = (finished, bound) => {
        for (const curve of facet.curves.filter(({ one }) => (one.status === "done") === finished))
          for (const y of valuesOf(curve, scale)) if (Math.abs(y) <= bound && (!logarithmic || y > 0)) range.include(y);
      };
      include(true, Infinity);
      if (logarithmic) {
        include(false, range.empty ? 1e6 : 1e3 * Math.max(1, range.high));
      } else if (range.empty) {
        const start = Math.max(0, ...facet.curves.map((curve) => Math.abs(valuesOf(curve, scale)[0] || 0)));
        include(false, start > 0 ? 3 * start : Infinity);
      }
      return range;
    }

    chart(facet, scale, frame) {
      const { subject } = this, quantity = this.quantity(scale), x = ["t", "s"], stops = subject.withStops ? this.stops() : [], time = new Interval();
      if (frame.range.empty && scale === "change")
        return { ...ricochet.view(x, quantity, {}, {}), option: null, notes: ["No sample differs from the start: a logarithmic axis has nothing to show."] };
      let range = frame.range.empty ? new Interval(0, 1) : frame.range.copy();
      if (scale === "value" && subject.fromZero) range.include(0);
      range.include(...stops.map((stop) => 1.04 * stop));
      range = scale === "change" ? ricochet.wholeDecades(range) : ricochet.roundOutwards(range, scale === "ratio" ? 2e-3 : 1e-12);
      for (const { t } of facet.curves) time.include(t[0], t[t.length - 1]);
      if (time.low > 0 && time.low < 0.01 * time.high) time.low = 0;
      const y = scale === "change" ? ricochet.logAxis(quantity, range, true) : ricochet.heightAxis(quantity, range), out = ricochet.view(x, quantity, ricochet.valueAxis(x, time, false), y, true);
      if (frame.own) out.notes.push(ricochet.ownScale);
      for (const curve of facet.curves) {
        if (startless(curve, scale)) out.notes.push(curve.name + ": no energy was brought in, so no ratio to it.");
        else this.draw(out, curve, scale, range);
      }
      const unseen = scale === "change" ? facet.curves.map((curve) => ({ curve, zeros: valuesOf(curve, scale).filter((value) => value === 0).length })).filter(({ zeros }) => zeros > 0) : [];
      if (unseen.length) out.notes.push("Samples equal to the start exactly, which a logarithmic axis cannot show: " + unseen.map(({ curve, zeros }) => curve.name + " " + zeros + " of " + curve.values.length).join(", ") + ".");
      if (stops.length) out.option.series.push(stopLines(stops));
      return out;
    }
    draw(out, curve, scale, range) {
      const { text, unit, mark } = ricochet.format, values = valuesOf(curve, scale), { name, width } = curve, { status, reason } = curve.one;
      const look = { type: "line", name, case: curve.one.id, color: curve.colour, showSymbol: values.length < 2, emphasis: { disabled: true }, lineStyle: { width, type: ricochet.dash(curve.dash) } };
      ricochet.draw(out, () => ({ t: curve.t, value: valuesOf(curve, scale) }), { x: "t", y: "value" }, values.length > drawnWhole ? { ...look, sampling: "minmax" } : look);
      const largest = values.reduce((most, y) => (Number.isFinite(y) && Math.abs(y) > Math.abs(most) ? y : most), 0);
      if (largest > range.high || largest < range.low) out.notes.push(name + ": leaves the frame, up to " + text(largest) + unit(out.y) + ".");
      // A mark where a curve that did not finish stops.
      const last = values.findLastIndex(Number.isFinite);
      if (status === "done" || last < 0) return;
      const row = { case: curve.one.id, at: curve.t[last], height: Math.min(Math.max(values[last], range.low), range.high), mark: mark(status), text: status + " at t = " + text(curve.t[last]) + " s: " + reason };
      ricochet.drawMarks(out, curve, [row], { yAxisIndex: 0 });
    }
    // Positions of the stops where the study gives them as plain numbers.
    stops() {
      const stops = (this.data.study.resolved.scene || {}).stops || {};
      return ["lower", "upper"].map((side) => stops[side]).filter((stop) => stop !== null && stop !== undefined && String(stop).trim() !== "").map(Number).filter(Number.isFinite);
    }
  }

  const stopLines = (stops) => ({
    type: "line", name: "stops", data: [], silent: true, tooltip: { show: false },
    markLine: {
      silent: true, symbol: "none", animation: false, label: { show: true, formatter: "stop", position: "insideStartTop", fontSize: 10, color: "#777777" },
      lineStyle: { color: "#777777", type: "solid", width: 1 }, data: stops.map((stop) => ({ yAxis: stop })),
    },
  });

  ricochet.overTime = (data, subject) => [new OverTime(data, subject).figure()].filter(Boolean);
}
